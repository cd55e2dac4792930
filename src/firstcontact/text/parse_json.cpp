#include <firstcontact/text/parse_json.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>
#include <vector>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_double.h>
#include <firstcontact/text/utf8.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_in_word(char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-' || c == '.'; }

void append_utf8(std::uint32_t code, std::string& out) {
  const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | code >> 6);
    put(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    put(0xe0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3f));
    put(0x80 | (code & 0x3f));
  } else {
    put(0xf0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3f));
    put(0x80 | (code >> 6 & 0x3f));
    put(0x80 | (code & 0x3f));
  }
}

/// Parses by recursive descent, whose depth is limited.
class JsonParser {
 public:
  JsonParser(std::string_view text, const std::string& source, std::size_t first_line)
      : rest_(text), source_(source), line_(first_line) {}

  JsonValue document() {
    require_utf8();
    JsonValue root = value();
    skip_blanks();
    if (!rest_.empty()) {
      fail("expected the end of the text after the JSON value, got " + next_word());
    }
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ParseError(source_, line_, message);
  }

  void require_utf8() {
    const std::size_t bad = find_not_utf8(rest_);
    if (bad != rest_.size()) {
      line_ += static_cast<std::size_t>(std::count(rest_.begin(), rest_.begin() + bad, '\n'));
      fail("expected UTF-8, got other bytes");
    }
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (rest_.starts_with(kByteOrderMark)) {
      rest_.remove_prefix(kByteOrderMark.size());
    }
  }

  void skip_blanks() {
    while (!rest_.empty()) {
      const char c = rest_.front();
      if (c != ' ' && c != '\t' && c != '\n' && c != '\r') {
        return;
      }
      line_ += c == '\n' ? 1 : 0;
      rest_.remove_prefix(1);
    }
  }

  [[nodiscard]] bool at(char c) const { return rest_.starts_with(c); }

  bool take(char c) {
    const bool found = at(c);
    rest_.remove_prefix(found ? 1 : 0);
    return found;
  }

