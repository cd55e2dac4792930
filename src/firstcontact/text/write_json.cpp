#include <firstcontact/text/write_json.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <variant>

#include <firstcontact/text/utf8.h>

namespace firstcontact::detail {
namespace {

void append_escaped(char c, std::string& out) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const auto byte = static_cast<std::uint8_t>(c);
  if (c == '"' || c == '\\') {
    out += {'\\', c};
  } else if (byte < 0x20 || byte == 0x7f) {
    out += "\\u00";
    out += {kDigits[byte >> 4], kDigits[byte & 0xf]};
  } else {
    out += c;
  }
}

void append(const JsonValue& tree, std::string& out);

/// Writes a value of each kind; the overloads are picked by std::visit.
struct Appender {
  std::string& out;

  void operator()(JsonNull) const { out += "null"; }
  void operator()(bool value) const { out += value ? "true" : "false"; }
  void operator()(double value) const { out += write_json(value); }
  void operator()(const std::string& value) const { out += write_json(std::string_view(value)); }

  void operator()(const JsonText& written) const { out += written.text; }

  void operator()(const JsonArray& array) const {
    const char* separator = "[";
    for (const JsonValue& element : array) {
      out += separator;
      append(element, out);
      separator = ",";
    }
    out += array.empty() ? "[]" : "]";
  }

  void operator()(const JsonObject& object) const {
    const char* separator = "{";
    for (const auto& [key, member] : object) {
      out += separator;
      out += write_json(std::string_view(key)) + ":";
      append(member, out);
      separator = ",";
    }
    out += object.empty() ? "{}" : "}";
  }
};

void append(const JsonValue& tree, std::string& out) { std::visit(Appender{out}, tree.value); }

}  // namespace

std::string write_json(const JsonValue& tree) {
  std::string out;
  append(tree, out);
  return out;
}

std::string write_json(double number) {
  std::array<char, 32> text{};  // The longest has 24 characters: -1.7976931348623157e+308.
  char* const begin = text.data();
  // Counts and indices stay integers to every reader: 100000, not 1e+05.
  const bool whole = std::abs(number) < 0x1p53 && number == std::trunc(number);
  const auto end =
      whole ? std::to_chars(begin, begin + text.size(), number, std::chars_format::fixed).ptr
            : std::to_chars(begin, begin + text.size(), number).ptr;
  return {begin, end};
}

std::string write_json(std::string_view text) {
  std::string out = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      out += "\\ufffd";
    } else if (length == 1) {
      append_escaped(text.front(), out);
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out + '"';
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() <= kLongest) {
    return write_json(text);
  }
  std::size_t cut = 0;
  while (cut < kLongest) {
    cut += std::max<std::size_t>(1, utf8_length(text.substr(cut)));
  }
  return write_json(std::string(text.substr(0, cut)) + "...");
}

}  // namespace firstcontact::detail
