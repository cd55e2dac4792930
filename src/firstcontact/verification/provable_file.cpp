#include <firstcontact/verification/provable_file.h>

#include <algorithm>
#include <variant>

#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>

namespace firstcontact {
namespace {

bool is_json(std::string_view text) {
  try {
    (void)detail::parse_json(text, "");
    return true;
  } catch (const ParseError&) {
    return false;
  }
}

}  // namespace

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

ProvableFile damaged_file(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const auto skip = [&] {
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  };
  if (is_json(text)) {
    return ProvableFile::unknown;
  }
  skip();
  if (!text.starts_with('{')) {
    return ProvableFile::unknown;
  }
  text.remove_prefix(1);
  skip();
  if (text.starts_with("\"firstcontact_run\"")) {
    return ProvableFile::run;
  }
  if (text.starts_with("\"firstcontact_path\"")) {
    return ProvableFile::path;
  }
  return text.starts_with("\"id\"") ? ProvableFile::result : ProvableFile::unknown;
}

}  // namespace firstcontact
