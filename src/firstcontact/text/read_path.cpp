#include <firstcontact/text/read_path.h>

#include <string_view>
#include <system_error>

#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kPackage = "package://";

bool is_file(const std::filesystem::path& path) {
  // A NUL would end the name for the operating system, which would then open another file.
  std::error_code error;
  return path.native().find('\0') == std::string::npos &&
         std::filesystem::is_regular_file(path, error);
}

bool is_folder(const std::filesystem::path& path) {
  std::error_code error;
  return path.native().find('\0') == std::string::npos &&
         std::filesystem::is_directory(path, error);
}

/// The path from the scene's folder; or from the first other folder that has it, if any.
template <class Is>
std::filesystem::path opened(const std::string& name, const SceneFolders& folders, const Is& is) {
  std::filesystem::path path = folders.scene / name;
  if (!is(path)) {
    for (const std::filesystem::path& other : folders.others) {
      if (is(other / name)) {
        return other / name;
      }
    }
  }
  return path;
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

SceneFolders folders_around(const std::filesystem::path& file) {
  SceneFolders folders;
  std::error_code error;
  std::filesystem::path folder = std::filesystem::absolute(file, error).parent_path();
  while (!error && !folder.empty() && (folders.others.empty() || folder != folders.others.back())) {
    folders.others.push_back(folder);
    folder = folder.parent_path();
  }
  return folders;
}

std::filesystem::path found_file(const std::string& name, const SceneFolders& folders) {
  return opened(name, folders, is_file);
}

std::vector<std::filesystem::path> read_package_roots(const JsonValue& value,
                                                      const SceneFolders& folders,
                                                      const JsonReader& read) {
  std::vector<std::filesystem::path> roots;
  for (const JsonValue& root : read.array(value, "an array of folders")) {
    roots.push_back(opened(read.string(root, "a folder"), folders, is_folder));
  }
  return roots;
}

std::filesystem::path read_path(const JsonValue& value, const std::string& what,
                                const SceneFolders& folders, const JsonReader& read) {
  const std::string& name = read.string(value, "the path of " + what);
  if (name.starts_with(kPackage)) {
    return find_in_packages(value, name, folders, read);
  }
  std::filesystem::path path = found_file(name, folders);
  if (!is_file(path)) {
    read.fail(value, "expected " + what + ", found none at " + write_json(path.string()) +
                         (folders.others.empty() ? "" : ", nor from a folder above this file"));
  }
  return path;
}

}  // namespace firstcontact::detail
