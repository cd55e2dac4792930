#include <firstcontact/text/text_cursor.h>

#include <limits>

namespace firstcontact::detail {

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest)) {
    result += c >= ' ' && c <= '~' ? c : '?';
  }
  return result + (text.size() > kLongest ? "...'" : "'");
}

void TextCursor::fail_at_word(const std::string& what) {
  if (at_line_end()) {
    fail("expected " + what + ", got the end of the " + (next_ == end_ ? "file" : "line"));
  }
  fail("expected " + what + ", got " + quoted(word()));
}

double TextCursor::beyond_double(const char* begin) const {
  long double value = 0.0L;
  const auto [stop, error] = std::from_chars(begin, end_, value);
  return error == std::errc() ? static_cast<double>(value)
                              : std::numeric_limits<double>::infinity();
}

}  // namespace firstcontact::detail
