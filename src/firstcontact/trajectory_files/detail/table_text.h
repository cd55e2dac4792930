/// @file
/// Lines and fields of a table with any separator.

#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace firstcontact::detail {

/// A line with text.
struct TableLine {
  std::string_view text;
  std::size_t number = 0;  ///< Number of the line, from 1.
};

/// All lines of a text but empty ones, without line ends and without a byte order mark.
[[nodiscard]] std::vector<TableLine> table_lines(std::string_view text);

/// The fields of a line, without blanks around them; quotes around a whole field hide separators.
///
/// Two quotes within such a field are one.
///
/// @param separator  ',', ';' or a tab; a blank stands for any number of blanks and tabs
[[nodiscard]] std::vector<std::string> table_fields(std::string_view line, char separator);

/// Reads numbers of one table, which all have the same decimal mark.
class TableNumbers {
 public:
  /// @param allows_commas  whether commas may be decimal marks, as they do not separate columns
  explicit TableNumbers(bool allows_commas) : allows_commas_(allows_commas) {}

  /// Reads a field; none if it is no finite number, or has another decimal mark than those before.
  [[nodiscard]] std::optional<double> read(std::string_view field);

  /// The first decimal mark; none before the first number with one.
  [[nodiscard]] std::optional<char> mark() const { return mark_; }

 private:
  bool allows_commas_;
  std::optional<char> mark_;
};

/// The place of the header of a table, and the separator of columns.
struct TableHeader {
  std::size_t line = 0;  ///< Index of the header among the lines.
  char separator = ',';
  std::vector<std::string> fields;
};

/// Finds the header: the first line that is no comment, if it names a time.
///
/// Otherwise it is the last of the lines before, where '#' or '%' stands before it as before
/// comments. Separators are tried in the order comma, semicolon, tab, blanks. "sep=;" in the first
/// line, as spreadsheets know it, decides.
///
/// @param is_time  whether a field is the name of the time column
/// @returns none where no line names a time
[[nodiscard]] std::optional<TableHeader> find_header(
    const std::vector<TableLine>& lines, const std::function<bool(std::string_view)>& is_time);

/// Whether the line is a comment: '#' or '%' stands before it.
[[nodiscard]] bool is_comment(const TableLine& line);

/// Whether the line is "sep=;" with any separator.
[[nodiscard]] bool names_separator(const TableLine& line);

}  // namespace firstcontact::detail
