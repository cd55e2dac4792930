#include <firstcontact/robot_files/detail/mesh_uri.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <firstcontact/text/uri.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kPackage = "package://";
constexpr std::string_view kFile = "file:";
constexpr std::string_view kNoHost = "//";
constexpr std::string_view kLocalHost = "//localhost/";

/// The path of a "file:" URI (RFC 8089), with or without an empty host.
///
/// The standard has no relative paths; one is accepted all the same.
std::string_view path_of_file_uri(std::string_view rest) {
  if (rest.starts_with(kLocalHost)) {
    return rest.substr(kLocalHost.size() - 1);
  }
  return rest.starts_with(kNoHost) ? rest.substr(kNoHost.size()) : rest;
}

/// The path as it is written, where there is such a file; else with %20 and the like decoded.
std::string existing(std::string_view path, const std::filesystem::path& urdf) {
  std::error_code ignored;
  const std::optional<std::string> decoded = decode_percent(path);
  return std::filesystem::exists(urdf.parent_path() / path, ignored) || !decoded ? std::string(path)
                                                                                 : *decoded;
}

/// The folder that holds a file. For a path with ".." it is the real one, whatever links lead to
/// it.
std::filesystem::path folder_of(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::absolute(file, ignored).parent_path();
  const bool goes_up = std::ranges::find(folder, "..") != folder.end();
  return goes_up ? std::filesystem::weakly_canonical(folder, ignored) : folder;
}

/// The folders to search: the roots, then packages of this name that hold the file, then its folder
/// and all above.
std::vector<std::filesystem::path> search_path(const std::string& package,
                                               const std::filesystem::path& urdf,
                                               std::span<const std::filesystem::path> roots) {
  std::vector<std::filesystem::path> folders(roots.begin(), roots.end());
  std::filesystem::path folder = folder_of(urdf);
  std::vector<std::filesystem::path> above = {folder};
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
  if (text.find("$(") != std::string_view::npos) {
    throw std::invalid_argument("expected package://, file:// or a path, got '" + uri +
                                "'; run xacro first");
  }
  if (text.starts_with(kFile)) {
    // An absolute path replaces the folder.
    return urdf.parent_path() / existing(path_of_file_uri(text.substr(kFile.size())), urdf);
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
