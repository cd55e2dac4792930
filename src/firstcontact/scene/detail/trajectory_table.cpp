#include <firstcontact/scene/detail/trajectory_table.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/utf8.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  text.remove_prefix(begin);
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) {
      return fields;
    }
    line.remove_prefix(comma + 1);
  }
}

std::string_view without_quotes(std::string_view field) {
  const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return quoted ? field.substr(1, field.size() - 2) : field;
}

/// Where the number of a column goes.
struct Column {
  std::string name;
  std::vector<double> TrajectoryPoint::*numbers = nullptr;  // Null: the time.
  std::size_t joint = 0;                                    // Of the joint names.
};

class TableReader {
 public:
  TableReader(std::string_view text, const std::string& source, const RobotModel& robot)
      : rest_(text), source_(source), robot_(robot) {}

  Trajectory read() {
    require_utf8();
    const std::optional<std::string_view> header = next_line();
    if (!header) {
      throw ParseError(source_, 1, "expected a header such as time,joint1,joint2, got none");
    }
    read_header(*header);
    while (const std::optional<std::string_view> line = next_line()) {
      read_point(*line);
    }
    if (trajectory_.points.empty()) {
      fail("expected at least one line of numbers after the header, got none");
    }
    return std::move(trajectory_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw ParseError(source_, line_, message);
  }

  void require_utf8() {
    const std::size_t bad = find_not_utf8(rest_);
    if (bad != rest_.size()) {
      const auto end = rest_.begin() + static_cast<std::ptrdiff_t>(bad);
      line_ = 1 + static_cast<std::size_t>(std::count(rest_.begin(), end, '\n'));
      fail("expected UTF-8, got other bytes");
    }
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (rest_.starts_with(kByteOrderMark)) {
      rest_.remove_prefix(kByteOrderMark.size());
    }
  }

  /// The next line that holds something.
  std::optional<std::string_view> next_line() {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      const std::string_view line = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      if (!line.empty()) {
        return line;
      }
    }
    return std::nullopt;
  }

  void read_header(std::string_view header) {
    if (header.front() == '#') {
      header.remove_prefix(1);
    }
    const std::vector<std::string_view> fields = fields_of(header);
    for (const std::string_view field : fields) {
      add_joint(without_quotes(field));
    }
    if (trajectory_.joint_names.empty()) {
      fail("expected a column for at least one joint, got none");
    }
    for (const std::string_view field : fields) {
      add_column(without_quotes(field));
    }
    const auto is_time = [](const Column& column) { return column.numbers == nullptr; };
    if (std::none_of(columns_.begin(), columns_.end(), is_time)) {
      fail("expected a column \"time\" [s], got none");
    }
    require_for_all(&TrajectoryPoint::velocities, ".velocity");
    require_for_all(&TrajectoryPoint::accelerations, ".acceleration");
    if (has(&TrajectoryPoint::accelerations) && !has(&TrajectoryPoint::velocities)) {
      fail("expected columns NAME.velocity beside NAME.acceleration, got none");
    }
  }

  static bool is_time(std::string_view name) { return name == "time"; }

  /// The joint of NAME.velocity or NAME.acceleration; none if the name has no such ending, or
  /// belongs to a joint as it is.
  [[nodiscard]] std::optional<std::pair<std::string_view, std::vector<double> TrajectoryPoint::*>>
  derivative(std::string_view name) const {
    constexpr std::string_view kVelocity = ".velocity";
    constexpr std::string_view kAcceleration = ".acceleration";
    if (robot_.find_joint(name)) {
      return std::nullopt;
    }
    if (name.ends_with(kVelocity)) {
      return std::pair(name.substr(0, name.size() - kVelocity.size()),
                       &TrajectoryPoint::velocities);
    }
    if (name.ends_with(kAcceleration)) {
      return std::pair(name.substr(0, name.size() - kAcceleration.size()),
                       &TrajectoryPoint::accelerations);
    }
    return std::nullopt;
  }

  void add_joint(std::string_view name) {
    if (is_time(name) || derivative(name)) {
      return;
    }
    try {
      const JointCoordinate coordinate = find_coordinate(robot_, name);
      if (!joints_.insert({coordinate, trajectory_.joint_names.size()}).second) {
        fail("column " + in_quotes(name) + ": expected each joint once, got it again");
      }
    } catch (const std::invalid_argument& error) {
      fail("column " + in_quotes(name) + ": " + error.what());
    }
    trajectory_.joint_names.emplace_back(name);
  }

