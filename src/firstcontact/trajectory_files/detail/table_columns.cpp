#include <firstcontact/trajectory_files/detail/table_columns.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <utility>

#include <firstcontact/text/ascii.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

using Numbers = std::vector<double> TrajectoryPoint::*;
using Kind = TableColumn::Kind;

[[noreturn]] void refuse(std::string_view column, const std::string& why) {
  throw std::invalid_argument("column " + in_quotes(column) + ": " + why);
}

/// A name, and the unit in brackets behind it; none where it has none.
struct NameAndUnit {
  std::string_view name;
  std::string_view unit;
};

NameAndUnit split_unit(std::string_view text) {
  const bool bracketed = text.ends_with(']') || text.ends_with(')');
  const std::size_t open = text.find_last_of(text.ends_with(']') ? '[' : '(');
  if (!bracketed || open == std::string_view::npos || open == 0) {
    return {text, {}};
  }
  const std::string_view name = text.substr(0, open);
  return {name.substr(0, name.find_last_not_of(' ') + 1),
          text.substr(open + 1, text.size() - open - 2)};
}

bool is_time_word(std::string_view name) {
  constexpr std::array<std::string_view, 3> kWords = {"time", "__time", "time_from_start"};
  return std::find(kWords.begin(), kWords.end(), lower(name)) != kWords.end();
}

bool is_joint(const RobotModel& robot, std::string_view name) {
  return names_fixed_joint(robot, name) || known_coordinate(robot, name);
}

/// The joint at the end of a name, behind the topic of a message.
///
/// It is the last word, or the last two for a planar or floating joint.
std::optional<std::string_view> joint_after_topic(const RobotModel& robot, std::string_view name) {
  if (is_joint(robot, name)) {
    return name;
  }
  std::size_t slash = name.size();
  for (int words = 0; words < 2 && slash != 0 && slash != std::string_view::npos; ++words) {
    slash = name.rfind('/', slash - 1);
    const std::string_view joint = name.substr(slash == std::string_view::npos ? 0 : slash + 1);
    if (is_joint(robot, joint)) {
      return joint;
    }
  }
  return std::nullopt;
}

/// The meaning of a name for its column.
struct Meaning {
  Kind kind = Kind::numbers;
  Numbers numbers = &TrajectoryPoint::positions;
  std::string joint;
};

std::optional<Meaning> meaning_by_ending(const RobotModel& robot, std::string_view name) {
  struct Ending {
    std::string_view word;
    Kind kind;
    Numbers numbers;
  };
  constexpr std::array kEndings{
      Ending{"position", Kind::numbers, &TrajectoryPoint::positions},
      Ending{"velocity", Kind::numbers, &TrajectoryPoint::velocities},
      Ending{"acceleration", Kind::numbers, &TrajectoryPoint::accelerations},
      Ending{"effort", Kind::effort, nullptr}};
  for (const Ending& ending : kEndings) {
    if (name.size() <= ending.word.size() + 1 || !name.ends_with(ending.word)) {
      continue;
    }
    const std::string_view base = name.substr(0, name.size() - ending.word.size() - 1);
    const char sign = name[base.size()];
    if (sign == '.') {
      return Meaning{ending.kind, ending.numbers, std::string(base)};
    }
    if (const auto joint = sign == '/' ? joint_after_topic(robot, base) : std::nullopt) {
      return Meaning{ending.kind, ending.numbers, std::string(*joint)};
    }
  }
  return std::nullopt;
}

void require_seconds(std::string_view column, std::string_view unit) {
  constexpr std::array<std::string_view, 5> kWords = {"", "s", "sec", "second", "seconds"};
  if (std::ranges::find(kWords, unit) == kWords.end()) {
    refuse(column, "expected seconds, got the unit " + in_quotes(unit) +
                       "; convert the numbers, and the name");
  }
}

/// Whether a coordinate is an angle [rad], or else a length [m].
bool is_angle(const RobotModel& robot, const JointCoordinate& coordinate) {
  const JointType type = robot.joints()[coordinate.joint].type;
  if (type == JointType::floating) {
    return false;
  }
  return type == JointType::planar ? coordinate.index == 2 : type != JointType::prismatic;
}

/// The spellings of the unit of a joint's number in files, by the order of its derivative.
std::array<std::string, 3> units_of(bool turns, int order) {
  const std::string length = turns ? "rad" : "m";
  return order == 0   ? std::array{length, length, length}
         : order == 1 ? std::array{length + "/s", length + "/s", length + "/s"}
                      : std::array{length + "/s^2", length + "/s2", length + "/s²"};
}

/// Requires rad for joints that turn and m for those that slide; per second, or its square.
///
/// @param name   name of the joint
/// @param order  order of the derivative
void require_unit(std::string_view column, std::string_view name, std::string_view unit, int order,
                  const RobotModel& robot) {
  constexpr std::array kNumbers = {"positions", "velocities", "accelerations"};
  const std::optional<JointCoordinate> coordinate = known_coordinate(robot, name);
  if (!coordinate) {
    return;  // The joint is fixed, and its numbers move nothing.
  }
  const bool is_floating = robot.joints()[coordinate->joint].type == JointType::floating;
  if (is_floating && coordinate->index >= 3) {
    refuse(column, "expected no unit, as it is a number of a quaternion; got " + in_quotes(unit));
  }
  const bool turns = is_angle(robot, *coordinate);
  const std::array<std::string, 3> units = units_of(turns, order);
  if (std::ranges::find(units, unit) != units.end()) {
    return;
  }
  const bool is_rate = order == 0 && (unit == "rad/s" || unit == "m/s");
  refuse(column, std::string("expected ") + kNumbers.at(static_cast<std::size_t>(order)) + " in " +
                     units[0] + (turns ? ", as the joint turns" : ", as it slides") +
                     "; got the unit " + in_quotes(unit) + "; " +
                     (is_rate ? "name velocities " + std::string(name) + ".velocity"
                              : "convert the numbers, and the name"));
}

