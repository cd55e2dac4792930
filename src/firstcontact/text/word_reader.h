/// @file
/// Words and numbers of a text file, one after the other.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace firstcontact::detail {

/// Words are parted by white space, and by characters that count as such; comments run from `#` to
/// the end of the line.
class WordReader {
 public:
  /// @param source      names the text in errors
  /// @param separators  characters that part words, too
  WordReader(std::string_view text, std::string source, std::string_view separators = "");

  /// The next word; empty at the end of the text.
  [[nodiscard]] std::string_view peek() const { return word_; }
  [[nodiscard]] bool at_end() const { return word_.empty(); }

  /// Takes the next word.
  ///
  /// @throws ParseError at the end: expected `what`
  std::string_view word(const std::string& what);

  /// Takes the next word, which has to be this one, in upper or lower case.
  void expect(std::string_view word);

  /// Takes a finite number of a size of at most 1e9.
  double number(const std::string& what);

  /// Takes a whole number >= 0.
  std::size_t count(const std::string& what);

  /// Takes three numbers.
  Eigen::Vector3d vector(const std::string& what);

  /// Whether the next word is on the line of the word taken last.
  [[nodiscard]] bool on_line_of_last() const { return line_ == taken_line_; }

  /// @throws ParseError  path:line of the next word: expected `what`, got the word
  [[noreturn]] void fail_expected(const std::string& what) const;

  /// @throws ParseError  path:line of the word taken last: message
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void advance();

  std::string_view text_;
  std::string source_;
  std::string_view separators_;
  std::size_t at_ = 0;  // Behind the next word.
  std::size_t line_ = 1;
  std::size_t taken_line_ = 1;
  std::string_view word_;
};

/// Whether two words are the same but for upper and lower case of ASCII letters.
bool same_word(std::string_view a, std::string_view b);

}  // namespace firstcontact::detail
