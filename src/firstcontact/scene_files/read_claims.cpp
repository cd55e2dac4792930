#include <firstcontact/scene_files/read_claims.h>

#include <variant>

#include <firstcontact/query/verdict_words.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/sha256.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;

class ClaimsReader {
 public:
  ClaimsReader(const JsonValue& root, const std::string& source)
      : root_(root), reader_(root, source), source_(source) {}

  ResultClaims read(const ReadingOptions& options) const {
    const auto* object = std::get_if<JsonObject>(&root_.value);
    const JsonValue* scene = object == nullptr ? nullptr : find(*object, "scene");
    if (scene == nullptr || find(*object, "verdict") == nullptr) {
      throw ParseError(source_, root_.line,
                       "expected one result, as `firstcontact check SCENE -o FILE` writes it");
    }
    const std::string scene_text = detail::write_json(*scene);
    ResultClaims claims;
    claims.scene = parse_scene(scene_text, "scene of the result", 1, options);
    claims.scene.text_digest = text_or_empty(*object, "scene_digest");
    claims.version = text_or_empty(*object, "version");
    claims.input_digest = text_or_empty(*object, "input_digest");
    if (const JsonValue* digest = find(*object, "resolved_digest")) {
      claims.has_own_scene = reader_.string(*digest, "a digest") == detail::sha256(scene_text);
    }
    claims.verdict = verdict(root_);
    claims.t = reader_.number(reader_.member(root_, "t"));
    require_end(root_, claims.verdict, claims.t);
    claims.time = reader_.number(reader_.member(root_, "time"));
    const JsonValue& pair = reader_.member(root_, "pair");
    if (!is_null(pair)) {
      claims.pair = names(pair);
    }
    claims.clearance = clearance_of(root_);
    claims.tolerance_used = tolerance(*object, claims.scene);
    const JsonValue& counts = reader_.member(root_, "pair_counts");
    constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
    claims.tested = reader_.index(reader_.member(counts, "tested"), kMost, "a number of pairs");
    if (const JsonValue* pairs = find(*object, "pairs")) {
      claims.pairs.emplace();
      for (const JsonValue& answer : reader_.array(*pairs, "answers of pairs")) {
        claims.pairs->push_back(of_pair(answer, claims.scene));
      }
    }
    return claims;
  }

 private:
  static const JsonValue* find(const JsonObject& object, std::string_view key) {
    return detail::find(object, key);
  }

  static bool is_null(const JsonValue& value) {
    return std::holds_alternative<detail::JsonNull>(value.value);
  }

  [[nodiscard]] std::string text_or_empty(const JsonObject& object, std::string_view key) const {
    const JsonValue* value = find(object, key);
    if (value == nullptr) {
      return "";
    }
    // A scene that came from no text has an empty digest.
    const auto* text = std::get_if<std::string>(&value->value);
    return text != nullptr ? *text : reader_.string(*value, "a string");
  }

  [[nodiscard]] Verdict verdict(const JsonValue& object) const {
    return reader_.enumerator<Verdict>(reader_.member(object, "verdict"), kVerdictWords);
  }

  /// Requires that the verdict agrees with `t_upper` and `reason`, which repeat how the proof ends.
  void require_end(const JsonValue& answer, Verdict verdict, double t) const {
    const JsonValue& upper = reader_.member(answer, "t_upper");
    const bool is_later = !is_null(upper) && reader_.number(upper) >= t;
    if (is_contact(verdict) && !(is_later && reader_.number(upper) == t)) {
      refuse(upper, detail::write_json(t) + ", as t, since the verdict is a contact");
    }
    if (verdict == Verdict::free && !is_null(upper)) {
      refuse(upper, "null, since the verdict is free");
    }
    if (verdict == Verdict::undecided && !is_null(upper) && !is_later) {
      refuse(upper, "null or a time from t on");
    }
    const JsonValue& reason = reader_.member(answer, "reason");
    const bool has_reason =
        !is_null(reason) &&
        reader_.enumerator<UndecidedReason>(reason, kUndecidedReasonWords) != UndecidedReason::none;
    if (verdict == Verdict::undecided && !has_reason) {
      refuse(reason, "why the search ended, since the verdict is undecided");
    }
  }

  [[noreturn]] void refuse(const JsonValue& value, const std::string& expected) const {
    reader_.fail(value, "expected " + expected + ", got " + detail::write_json(value) +
                            "; check the scene again");
  }

  [[nodiscard]] std::array<std::string, 2> names(const JsonValue& value) const {
    const detail::JsonArray& both = reader_.array(value, "two names");
    if (both.size() != 2) {
      reader_.fail_expected("two names", value);
    }
    return {reader_.string(both[0], "a name"), reader_.string(both[1], "a name")};
  }

  [[nodiscard]] double tolerance(const JsonObject& object, const Scene& scene) const {
    const JsonValue* used = find(object, "tolerance_used");
    return used == nullptr ? scene.options.tolerance : reader_.positive(*used);
  }

  [[nodiscard]] double clearance_of(const JsonValue& answer) const {
    const JsonValue& clearance = reader_.member(answer, "clearance");
    return is_null(clearance) ? std::numeric_limits<double>::infinity() : reader_.number(clearance);
  }

  [[nodiscard]] PairClaim of_pair(const JsonValue& answer, const Scene& scene) const {
    const std::array<std::string, 2> pair = names(reader_.member(answer, "pair"));
    const Verdict own = verdict(answer);
    const double t = reader_.number(reader_.member(answer, "t"));
    require_end(answer, own, t);
    return {.pair = pair,
            .verdict = own,
            .t = t,
            .tolerance_used = tolerance(std::get<JsonObject>(answer.value), scene),
            .margin = reader_.number(reader_.member(answer, "margin")),
            .time = reader_.number(reader_.member(answer, "time")),
            .clearance = clearance_of(answer)};
  }

  const JsonValue& root_;
  JsonReader reader_;
  const std::string& source_;
};

}  // namespace

ResultClaims read_claims(std::string_view result, const std::filesystem::path& source,
                         std::size_t line, const ReadingOptions& options) {
  const std::string name = source.string();
  const JsonValue root = detail::parse_json(result, name, line);
  return ClaimsReader(root, name).read(options);
}

}  // namespace firstcontact
