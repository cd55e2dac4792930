#include <firstcontact/scene_files/read_result.h>

#include <algorithm>
#include <string>
#include <variant>

#include <firstcontact/query/verdict_words.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

/// The string of a key; null if the object has none.
const std::string* find_string(const detail::JsonObject& object, std::string_view key) {
  const detail::JsonValue* value = detail::find(object, key);
  return value == nullptr ? nullptr : std::get_if<std::string>(&value->value);
}

/// The number of a key; 0, the least claim, where the object has none.
double find_number(const detail::JsonObject& object, std::string_view key) {
  const detail::JsonValue* value = detail::find(object, key);
  const auto* number = value == nullptr ? nullptr : std::get_if<double>(&value->value);
  return number == nullptr ? 0.0 : *number;
}

}  // namespace

ResultSummary read_summary(std::string_view result, const std::filesystem::path& source,
                           std::size_t line) {
  const detail::JsonValue root = detail::parse_json(result, source.string(), line);
  if (const auto* object = std::get_if<detail::JsonObject>(&root.value)) {
    const double number = find_number(*object, "line");
    ResultSummary summary;
    if (number >= 1.0 && number < 0x1p53) {
      summary.line = static_cast<std::size_t>(number);
    }
    if (find_string(*object, "error") != nullptr) {
      return summary;
    }
    const std::string* found = find_string(*object, "verdict");
    if (found != nullptr) {
      const auto known = std::ranges::find(kVerdictWords, *found);
      if (known != kVerdictWords.end()) {
        summary.verdict = static_cast<Verdict>(known - kVerdictWords.begin());
        return summary;
      }
    }
  }
  throw ParseError(source.string(), line, "expected a result with a \"verdict\" or an \"error\"");
}

StoredResult read_result(std::string_view result, const std::filesystem::path& source,
                         const ReadingOptions& options) {
  const detail::JsonValue root = detail::parse_json(result, source.string());
  const auto* object = std::get_if<detail::JsonObject>(&root.value);
  const detail::JsonValue* scene = object == nullptr ? nullptr : detail::find(*object, "scene");
  if (scene == nullptr || detail::find(*object, "verdict") == nullptr) {
    throw ParseError(source.string(),
                     "expected one result, as `firstcontact check SCENE -o FILE` writes it");
  }
  return {parse_scene(detail::write_json(*scene), "scene of the result", 1, options),
          find_number(*object, "t"), find_number(*object, "clearance")};
}

}  // namespace firstcontact
