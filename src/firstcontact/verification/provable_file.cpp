#include <firstcontact/verification/provable_file.h>

#include <variant>

#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>

namespace firstcontact {

ProvableFile provable_file(std::string_view text) {
  try {
    const detail::JsonValue root = detail::parse_json(text, "");
    const auto* object = std::get_if<detail::JsonObject>(&root.value);
    const auto has = [&](std::string_view key) {
      return object != nullptr && detail::find(*object, key) != nullptr;
    };
    if (has("firstcontact_run")) {
      return ProvableFile::run;
    }
    if (has("firstcontact_path")) {
      return ProvableFile::path;
    }
    const bool is_result = has("scene") && has("verdict");
    return is_result || (has("error") && has("file")) ? ProvableFile::result
                                                      : ProvableFile::unknown;
  } catch (const ParseError&) {
    return ProvableFile::unknown;
  }
}

}  // namespace firstcontact
