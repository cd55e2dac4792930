#include "terminal_text.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>

#include <fmt/core.h>

#include <firstcontact/text/utf8.h>

namespace firstcontact::app {
namespace {

/// The code point of one character that is UTF-8.
std::uint32_t code_point(std::string_view character) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint8_t>(character[k]); };
  std::uint32_t code = character.size() == 1 ? byte(0) : byte(0) & (0x7fu >> character.size());
  for (std::size_t k = 1; k < character.size(); ++k) {
    code = code << 6 | (byte(k) & 0x3fu);
  }
  return code;
}

bool steers(std::uint32_t code) {
  const auto within = [code](std::uint32_t first, std::uint32_t last) {
    return first <= code && code <= last;
  };
  return code < 0x20 || within(0x7f, 0x9f) || within(0x200e, 0x200f) || within(0x2028, 0x202e) ||
         within(0x2066, 0x2069) || code == 0xfeff;
}

std::string escape(std::uint32_t code) {
  switch (code) {
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return code < 0x100 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
  }
}

std::string shown(std::string_view text, bool keep_lines) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = detail::utf8_length(text);
    const std::string_view character = text.substr(0, length == 0 ? 1 : length);
    const std::uint32_t code =
        length == 0 ? static_cast<std::uint8_t>(text[0]) : code_point(character);
    const bool is_kept = length > 0 && (!steers(code) || (keep_lines && code == '\n'));
    if (is_kept) {
      result += character;
    } else {
      result += escape(code);
    }
    text.remove_prefix(character.size());
  }
  return result;
}

}  // namespace

std::string visible(std::string_view text) { return shown(text, /*keep_lines=*/false); }

std::string visible_lines(std::string_view text) { return shown(text, /*keep_lines=*/true); }

std::string answer_line(std::string_view label, std::string_view value) {
  return fmt::format("  {:<10} {}\n", label, visible(value));
}

void say(std::string_view text) {
  const std::string shown_text = visible_lines(text);
  (void)std::fwrite(shown_text.data(), 1, shown_text.size(), stdout);
}

}  // namespace firstcontact::app
