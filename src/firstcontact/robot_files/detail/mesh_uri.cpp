#include <firstcontact/robot_files/detail/mesh_uri.h>

#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kPackage = "package://";
constexpr std::string_view kFile = "file://";

/// The roots, then the folders of packages of this name that hold the file, then all above it.
std::vector<std::filesystem::path> search_path(const std::string& package,
                                               const std::filesystem::path& urdf,
                                               std::span<const std::filesystem::path> roots) {
  std::vector<std::filesystem::path> folders(roots.begin(), roots.end());
  std::vector<std::filesystem::path> above;
  std::error_code ignored;
  std::filesystem::path folder = std::filesystem::absolute(urdf, ignored).parent_path();
  while (folder.has_relative_path()) {
    const bool is_package = folder.filename() == package;
    folder = folder.parent_path();
    (is_package ? folders : above).push_back(folder);
  }
  folders.insert(folders.end(), above.begin(), above.end());
  return folders;
}

std::string listed(std::span<const std::filesystem::path> roots) {
  std::string text;
  for (const std::filesystem::path& root : roots) {
    text += (text.empty() ? "" : ", ") + root.string();
  }
  return roots.empty() ? "none were given" : text;
}

}  // namespace

std::filesystem::path resolve_mesh(const std::string& uri, const std::filesystem::path& urdf,
                                   std::span<const std::filesystem::path> roots) {
  const std::string_view text = uri;
  if (text.starts_with(kFile)) {
    return urdf.parent_path() / text.substr(kFile.size());  // What is absolute replaces the folder.
  }
  if (!text.starts_with(kPackage)) {
    if (text.find("://") != std::string_view::npos) {
      throw std::invalid_argument("expected package://, file:// or a path, got '" + uri + "'");
    }
    return urdf.parent_path() / uri;
  }
  const std::string_view rest = text.substr(kPackage.size());
  const std::string package(rest.substr(0, rest.find('/')));
  if (package.empty() || package.size() == rest.size()) {
    throw std::invalid_argument("expected package://NAME/path, got '" + uri + "'");
  }
  std::optional<std::filesystem::path> expected;  // In the first folder of this name.
  for (const std::filesystem::path& root : search_path(package, urdf, roots)) {
    std::filesystem::path path = root / std::filesystem::path(rest);
    std::error_code ignored;
    if (std::filesystem::is_regular_file(path, ignored)) {
      return path;
    }
    if (!expected && std::filesystem::is_directory(root / package, ignored)) {
      expected = std::move(path);
    }
  }
  if (expected) {
    return *std::move(expected);
  }
  throw std::invalid_argument("no package root holds a folder '" + package +
                              "' (roots: " + listed(roots) +
                              "); name the folder that holds it: "
                              "--package-root, or \"package_roots\" in a scene");
}

}  // namespace firstcontact::detail
