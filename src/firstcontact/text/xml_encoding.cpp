#include <firstcontact/text/xml_encoding.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/utf8.h>

namespace firstcontact::detail {
namespace {

/// The encoding that <?xml ... encoding="..."?> states, in lower case; empty where there is none.
std::string declared_encoding(std::string_view text) {
  constexpr std::string_view kKey = "encoding";
  text = trimmed(text.substr(0, text.find("?>")));
  std::size_t at = text.starts_with("<?xml") ? text.find(kKey) : std::string_view::npos;
  if (at == std::string_view::npos) {
    return {};
  }
  at = text.find_first_of("\"'", at + kKey.size());
  const std::size_t end = at == std::string_view::npos ? at : text.find(text[at], at + 1);
  return end == std::string_view::npos ? "" : lower(text.substr(at + 1, end - at - 1));
}

/// Whether an encoding is Latin-1, whose bytes are code points.
bool is_latin1(std::string_view encoding) {
  return encoding == "iso-8859-1" || encoding == "iso8859-1" || encoding == "latin1" ||
         encoding == "latin-1";
}

std::string utf8_of_latin1(std::string_view text) {
  std::string converted;
  converted.reserve(text.size());
  for (const char c : text) {
    const auto code = static_cast<std::uint8_t>(c);
    if (code < 0x80) {
      converted += c;
    } else {
      converted += static_cast<char>(0xc0u | code >> 6);
      converted += static_cast<char>(0x80u | (code & 0x3fu));
    }
  }
  return converted;
}

/// Whether a place is in a comment.
bool is_in_comment(std::string_view text, std::size_t at) {
  const std::size_t begin = text.rfind("<!--", at);
  return begin != std::string_view::npos && text.find("-->", begin) > at;
}

}  // namespace

std::string utf8_of_xml(std::string_view text, const std::string& source) {
  std::size_t at = find_not_utf8(text);
  const std::string encoding = at < text.size() ? declared_encoding(text) : "";
  if (is_latin1(encoding)) {
    return utf8_of_latin1(text);
  }
  std::string result(text);
  while (at < result.size()) {
    if (!is_in_comment(result, at)) {
      const auto line =
          1 + std::count(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      throw ParseError(source, static_cast<std::size_t>(line),
                       "expected UTF-8, got other bytes; save the file as UTF-8, or state its "
                       "encoding: <?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>");
    }
    result[at] = '?';
    at += find_not_utf8(std::string_view(result).substr(at));
  }
  return result;
}

}  // namespace firstcontact::detail
