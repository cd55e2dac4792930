#include <firstcontact/text/text_tree.h>

#include <algorithm>

#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/parse_yaml.h>

namespace firstcontact::detail {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return extension;
}

bool is_tree_extension(std::string_view extension) {
  return extension == ".json" || extension == ".yaml" || extension == ".yml";
}

JsonValue parse_tree(std::string_view text, const std::filesystem::path& source) {
  return lower_extension(source) == ".json" ? parse_json(text, source.string())
                                            : parse_yaml(text, source.string());
}

}  // namespace firstcontact::detail
