#include <firstcontact/text/read_path.h>

#include <string_view>
#include <system_error>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kPackage = "package://";

bool is_file(const std::filesystem::path& path) {
  // A NUL would end the name for the operating system, and another file would be opened.
  std::error_code error;
  return path.native().find('\0') == std::string::npos &&
         std::filesystem::is_regular_file(path, error);
}

std::filesystem::path find_in_packages(const JsonValue& value, const std::string& uri,
                                       const SceneFolders& folders, const JsonReader& read) {
  const std::string below = uri.substr(kPackage.size());
  for (const std::filesystem::path& root : folders.package_roots) {
    if (is_file(root / below)) {
      return root / below;
    }
  }
  if (folders.package_roots.empty()) {
    read.fail(value, "expected \"package_roots\" in the scene, to find " + write_json(uri));
  }
  read.fail(value, "expected a file, found " + write_json(uri) + " in none of the " +
                       std::to_string(folders.package_roots.size()) +
                       " package_roots (looked for " +
                       write_json((folders.package_roots.front() / below).string()) + ")");
}

}  // namespace

std::vector<std::filesystem::path> read_package_roots(const JsonValue& value,
                                                      const std::filesystem::path& scene,
                                                      const JsonReader& read) {
  std::vector<std::filesystem::path> roots;
  for (const JsonValue& root : read.array(value, "an array of folders")) {
    roots.push_back(scene / read.string(root, "a folder"));
  }
  return roots;
}

std::filesystem::path read_path(const JsonValue& value, const std::string& what,
                                const SceneFolders& folders, const JsonReader& read) {
  const std::string& name = read.string(value, "the path of " + what);
  if (name.starts_with(kPackage)) {
    return find_in_packages(value, name, folders, read);
  }
  std::filesystem::path path = folders.scene / name;
  if (!is_file(path)) {
    read.fail(value, "expected " + what + ", found none at " + write_json(path.string()));
  }
  return path;
}

}  // namespace firstcontact::detail
