#include <firstcontact/text/text_tree.h>

#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/parse_yaml.h>

namespace firstcontact::detail {

bool is_tree_extension(std::string_view extension) {
  return extension == "json" || extension == "yaml" || extension == "yml";
}

JsonValue parse_tree(std::string_view text, const std::filesystem::path& source) {
  return file_extension(source) == "json" ? parse_json(text, source.string())
                                          : parse_yaml(text, source.string());
}

}  // namespace firstcontact::detail