  /// The word at the present place, for a message.
  [[nodiscard]] std::string next_word() const {
    if (rest_.empty()) {
      return "the end of the text";
    }
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_in_word);
    const auto length = static_cast<std::size_t>(end - rest_.begin());
    return in_quotes(rest_.substr(0, std::max(length, utf8_length(rest_))));
  }

  JsonValue value() {
    skip_blanks();
    const std::size_t line = line_;
    JsonValue result;
    if (at('{')) {
      result.value = object();
    } else if (at('[')) {
      result.value = array();
    } else if (at('"')) {
      result.value = string();
    } else if (at('-') || (!rest_.empty() && is_digit(rest_.front()))) {
      result.value = number();
    } else {
      result.value = literal();
    }
    result.line = line;
    return result;
  }

  JsonVariant literal() {
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_in_word);
    const std::string_view word = rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
    if (word != "true" && word != "false" && word != "null") {
      fail_at_value(word);
    }
    rest_.remove_prefix(word.size());
    if (word == "null") {
      return JsonNull{};
    }
    return word == "true";
  }

  [[noreturn]] void fail_at_value(std::string_view word) const {
    const std::string begun = lower(word.substr(0, 3));
    if (begun == "nan" || begun == "inf") {
      fail("expected a finite number, got " + next_word() + "; JSON has no NaN and no infinity");
    }
    if (at('/')) {
      fail("expected a value, got a comment; JSON has none");
    }
    fail("expected a value (object, array, string, number, true, false or null), got " +
         next_word());
  }

  void enter() {
    if (++depth_ > kMaximumJsonDepth) {
      fail("expected at most " + std::to_string(kMaximumJsonDepth) +
           " brackets inside each other, got more");
    }
  }

  JsonArray array() {
    enter();
    take('[');
    JsonArray elements;
    skip_blanks();
    if (!at(']')) {
      do {
        elements.push_back(value());
        skip_blanks();
      } while (take(','));
    }
    if (!take(']')) {
      fail("expected ',' or ']' after an element of an array, got " + next_word());
    }
    --depth_;
    return elements;
  }

  JsonObject object() {
    enter();
    take('{');
    JsonObject members;
    skip_blanks();
    if (!at('}')) {
      do {
        members.push_back(member());
        skip_blanks();
      } while (take(','));
    }
    if (!take('}')) {
      fail("expected ',' or '}' after a member of an object, got " + next_word());
    }
    refuse_repeated_keys(members);
    --depth_;
    return members;
  }

  JsonMember member() {
    skip_blanks();
    if (!at('"')) {
      fail("expected a key in double quotes, got " + next_word());
    }
    std::string key = string();
    skip_blanks();
    if (!take(':')) {
      fail("expected ':' after the key " + in_quotes(key) + ", got " + next_word());
    }
    return {std::move(key), value()};
  }

  void refuse_repeated_keys(const JsonObject& members) const {
    std::vector<const JsonMember*> sorted;
    sorted.reserve(members.size());
    for (const JsonMember& member : members) {
      sorted.push_back(&member);
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const JsonMember* a, const JsonMember* b) { return a->key < b->key; });
    const auto same = [](const JsonMember* a, const JsonMember* b) { return a->key == b->key; };
    const auto first = std::adjacent_find(sorted.begin(), sorted.end(), same);
    if (first != sorted.end()) {
      throw ParseError(source_, first[1]->value.line,
                       "expected each key once, got " + in_quotes(first[0]->key) +
                           " again (first on line " + std::to_string(first[0]->value.line) + ")");
    }
  }

  std::string string() {
    take('"');
    std::string result;
    while (true) {
      const auto plain = std::find_if(rest_.begin(), rest_.end(), [](char c) {
        return c == '"' || c == '\\' || static_cast<std::uint8_t>(c) < 0x20;
      });
      result.append(rest_.begin(), plain);
      rest_.remove_prefix(static_cast<std::size_t>(plain - rest_.begin()));
      if (take('"')) {
        return result;
      }
      if (!take('\\')) {
        fail(rest_.empty() ? "expected '\"' at the end of a string, got the end of the text"
                           : "expected '\"' at the end of a string, got a control character "
                             "(a line break is written \\n)");
      }
      append_escape(result);
    }
  }

  void append_escape(std::string& out) {
    constexpr std::string_view kLetters = "\"\\/bfnrt";
    constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
    if (take('u')) {
      append_utf8(code_point(), out);
      return;
    }
    const std::size_t which = rest_.empty() ? std::string_view::npos : kLetters.find(rest_.front());
    if (which == std::string_view::npos) {
      fail("expected one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t \\u in a string, got another escape");
    }
    out += kMeanings[which];
    rest_.remove_prefix(1);
  }

  /// Reads the character of \uXXXX, or of the two halves \uD8XX\uDCXX.
  std::uint32_t code_point() {
    const std::uint32_t unit = hexadecimal();
    if (unit < 0xd800 || unit >= 0xe000) {
      return unit;
    }
    if (unit < 0xdc00 && rest_.starts_with("\\u")) {
      rest_.remove_prefix(2);
      const std::uint32_t low = hexadecimal();
      if (low >= 0xdc00 && low < 0xe000) {
        return 0x10000 + ((unit - 0xd800) << 10) + (low - 0xdc00);
      }
    }
    fail("expected both halves of a surrogate pair, such as \\ud83d\\ude00, got one");
  }

  std::uint32_t hexadecimal() {
    std::uint32_t unit = 0;
    const std::string_view digits = rest_.substr(0, 4);
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), unit, 16);
    if (error != std::errc() || digits.size() < 4 || end != digits.data() + 4) {
      fail("expected four hexadecimal digits after \\u");
    }
    rest_.remove_prefix(4);
    return unit;
  }

  static std::size_t count_digits(std::string_view text) {
    const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
    return static_cast<std::size_t>(end - text.begin());
  }

  /// The length of the number at the present place by the grammar of JSON; 0 if there is none.
  [[nodiscard]] std::size_t number_length() const {
    std::size_t length = at('-') ? 1 : 0;
    const auto here = [&] { return length < rest_.size() ? rest_[length] : '\0'; };
    const std::size_t whole = count_digits(rest_.substr(length));
    if (whole == 0 || (whole > 1 && here() == '0')) {
      return 0;
    }
    length += whole;
    if (here() == '.') {
      const std::size_t fraction = count_digits(rest_.substr(length + 1));
      if (fraction == 0) {
        return 0;
      }
      length += 1 + fraction;
    }
    if (here() == 'e' || here() == 'E') {
      ++length;
      length += here() == '+' || here() == '-' ? 1 : 0;
      const std::size_t exponent = count_digits(rest_.substr(length));
      length += exponent;
      return exponent == 0 ? 0 : length;
    }
    return length;
  }

  double number() {
    const std::size_t length = number_length();
    const bool cut = length < rest_.size() && is_in_word(rest_[length]);
    if (length == 0 || cut) {
      fail("expected a finite number such as -1.5 or 2e-3, got " + next_word());
    }
    const std::string_view digits = rest_.substr(0, length);
    rest_.remove_prefix(length);
    double value = 0.0;
    const auto error = read_double(digits.data(), digits.data() + length, value).ec;
    if (error == std::errc::result_out_of_range) {
      fail("expected a number that fits a double (at most 1.8e308 in size), got " +
           in_quotes(digits));
    }
    return value;
  }

  std::string_view rest_;
  const std::string& source_;
  std::size_t line_;
  std::size_t depth_ = 0;
};

}  // namespace

JsonValue parse_json(std::string_view text, const std::string& source, std::size_t first_line) {
  return JsonParser(text, source, first_line).document();
}

}  // namespace firstcontact::detail
