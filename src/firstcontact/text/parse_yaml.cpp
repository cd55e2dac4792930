#include <firstcontact/text/parse_yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <istream>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <streambuf>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>
#include <firstcontact/text/read_double.h>
#include <firstcontact/text/utf8.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

std::optional<double> decimal(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  const std::size_t first_digit = text.find_first_not_of("-.");
  if (first_digit == std::string_view::npos || text[first_digit] < '0' || text[first_digit] > '9') {
    return std::nullopt;  // std::from_chars() also reads "nan" and "inf".
  }
  double value = 0.0;
  const auto [end, error] = read_double(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

JsonVariant plain_scalar(const std::string& text) {
  constexpr std::array<std::string_view, 3> kTrue = {"true", "True", "TRUE"};
  constexpr std::array<std::string_view, 3> kFalse = {"false", "False", "FALSE"};
  if (std::find(kTrue.begin(), kTrue.end(), text) != kTrue.end()) {
    return true;
  }
  if (std::find(kFalse.begin(), kFalse.end(), text) != kFalse.end()) {
    return false;
  }
  if (const std::optional<double> number = decimal(text)) {
    return *number;
  }
  return text;
}

/// The size of a value.
struct Extent {
  std::size_t values = 1;
  std::size_t depth = 0;  ///< Depth of lists and maps inside each other.
};

/// The extent of a value; recurses no deeper than kMaximumJsonDepth, as all values do.
Extent extent_of(const JsonValue& value) {
  Extent extent;
  const auto add = [&extent](const JsonValue& inside) {
    const Extent more = extent_of(inside);
    extent.values += more.values;
    extent.depth = std::max(extent.depth, more.depth + 1);
  };
  if (const auto* array = std::get_if<JsonArray>(&value.value)) {
    extent.depth = 1;
    std::for_each(array->begin(), array->end(), add);
  } else if (const auto* object = std::get_if<JsonObject>(&value.value)) {
    extent.depth = 1;
    for (const JsonMember& member : *object) {
      add(member.value);
    }
  }
  return extent;
}

/// Builds the tree from what yaml-cpp finds.
class TreeBuilder final : public YAML::EventHandler {
 public:
  /// @param bytes  size of the text, which bounds the number of its own values
  TreeBuilder(const std::string& source, std::size_t bytes)
      : source_(source), most_values_(bytes + kMaximumRepeatedYamlValues) {}

  /// Returns the tree; none where the document was empty.
  std::optional<JsonValue> take() { return std::exchange(root_, std::nullopt); }

  void OnDocumentStart(const YAML::Mark&) override { anchors_.clear(); }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, anchor, JsonNull{});
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      fail(mark, "expected an alias of something before it, got one of what is around it");
    }
    const Extent extent = extent_of(found->second);
    reserve(mark, extent.values);
    require_depth(mark, open_.size() + extent.depth);
    finish(mark, 0, JsonValue(found->second));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    add(mark, anchor, tagged_scalar(mark, tag, value));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    require_tag(mark, tag, "seq");
    open(mark, anchor, JsonArray{});
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    require_tag(mark, tag, "map");
    open(mark, anchor, JsonObject{});
  }
  void OnMapEnd() override { close(); }

 private:
  /// A container that has begun and not ended.
  struct Open {
    JsonValue value;
    YAML::anchor_t anchor;
    YAML::Mark mark;
    std::optional<std::string> key;  // Key of the next member of an object.
    std::set<std::string> keys;
  };

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    throw ParseError(source_, static_cast<std::size_t>(mark.line) + 1, message);
  }

  /// What a scalar stands for, by its tag. A tag that is not known may change a number's unit, so
  /// it is refused.
  [[nodiscard]] JsonVariant tagged_scalar(const YAML::Mark& mark, const std::string& tag,
                                          const std::string& text) const {
    if (tag == "!" || tag == core_tag("str")) {
      return text;
    }
    if (tag == "!degrees" || tag == "!radians") {  // As in the files of robots for xacro.
      const std::optional<double> number = decimal(text);
      if (!number) {
        fail(mark, "expected a number after " + tag + ", got " + in_quotes(text));
      }
      return tag == "!degrees" ? *number * (std::numbers::pi / 180.0) : *number;
    }
    JsonVariant value = plain_scalar(text);
    const bool is_number = std::holds_alternative<double>(value);
    if (is_plain(tag) || (tag == core_tag("bool") && std::holds_alternative<bool>(value)) ||
        ((tag == core_tag("int") || tag == core_tag("float")) && is_number)) {
      return value;
    }
    fail_at_tag(mark, tag);
  }

  void require_tag(const YAML::Mark& mark, const std::string& tag, const char* kind) const {
    if (!is_plain(tag) && tag != "!" && tag != core_tag(kind)) {
      fail_at_tag(mark, tag);
    }
  }

  [[noreturn]] void fail_at_tag(const YAML::Mark& mark, const std::string& tag) const {
    fail(mark, "expected no tag but !degrees and !radians, got " + in_quotes(tag));
  }

  static bool is_plain(const std::string& tag) { return tag.empty() || tag == "?"; }

  /// The long form of "!!name".
  static std::string core_tag(const std::string& name) { return "tag:yaml.org,2002:" + name; }

  void reserve(const YAML::Mark& mark, std::size_t values) {
    count_ += values;
    if (count_ > most_values_) {
      fail(mark, "expected aliases that repeat at most " +
                     std::to_string(kMaximumRepeatedYamlValues) + " values, got more");
    }
  }

  void require_depth(const YAML::Mark& mark, std::size_t depth) const {
    if (depth > kMaximumJsonDepth) {
      fail(mark, "expected at most " + std::to_string(kMaximumJsonDepth) +
                     " lists and maps inside each other, got more");
    }
  }

  static std::size_t line_of(const YAML::Mark& mark) {
    return static_cast<std::size_t>(mark.line) + 1;
  }

  void add(const YAML::Mark& mark, YAML::anchor_t anchor, JsonVariant value) {
    reserve(mark, 1);
    finish(mark, anchor, {.value = std::move(value), .line = line_of(mark)});
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor, JsonVariant empty) {
    if (expects_key()) {
      fail(mark, "expected a word as key, got a list or map");
    }
    require_depth(mark, open_.size() + 1);
    reserve(mark, 1);
    open_.push_back(
        {{.value = std::move(empty), .line = line_of(mark)}, anchor, mark, std::nullopt, {}});
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(done.mark, done.anchor, std::move(done.value));
  }

  [[nodiscard]] bool expects_key() const {
    return !open_.empty() && std::holds_alternative<JsonObject>(open_.back().value.value) &&
           !open_.back().key;
  }

  /// Puts a whole value at its place.
  void finish(const YAML::Mark& mark, YAML::anchor_t anchor, JsonValue value) {
    if (anchor != 0) {
      reserve(mark, extent_of(value).values);
      anchors_[anchor] = value;
    }
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (auto* array = std::get_if<JsonArray>(&open_.back().value.value)) {
      array->push_back(std::move(value));
    } else if (expects_key()) {
      take_key(mark, value);
    } else {
      auto& object = std::get<JsonObject>(open_.back().value.value);
      object.push_back({*std::exchange(open_.back().key, std::nullopt), std::move(value)});
    }
  }

  void take_key(const YAML::Mark& mark, const JsonValue& value) {
    const auto* word = std::get_if<std::string>(&value.value);
    const auto* number = std::get_if<double>(&value.value);
    if (word == nullptr && number == nullptr) {
      fail(mark, "expected a word as key");
    }
    std::string key = word != nullptr ? *word : write_json(*number);
    if (!open_.back().keys.insert(key).second) {
      fail(mark, "expected each key once, got " + in_quotes(key) + " again");
    }
    open_.back().key = std::move(key);
  }

  const std::string& source_;
  std::size_t most_values_;
  std::optional<JsonValue> root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, JsonValue> anchors_;
  std::size_t count_ = 0;
};

