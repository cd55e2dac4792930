#include <firstcontact/trajectory_files/detail/trajectory_table.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <firstcontact/text/brief_list.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/utf8.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/table_columns.h>
#include <firstcontact/trajectory_files/detail/table_text.h>
#include <firstcontact/trajectory_files/detail/trajectory_points.h>

namespace firstcontact::detail {
namespace {

using Kind = TableColumn::Kind;

/// The part of a line that an error shows, cut between characters.
std::string_view beginning(std::string_view line) {
  std::size_t size = std::min<std::size_t>(line.size(), 60);
  while (size > 0 && size < line.size() &&
         (static_cast<unsigned char>(line[size]) & 0xc0U) == 0x80U) {
    --size;
  }
  return line.substr(0, size);
}

class TableReader {
 public:
  TableReader(std::string_view text, const std::string& source, const RobotModel& robot)
      : source_(source), robot_(robot) {
    require_utf8(text);
    lines_ = table_lines(text);
  }

  Trajectory read() {
    const TableHeader header = read_header();
    TableNumbers numbers(header.separator != ',');
    TrajectoryPoints points(columns_.joint_names);
    for (std::size_t k = header.line + 1; k < lines_.size(); ++k) {
      if (is_comment(lines_[k])) {
        continue;
      }
      line_ = lines_[k].number;
      try {
        points.add(read_point(table_fields(lines_[k].text, header.separator), numbers));
      } catch (const std::invalid_argument& error) {
        fail("column " + in_quotes(time_column()) + ": " + error.what());
      }
      ++rows_;
    }
    if (points.empty()) {
      fail("expected at least one line of numbers after the header, got none");
    }
    try {
      Trajectory trajectory = points.take(robot_, source_);
      add_warnings(trajectory);
      return trajectory;
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ParseError(source_, line_, message);
  }

  void require_utf8(std::string_view text) {
    const std::size_t bad = find_not_utf8(text);
    if (bad != text.size()) {
      const auto end = text.begin() + static_cast<std::ptrdiff_t>(bad);
      line_ = 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n'));
      fail("expected UTF-8, got other bytes");
    }
  }

  TableHeader read_header() {
    if (lines_.empty()) {
      fail("expected a header such as time,joint1,joint2, got none");
    }
    auto header = find_header(lines_, is_time_column);
    if (!header) {
      line_ = lines_.front().number;
      fail(
          "expected a column \"time\" [s] in the header, and columns separated by commas, "
          "semicolons, tabs or blanks; got " +
          in_quotes(beginning(lines_.front().text)));
    }
    line_ = lines_[header->line].number;
    if (lines_[header->line].text.starts_with("%time,field.")) {
      fail(
          "expected times in seconds and columns named after joints, got what rostopic echo -p "
          "writes; write a header of \"time\" and the joints, and divide the times by 1e9");
    }
    if (header->fields.back().empty()) {  // Lines end with a separator.
      header->fields.pop_back();
    }
    try {
      columns_ = table_columns(header->fields, robot_);
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
    separator_ = header->separator;
    return *header;
  }

  [[nodiscard]] const std::string& time_column() const {
    return std::find_if(columns_.columns.begin(), columns_.columns.end(),
                        [](const TableColumn& column) { return column.kind == Kind::time; })
        ->name;
  }

  void require_count(std::vector<std::string>& fields) const {
    const std::size_t count = columns_.columns.size();
    if (fields.size() == count + 1 && fields.back().empty()) {
      fields.pop_back();
    }
    if (fields.size() != count) {
      const bool may_be_decimal = separator_ == ',' && fields.size() > count;
      fail("expected " + std::to_string(count) + " numbers, as the header has columns, got " +
           std::to_string(fields.size()) +
           (may_be_decimal ? "; beside decimal commas, separate columns by ;" : ""));
    }
  }

  TrajectoryPoint read_point(std::vector<std::string> fields, TableNumbers& numbers) {
    require_count(fields);
    TrajectoryPoint point;
    for (const TableColumn& column : columns_.columns) {
      if (column.kind == Kind::numbers) {
        (point.*column.numbers).resize(columns_.joint_names.size());
      }
    }
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const TableColumn& column = columns_.columns[k];
      if (column.kind == Kind::effort) {
        continue;
      }
      const double number = read_number(fields[k], column, numbers);
      if (column.kind == Kind::numbers) {
        (point.*column.numbers)[column.joint] = number;
      } else if (column.kind == Kind::time) {
        point.time = number;
      }
    }
    return point;
  }

  double read_number(const std::string& field, const TableColumn& column,
                     TableNumbers& numbers) const {
    constexpr double kLargest = 1e8;  // The limit of a CoordinatePath.
    const std::optional<char> mark = numbers.mark();
    const std::optional<double> number = numbers.read(field);
    const auto refuse = [&](const std::string& expected) {
      fail("column " + in_quotes(column.name) + ": expected " + expected + ", got " +
           in_quotes(field));
    };
    if (!number && mark && field.find_first_of(*mark == '.' ? ',' : '.') != std::string::npos) {
      refuse(std::string("a number with the decimal mark ") + *mark + " of those before it");
    }
    if (column.kind == Kind::row) {
      if (!number || *number != static_cast<double>(rows_)) {
        refuse(std::to_string(rows_) + ", as a column without a name counts the rows");
      }
    } else if (column.kind == Kind::time) {
      if (!number || !(*number >= 0.0)) {
        refuse("a number >= 0");
      }
    } else if (!number || !(std::abs(*number) <= kLargest)) {
      refuse("a number of at most 1e8 in size");
    }
    return *number;
  }

  void add_warnings(Trajectory& trajectory) const {
    std::vector<std::string> efforts;
    for (const TableColumn& column : columns_.columns) {
      if (column.kind == Kind::effort) {
        efforts.push_back(column.name);
      }
    }
    if (!efforts.empty()) {
      trajectory.warnings.push_back(source_ + ": efforts are left out: " + some_of(efforts));
    }
  }

  const std::string& source_;
  const RobotModel& robot_;
  std::vector<TableLine> lines_;
  std::size_t line_ = 1;  // For errors.
  std::size_t rows_ = 0;  // Number of rows taken so far.
  char separator_ = ',';
  TableColumns columns_;
};

}  // namespace

Trajectory read_trajectory_table(std::string_view text, const std::string& source,
                                 const RobotModel& robot) {
  return TableReader(text, source, robot).read();
}

}  // namespace firstcontact::detail