  void add_column(std::string_view name) {
    Column column{.name = std::string(name)};
    if (!is_time(name)) {
      const auto of = derivative(name);
      column.numbers = of ? of->second : &TrajectoryPoint::positions;
      column.joint = index_of(of ? of->first : name, name);
    }
    for (const Column& other : columns_) {
      if (other.numbers == column.numbers && other.joint == column.joint) {
        fail("column " + in_quotes(name) + ": expected each column once, got it again");
      }
    }
    columns_.push_back(std::move(column));
  }

  [[nodiscard]] std::size_t index_of(std::string_view joint, std::string_view column) const {
    const auto& names = trajectory_.joint_names;
    const auto found = std::find(names.begin(), names.end(), joint);
    if (found == names.end()) {
      fail("column " + in_quotes(column) + ": expected a column " + in_quotes(joint) +
           " of positions, too, got none");
    }
    return static_cast<std::size_t>(found - names.begin());
  }

  [[nodiscard]] std::size_t count(std::vector<double> TrajectoryPoint::*numbers) const {
    return static_cast<std::size_t>(
        std::count_if(columns_.begin(), columns_.end(),
                      [&](const Column& column) { return column.numbers == numbers; }));
  }

  [[nodiscard]] bool has(std::vector<double> TrajectoryPoint::*numbers) const {
    return count(numbers) > 0;
  }

  void require_for_all(std::vector<double> TrajectoryPoint::*numbers, const char* ending) const {
    for (std::size_t joint = 0; has(numbers) && joint < trajectory_.joint_names.size(); ++joint) {
      const auto same = [&](const Column& column) {
        return column.numbers == numbers && column.joint == joint;
      };
      if (std::none_of(columns_.begin(), columns_.end(), same)) {
        fail("expected a column " + in_quotes(trajectory_.joint_names[joint] + ending) +
             ", as other joints have one, got none");
      }
    }
  }

  void read_point(std::string_view line) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() != columns_.size()) {
      fail("expected " + std::to_string(columns_.size()) +
           " numbers, as the header has columns, got " + std::to_string(fields.size()));
    }
    TrajectoryPoint point;
    for (const Column& column : columns_) {
      if (column.numbers != nullptr) {
        (point.*column.numbers).resize(trajectory_.joint_names.size());
      }
    }
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const Column& column = columns_[k];
      const double number = read_number(fields[k], column);
      (column.numbers == nullptr ? point.time : (point.*column.numbers)[column.joint]) = number;
    }
    require_later(point.time);
    trajectory_.points.push_back(std::move(point));
  }

  [[nodiscard]] double read_number(std::string_view field, const Column& column) const {
    constexpr double kLargest = 1e8;  // Of a CoordinatePath.
    const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
    double number = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool whole = error == std::errc() && end == digits.data() + digits.size();
    const bool in_range = column.numbers == nullptr ? number >= 0.0 && std::isfinite(number)
                                                    : std::abs(number) <= kLargest;
    if (!whole || !in_range) {
      fail("column " + in_quotes(column.name) + ": expected a number " +
           (column.numbers == nullptr ? ">= 0" : "of at most 1e8 in size") + ", got " +
           in_quotes(field));
    }
    return number;
  }

  void require_later(double time) const {
    if (!trajectory_.points.empty() && !(time > trajectory_.points.back().time)) {
      fail("column \"time\": expected a time later than the one before, " +
           write_json(trajectory_.points.back().time) + " s, got " + write_json(time) + " s");
    }
  }

  std::string_view rest_;
  const std::string& source_;
  const RobotModel& robot_;
  std::size_t line_ = 0;  // Of the last line taken.
  std::vector<Column> columns_;
  std::map<JointCoordinate, std::size_t> joints_;
  Trajectory trajectory_;
};

}  // namespace

Trajectory read_trajectory_table(std::string_view text, const std::string& source,
                                 const RobotModel& robot) {
  return TableReader(text, source, robot).read();
}

}  // namespace firstcontact::detail
