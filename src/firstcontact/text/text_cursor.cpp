#include <firstcontact/text/text_cursor.h>

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

}  // namespace firstcontact::detail
