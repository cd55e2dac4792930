/// @file
/// Walks over the words and numbers of a text, line by line, whatever the locale.

#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_double.h>

namespace firstcontact::detail {

/// Text in quotes for an error: cut short, and printable.
std::string quoted(std::string_view text);

/// The text without the mark that some editors put at the begin of UTF-8.
inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  text.remove_prefix(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
  return text;
}

/// The syntax in which text formats differ.
struct TextSyntax {
  bool comments = false;      ///< Whether '#' begins a comment that ends with the line.
  bool continuation = false;  ///< Whether a backslash at the end of a line joins the next one.
};

/// A position in a text.
///
/// Blanks are skipped before each item. A line ends at its line feed, in a text without line feeds
/// at its carriage return.
class TextCursor {
 public:
  TextCursor(std::string_view text, const std::string& source, TextSyntax syntax,
             std::size_t first_line = 1)
      : next_(text.data()),
        end_(text.data() + text.size()),
        line_(first_line),
        source_(source),
        syntax_(syntax),
        feed_(text.find('\n') == text.npos && text.find('\r') != text.npos ? '\r' : '\n') {}

  [[nodiscard]] std::size_t line() const { return line_; }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - next_); }

  [[nodiscard]] bool at_line_end() {
    skip_blanks();
    return next_ == end_ || *next_ == feed_ || is_comment(next_);
  }

  /// Goes to the next line with an item; false at the end of the text. It stays on a line with an
  /// item left.
  [[nodiscard]] bool find_line() {
    while (at_line_end()) {
      if (next_ == end_) {
        return false;
      }
      skip_line();
    }
    return true;
  }

  /// Leaves the rest of the line.
  void skip_line() {
    while (next_ != end_ && *next_ != feed_) {
      ++next_;
    }
    if (next_ != end_) {
      ++next_;
      ++line_;
    }
  }

  void expect_line_end() {
    if (!at_line_end()) {
      fail_at_word("the end of the line");
    }
  }

  /// Takes all characters up to the next blank; empty at the end of the line.
  std::string_view word() {
    if (at_line_end()) {
      return {};
    }
    const char* begin = next_;
    while (!is_delimiter(next_)) {
      ++next_;
    }
    return {begin, static_cast<std::size_t>(next_ - begin)};
  }

  /// Takes the next character if it is `wanted`, without skipping blanks.
  bool take(char wanted) {
    const bool found = next_ != end_ && *next_ == wanted;
    next_ += found ? 1 : 0;
    return found;
  }

  /// Whether a blank or a character of `take` comes, which alone may stand between two numbers.
  [[nodiscard]] bool at_delimiter() const { return is_delimiter(next_); }

  /// Takes a finite number, rounded to nearest.
  double number(const char* what) {
    skip_blanks();
    const char* begin = skip_plus();
    double value = 0.0;
    const auto [stop, error] = read_double(begin, end_, value);
    if (error != std::errc() || !is_delimiter(stop) || !std::isfinite(value)) {
      fail_at_word(what);
    }
    next_ = stop;
    return value;
  }

  /// Takes an integer that need not end at a blank: `take` and `at_delimiter` test what follows.
  std::int64_t integer_prefix(const char* what) {
    const char* begin = skip_plus();
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(begin, end_, value);
    if (error != std::errc()) {
      fail_at_word(what);
    }
    next_ = stop;
    return value;
  }

  std::int64_t integer(const char* what) {
    skip_blanks();
    const char* begin = next_;
    const std::int64_t value = integer_prefix(what);
    if (!at_delimiter()) {
      next_ = begin;
      fail_at_word(what);
    }
    return value;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw ParseError(source_, line_, message);
  }

  /// Throws "expected `what`, got 'word'".
  [[noreturn]] void fail_at_word(const std::string& what);

 private:
  [[nodiscard]] bool is_blank(char c) const {
    return c != feed_ && (c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f');
  }

  [[nodiscard]] bool is_comment(const char* p) const { return syntax_.comments && *p == '#'; }

  /// The length of a backslash with its line break at p, or 0.
  [[nodiscard]] std::size_t continuation(const char* p) const {
    if (!syntax_.continuation || *p != '\\') {
      return 0;
    }
    if (end_ - p > 1 && p[1] == feed_) {
      return 2;
    }
    return end_ - p > 2 && p[1] == '\r' && p[2] == '\n' ? 3 : 0;
  }

  [[nodiscard]] bool is_delimiter(const char* p) const {
    return p == end_ || is_blank(*p) || *p == feed_ || is_comment(p) || continuation(p) != 0;
  }

  void skip_blanks() {
    while (next_ != end_) {
      if (is_blank(*next_)) {
        ++next_;
      } else if (const std::size_t length = continuation(next_)) {
        next_ += length;
        ++line_;
      } else {
        return;
      }
    }
  }

  /// Skips a '+', which std::from_chars() does not read.
  [[nodiscard]] const char* skip_plus() const {
    const bool plus = end_ - next_ > 1 && *next_ == '+' && next_[1] != '-';
    return plus ? next_ + 1 : next_;
  }

  const char* next_;
  const char* end_;
  std::size_t line_;
  const std::string& source_;
  TextSyntax syntax_;
  char feed_;
};

}  // namespace firstcontact::detail
