#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/mesh_files/detail/parse_mesh.h>
#include <firstcontact/mesh_files/read_points.h>
#include <firstcontact/text/ascii.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

using detail::ReadingLog;
using detail::TextCursor;

constexpr std::string_view kBlanks = " \t\r\v\f";

bool is_blank(char c) { return kBlanks.find(c) != kBlanks.npos; }

/// A line without its comment, and its number.
struct Line {
  std::string_view text;
  std::size_t number = 0;
};

/// Finds the separator of the numbers of a line; a blank if there is no other.
char separator_of(std::string_view line) {
  return line.find(';') != line.npos ? ';' : line.find(',') != line.npos ? ',' : ' ';
}

/// Whether blanks without a comma stand between words of the line.
bool has_lone_blanks(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (!is_blank(line[i])) {
      continue;
    }
    const std::size_t next = std::min(line.find_first_not_of(kBlanks, i), line.size());
    const bool at_comma = line[i - 1] == ',' || (next < line.size() && line[next] == ',');
    if (!at_comma) {
      return true;
    }
    i = next;
  }
  return false;
}

/// The fields of a line that is not empty.
class Fields {
 public:
  explicit Fields(std::string_view line) : rest_(line), separator_(separator_of(line)) {}

  /// Reads the next field; nothing at the end of the line.
  std::optional<std::string_view> next() {
    if (is_at_end_) {
      return std::nullopt;
    }
    const std::size_t end =
        separator_ == ' ' ? rest_.find_first_of(kBlanks) : rest_.find(separator_);
    const std::string_view field = detail::trimmed(rest_.substr(0, end));
    is_at_end_ = end == rest_.npos;
    rest_ = is_at_end_ ? std::string_view() : rest_.substr(end + 1);
    if (separator_ == ' ') {
      rest_ = detail::trimmed(rest_);
      is_at_end_ = is_at_end_ || rest_.empty();
    }
    return field;
  }

 private:
  std::string_view rest_;
  char separator_;
  bool is_at_end_ = false;
};

class XyzReader {
 public:
  explicit XyzReader(ReadingLog& log) : log_(log) {}

  std::vector<Eigen::Vector3d> read(std::string_view text) {
    std::size_t number = 1;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      const std::string_view content = detail::trimmed(line.substr(0, line.find('#')));
      if (!content.empty()) {
        read_line({content, number});
      }
      text.remove_prefix(std::min(end + 1, text.size()));
      ++number;
    }
    finish();
    return std::move(points_);
  }

 private:
  [[noreturn]] void fail(const Line& line, const std::string& message) const {
    throw ParseError(log_.path(), line.number, message);
  }

  void read_line(const Line& line) {
    if (line.text.starts_with("//")) {
      check_names(line, line.text.substr(2), /*is_comment=*/true);
      log_.leave_out("//", "comments");
    } else if (points_.empty() && !has_header_ && starts_with_word(line.text)) {
      check_no_atoms(line);
      check_names(line, line.text, /*is_comment=*/false);
      has_header_ = true;
    } else if (points_.empty() && !count_ && is_count(line)) {
      count_line_ = line.number;
    } else {
      read_point(line);
    }
  }

  /// Whether the first column is a word: neither a number nor "nan" or "inf", which are refused as
  /// coordinates.
  static bool starts_with_word(std::string_view line) {
    const std::string first = detail::lower(*Fields(line).next());
    const bool is_number = first == "nan" || first == "inf" || first == "infinity";
    return !first.empty() && !is_number &&
           (std::isalpha(static_cast<unsigned char>(first[0])) != 0 || first[0] == '"');
  }

  /// Refuses the xyz files of chemistry: they have a number of atoms, a title, and lines of a
  /// symbol and a place.
  void check_no_atoms(const Line& line) const {
    if (count_) {
      fail(line, "expected coordinates after the number of points, got " +
                     detail::quoted(*Fields(line.text).next()) +
                     ": files of atoms are not supported");
    }
  }

  /// Checks names of columns: they have to begin with x, y and z; a comment may have no names.
  void check_names(const Line& line, std::string_view text, bool is_comment) const {
    std::vector<std::string> names;
    Fields fields(detail::trimmed(text));
    while (const auto field = fields.next()) {
      std::string name = detail::lower(*field);
      std::erase(name, '"');
      names.push_back(std::move(name));
    }
    constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
    const bool is_right =
        names.size() >= 3 && std::equal(kNames.begin(), kNames.end(), names.begin());
    const bool has_names = std::all_of(kNames.begin(), kNames.end(), [&](std::string_view name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    });
    if (!is_right && (!is_comment || has_names)) {
      fail(line, "expected coordinates, or names of columns that begin with x y z, got " +
                     detail::quoted(line.text));
    }
  }

  /// Whether a line, before the points, is one whole number: the number of points.
  bool is_count(const Line& line) {
    if (line.text.find_first_not_of("0123456789") != line.text.npos) {
      return false;
    }
    count_ = TextCursor(line.text, log_.path(), {}, line.number).integer("a number of points");
    return true;
  }

  void read_point(const Line& line) {
    const char separator = separator_of(line.text);
    if ((separator == ',' && has_lone_blanks(line.text)) ||
        (separator == ';' && line.text.find(',') != line.text.npos)) {
      fail(line,
           "expected decimal points and one kind of separator, got " + detail::quoted(line.text));
    }
    Fields fields(line.text);
    Eigen::Vector3d p;
    for (double& coordinate : p) {
      const auto field = fields.next();
      if (!field) {
        fail(line, "expected a finite coordinate, got the end of the line");
      }
      TextCursor cursor(*field, log_.path(), {}, line.number);
      coordinate = cursor.number("a finite coordinate");
      cursor.expect_line_end();
    }
    further_columns_ += fields.next() ? 1 : 0;
    points_.push_back(p);
  }

  void finish() const {
    if (points_.empty()) {
      throw ParseError(log_.path(), "expected at least one point, found none");
    }
    if (count_ && static_cast<std::uint64_t>(*count_) != points_.size()) {
      throw ParseError(log_.path(), count_line_,
                       "count says " + std::to_string(*count_) + ", " +
                           std::to_string(points_.size()) + " points follow");
    }
    if (has_header_) {
      log_.leave_out("names of columns", "x, y and z come first");
    }
    if (further_columns_ > 0) {
      log_.leave_out("columns after x, y and z", "colours, normals and other values",
                     further_columns_);
    }
  }

  ReadingLog& log_;
  std::vector<Eigen::Vector3d> points_;
  bool has_header_ = false;
  std::optional<std::int64_t> count_;
  std::size_t count_line_ = 0;
  std::size_t further_columns_ = 0;
};

}  // namespace

std::vector<Eigen::Vector3d> detail::parse_xyz(std::string_view text, ReadingLog& log) {
  return XyzReader(log).read(without_byte_order_mark(text));
}

std::vector<Eigen::Vector3d> parse_xyz(std::string_view text, const std::string& source) {
  return detail::parse_unlogged([](auto bytes, auto& log) { return detail::parse_xyz(bytes, log); },
                                text, source);
}

}  // namespace firstcontact