/// A text as a stream, without a copy.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // Only read: there is no put area.
    setg(begin, begin, begin + text.size());
  }
};

bool holds_nothing(const std::optional<JsonValue>& value) {
  return !value || std::holds_alternative<JsonNull>(value->value);
}

/// The greatest number of documents of a text: lines that begin with "---" or "..." separate them.
std::size_t most_documents(std::string_view text) {
  std::size_t count = 1;
  for (std::size_t line = 0; line < text.size();) {
    const std::string_view rest = text.substr(line);
    count += rest.starts_with("---") || rest.starts_with("...") ? 1 : 0;
    const std::size_t end = rest.find('\n');
    line = end == std::string_view::npos ? text.size() : line + end + 1;
  }
  return count;
}

JsonValue only_document(std::string_view text, const std::string& source) {
  TextBuffer buffer(text);
  std::istream stream(&buffer);
  YAML::Parser parser(stream);
  TreeBuilder builder(source, text.size());
  std::optional<JsonValue> document;
  // For some texts yaml-cpp finds one empty document after the other, without end.
  std::size_t left = most_documents(text) + 1;
  while (parser.HandleNextDocument(builder)) {
    std::optional<JsonValue> next = builder.take();
    const bool is_second = !holds_nothing(next) && document;
    if (is_second || left == 0) {
      throw ParseError(source, is_second ? next->line : 1,
                       "expected one YAML document, got a second one");
    }
    if (!holds_nothing(next)) {
      document = std::move(next);
    }
    --left;
  }
  if (!document) {
    throw ParseError(source, 1, "expected a YAML document, got none");
  }
  return std::move(*document);
}

bool is_control(char c) {
  const auto code = static_cast<unsigned char>(c);
  return (code < 0x20 && c != '\t' && c != '\n' && c != '\r') || code == 0x7f;
}

/// Requires UTF-8 without the control characters that YAML excludes and yaml-cpp interprets.
void require_characters(std::string_view text, const std::string& source) {
  const std::size_t not_utf8 = find_not_utf8(text);
  const auto control = std::find_if(text.begin(), text.end(), is_control);
  const std::size_t bad = std::min(not_utf8, static_cast<std::size_t>(control - text.begin()));
  if (bad != text.size()) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(bad);
    throw ParseError(source, 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n')),
                     bad == not_utf8 ? "expected UTF-8, got other bytes"
                                     : "expected text, got a control character");
  }
}

}  // namespace

JsonValue parse_yaml(std::string_view text, const std::string& source) {
  require_characters(text, source);
  try {
    return only_document(text, source);
  } catch (const YAML::Exception& error) {
    const std::size_t line =
        error.mark.is_null() ? 1 : static_cast<std::size_t>(error.mark.line) + 1;
    throw ParseError(source, line, "expected YAML: " + error.msg);
  }
}

}  // namespace firstcontact::detail