Meaning meaning_of(std::string_view column, const RobotModel& robot) {
  if (column == "time") {
    return {Kind::time, nullptr, {}};
  }
  if (is_joint(robot, column)) {
    return {.joint = std::string(column)};
  }
  const auto [name, unit] = split_unit(column);
  if (is_time_word(name)) {
    require_seconds(column, unit);
    return {Kind::time, nullptr, {}};
  }
  if (!unit.empty() && is_joint(robot, name)) {
    require_unit(column, name, unit, 0, robot);
    return {.joint = std::string(name)};
  }
  if (const auto meaning = meaning_by_ending(robot, column)) {
    return *meaning;
  }
  if (const auto meaning = meaning_by_ending(robot, name); meaning && !unit.empty()) {
    if (meaning->kind == Kind::numbers) {
      const int order = meaning->numbers == &TrajectoryPoint::positions    ? 0
                        : meaning->numbers == &TrajectoryPoint::velocities ? 1
                                                                           : 2;
      require_unit(column, meaning->joint, unit, order, robot);
    }
    return *meaning;
  }
  return {.joint = std::string(column)};  // The message of the robot lists its joints.
}

bool is_unnamed(std::string_view name) { return name.empty() || name == "Unnamed: 0"; }

class ColumnReader {
 public:
  explicit ColumnReader(const RobotModel& robot) : robot_(robot) {}

  TableColumns read(const std::vector<std::string>& names) {
    std::vector<Meaning> meanings;
    for (std::size_t k = 0; k < names.size(); ++k) {
      meanings.push_back(k == 0 && is_unnamed(names[0]) ? Meaning{Kind::row, nullptr, {}}
                                                        : meaning_of(names[k], robot_));
      if (meanings[k].numbers == &TrajectoryPoint::positions) {
        add_joint(names[k], meanings[k].joint);
      }
    }
    if (result_.joint_names.empty()) {
      throw std::invalid_argument("expected a column for at least one joint, got none");
    }
    for (std::size_t k = 0; k < names.size(); ++k) {
      add_column(names[k], meanings[k]);
    }
    const auto is_time = [](const TableColumn& column) { return column.kind == Kind::time; };
    if (std::none_of(result_.columns.begin(), result_.columns.end(), is_time)) {
      throw std::invalid_argument("expected a column \"time\" [s], got none");
    }
    require_for_all(&TrajectoryPoint::velocities, ".velocity");
    require_for_all(&TrajectoryPoint::accelerations, ".acceleration");
    if (has(&TrajectoryPoint::accelerations) && !has(&TrajectoryPoint::velocities)) {
      throw std::invalid_argument(
          "expected columns NAME.velocity beside NAME.acceleration, got none");
    }
    return std::move(result_);
  }

 private:
  void add_joint(const std::string& column, const std::string& joint) {
    try {
      if (!names_fixed_joint(robot_, joint)) {
        (void)find_coordinate(robot_, joint);
      }
    } catch (const std::invalid_argument& error) {
      refuse(column, error.what());
    }
    if (column_of(joint)) {
      refuse(column, "expected each joint once, got it again");
    }
    result_.joint_names.push_back(joint);
  }

  [[nodiscard]] std::optional<std::size_t> column_of(std::string_view joint) const {
    const auto& names = result_.joint_names;
    const auto found = std::find(names.begin(), names.end(), joint);
    return found == names.end() ? std::nullopt
                                : std::optional(static_cast<std::size_t>(found - names.begin()));
  }

  void add_column(const std::string& name, const Meaning& meaning) {
    TableColumn column{.name = name, .kind = meaning.kind, .numbers = meaning.numbers};
    if (column.kind == Kind::effort) {
      result_.columns.push_back(std::move(column));
      return;
    }
    if (column.kind == Kind::numbers) {
      const auto joint = column_of(meaning.joint);
      if (!joint) {
        refuse(name,
               "expected a column " + in_quotes(meaning.joint) + " of positions, too, got none");
      }
      column.joint = *joint;
    }
    for (const TableColumn& other : result_.columns) {
      if (column.kind == other.kind && other.numbers == column.numbers &&
          other.joint == column.joint) {
        refuse(name, "expected each column once, got it again");
      }
    }
    result_.columns.push_back(std::move(column));
  }

  [[nodiscard]] bool has(Numbers numbers) const {
    return std::any_of(result_.columns.begin(), result_.columns.end(), [&](const TableColumn& c) {
      return c.kind == Kind::numbers && c.numbers == numbers;
    });
  }

  void require_for_all(Numbers numbers, const char* ending) const {
    for (std::size_t joint = 0; has(numbers) && joint < result_.joint_names.size(); ++joint) {
      const auto same = [&](const TableColumn& column) {
        return column.kind == Kind::numbers && column.numbers == numbers && column.joint == joint;
      };
      if (std::none_of(result_.columns.begin(), result_.columns.end(), same)) {
        throw std::invalid_argument("expected a column " +
                                    in_quotes(result_.joint_names[joint] + ending) +
                                    ", as other joints have one, got none");
      }
    }
  }

  const RobotModel& robot_;
  TableColumns result_;
};

}  // namespace

bool is_time_column(std::string_view name) { return is_time_word(split_unit(name).name); }

TableColumns table_columns(const std::vector<std::string>& names, const RobotModel& robot) {
  return ColumnReader(robot).read(names);
}

}  // namespace firstcontact::detail
