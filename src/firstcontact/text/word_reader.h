/// @file
/// Words and numbers of a text file, one after the other.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <Eigen/Core>

namespace firstcontact::detail {

/// Reads the words of a text.
///
/// White space separates words, and so do the given characters. Comments run from `#` to the end of
/// the line.
class WordReader {
 public:
  /// @param source      names the text in errors
  /// @param separators  further characters that separate words
  WordReader(std::string_view text, std::string source, std::string_view separators = "");

  /// The next word; empty at the end of the text.
  [[nodiscard]] std::string_view peek() const { return word_; }
  [[nodiscard]] bool at_end() const { return word_.empty(); }

  /// Takes the next word.
  ///
  /// @throws ParseError at the end: expected `what`
  std::string_view word(const std::string& what);

  /// Takes the next word, which has to be the given one, in upper or lower case.
  void expect(std::string_view word);

  /// Takes a finite number of at most 1e9 in size.
  double number(const std::string& what);

  /// Takes a whole number >= 0.
  std::size_t count(const std::string& what);

  /// Takes three numbers.
  Eigen::Vector3d vector(const std::string& what);

  /// Whether the next word is on the line of the last word that was taken.
  [[nodiscard]] bool on_line_of_last() const { return line_ == taken_line_; }

  /// Throws an error at the next word.
  ///
  /// @throws ParseError  path:line of the next word: expected `what`, got the word
  [[noreturn]] void fail_expected(const std::string& what) const;

  /// Throws an error at the last word that was taken.
  ///
  /// @throws ParseError  path:line of that word: message
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void advance();

  std::string_view text_;
  std::string source_;
  std::string_view separators_;
  std::size_t at_ = 0;  // Position behind the next word.
  std::size_t line_ = 1;
  std::size_t taken_line_ = 1;
  std::string_view word_;
};

/// Whether two words are equal, apart from upper and lower case of ASCII letters.
bool same_word(std::string_view a, std::string_view b);

}  // namespace firstcontact::detail
