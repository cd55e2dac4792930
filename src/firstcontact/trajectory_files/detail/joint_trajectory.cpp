#include <firstcontact/trajectory_files/detail/joint_trajectory.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/trajectory_points.h>

namespace firstcontact::detail {
namespace {

constexpr std::array<std::string_view, 4> kWrappers = {"joint_trajectory", "trajectory",
                                                       "planned_trajectory", "goal"};

/// Refuses a key with a motion that this reader does not know, as it must not be passed over.
void refuse_other_motion(const JsonObject& object, const JsonReader& read) {
  const JsonValue* multi = find(object, "multi_dof_joint_trajectory");
  const auto* message = multi == nullptr ? nullptr : std::get_if<JsonObject>(&multi->value);
  const JsonValue* points = message == nullptr ? nullptr : find(*message, "points");
  const auto* array = points == nullptr ? nullptr : std::get_if<JsonArray>(&points->value);
  if (array != nullptr && !array->empty()) {
    read.fail(*points,
              "expected no points: joints of several degrees of freedom do not follow "
              "trajectories here; move the robot's \"base\"");
  }
}

/// Finds the trajectory inside of messages that hold one.
const JsonValue& unwrap(const JsonValue& value, const JsonReader& read) {
  if (const auto* array = std::get_if<JsonArray>(&value.value)) {
    if (array->size() != 1) {
      read.fail(value, "expected one trajectory, got " + std::to_string(array->size()) +
                           "; give each a file of its own");
    }
    return unwrap(array->front(), read);
  }
  const auto* object = std::get_if<JsonObject>(&value.value);
  if (object == nullptr) {
    read.fail_expected("a trajectory, an object with \"joint_names\" and \"points\"", value);
  }
  if (find(*object, "points") == nullptr && find(*object, "joint_names") == nullptr) {
    for (const std::string_view wrapper : kWrappers) {
      if (const JsonValue* inside = find(*object, wrapper)) {
        refuse_other_motion(*object, read);
        return unwrap(*inside, read);
      }
    }
  }
  return value;
}

std::vector<std::string> read_names(const JsonValue& value, const RobotModel& robot,
                                    const JsonReader& read) {
  std::vector<std::string> names;
  std::set<std::string> fixed;
  std::set<JointCoordinate> moving;
  for (const JsonValue& element : read.array(value, "an array of joint names")) {
    names.push_back(name_of(element, "the name of a joint", read));
    try {
      const bool is_new = names_fixed_joint(robot, names.back())
                              ? fixed.insert(names.back()).second
                              : moving.insert(find_coordinate(robot, names.back())).second;
      if (!is_new) {
        read.fail(element, "expected each joint once, got " + in_quotes(names.back()) + " again");
      }
    } catch (const std::invalid_argument& error) {
      read.fail(element, error.what());
    }
  }
  if (names.empty()) {
    read.fail(value, "expected at least one joint name, got none");
  }
  return names;
}

/// Reads seconds and nanoseconds, as the nearest double.
double read_duration(const JsonObject& object, const JsonValue& value, std::string_view seconds,
                     std::string_view nanoseconds, const JsonReader& read) {
  constexpr double kNano = 1e9;
  const auto integer = [&](std::string_view key, double end) {
    const JsonValue* member = find(object, key);
    const double number = member == nullptr ? 0.0 : read.number(*member);
    if (!(number >= 0.0 && number < end && std::trunc(number) == number)) {
      read.fail_expected("an integer from 0 to " + write_json(end - 1.0), *member);
    }
    return number;
  };
  if (find(object, seconds) == nullptr && find(object, nanoseconds) == nullptr) {
    read.fail(value, "expected \"secs\" and \"nsecs\", or \"sec\" and \"nanosec\", got neither");
  }
  // Both integers are below 2^31, so their sum in nanoseconds may be rounded. The quotient is
  // within two roundings of the exact time.
  return (integer(seconds, 2147483648.0) * kNano + integer(nanoseconds, kNano)) / kNano;
}

double read_time(const JsonValue& point, const JsonReader& read) {
  const auto& object = std::get<JsonObject>(point.value);
  const JsonValue* time = find(object, "time");
  const JsonValue* from_start = find(object, "time_from_start");
  if ((time == nullptr) == (from_start == nullptr)) {
    read.fail(point, "expected \"time\" [s] or \"time_from_start\", got " +
                         std::string(time == nullptr ? "neither" : "both"));
  }
  if (time != nullptr) {
    return read.not_negative(*time);
  }
  const auto* duration = std::get_if<JsonObject>(&from_start->value);
  if (duration == nullptr) {
    return read.not_negative(*from_start);
  }
  (void)read.object(*from_start, {{"secs", "nsecs", "sec", "nanosec"}});
  return find(*duration, "secs") != nullptr || find(*duration, "nsecs") != nullptr
             ? read_duration(*duration, *from_start, "secs", "nsecs", read)
             : read_duration(*duration, *from_start, "sec", "nanosec", read);
}

/// Reads as many numbers as there are joints; none where optional numbers are left out.
std::vector<double> read_numbers(const JsonObject& point, std::string_view key, std::size_t joints,
                                 const JsonReader& read) {
  const JsonValue* value = find(point, key);
  std::vector<double> numbers;
  if (value == nullptr || std::holds_alternative<JsonNull>(value->value)) {
    return numbers;
  }
  for (const JsonValue& element : read.array(*value, "an array of numbers")) {
    numbers.push_back(joint_position(element, read));
  }
  if (!numbers.empty() && numbers.size() != joints) {
    read.fail(*value, "expected a number for each of the " + std::to_string(joints) +
                          " joint names, got " + std::to_string(numbers.size()));
  }
  return numbers;
}

TrajectoryPoint read_point(const JsonValue& value, std::size_t joints, const JsonReader& read) {
  const JsonObject& object = read.object(
      value, {{"time", "time_from_start", "positions", "velocities", "accelerations", "effort"}});
  TrajectoryPoint point;
  point.time = read_time(value, read);
  point.positions = read_numbers(object, "positions", joints, read);
  point.velocities = read_numbers(object, "velocities", joints, read);
  point.accelerations = read_numbers(object, "accelerations", joints, read);
  if (point.positions.empty()) {
    read.fail(value, "expected \"positions\", a number for each of the " + std::to_string(joints) +
                         " joint names, got none");
  }
  if (point.velocities.empty() && !point.accelerations.empty()) {
    read.fail(read.member(value, "accelerations"),
              "expected \"velocities\" beside \"accelerations\", got none");
  }
  return point;
}

/// Requires that all points have the same numbers, as these determine the motion between them.
void require_alike(const TrajectoryPoint& point, const TrajectoryPoint& first,
                   const JsonValue& value, const JsonReader& read) {
  const auto compare = [&](const char* key, bool here, bool before) {
    if (here != before) {
      read.fail(value, "expected " + in_quotes(key) + " in all points or in none, got them " +
                           (here ? "here and not in the first" : "in the first and not here"));
    }
  };
  compare("velocities", !point.velocities.empty(), !first.velocities.empty());
  compare("accelerations", !point.accelerations.empty(), !first.accelerations.empty());
}

}  // namespace

std::string name_of(const JsonValue& value, const std::string& what, const JsonReader& read) {
  const auto* number = std::get_if<double>(&value.value);
  return number != nullptr ? write_json(*number) : read.string(value, what);
}

double joint_position(const JsonValue& value, const JsonReader& read) {
  constexpr double kLargest = 1e8;
  const double number = read.number(value);
  if (!(std::abs(number) <= kLargest)) {
    read.fail_expected("a number of at most 1e8 in size", value);
  }
  return number;
}

Trajectory read_joint_trajectory(const JsonValue& value, const RobotModel& robot,
                                 const std::string& source, const JsonReader& read) {
  const JsonValue& message = unwrap(value, read);
  (void)read.object(message, {{"joint_names", "points", "header"}});
  const JsonValue& joints = read.member(message, "joint_names");
  const std::vector<std::string> names = read_names(joints, robot, read);
  TrajectoryPoints trajectory(names);
  const JsonValue& points = read.member(message, "points");
  for (const JsonValue& element : read.array(points, "an array of points")) {
    TrajectoryPoint point = read_point(element, names.size(), read);
    if (!trajectory.empty()) {
      require_alike(point, trajectory.first(), element, read);
    }
    try {
      trajectory.add(std::move(point));
    } catch (const std::invalid_argument& error) {
      read.fail(element, error.what());
    }
  }
  if (trajectory.empty()) {
    read.fail(points, "expected at least one point, got none");
  }
  try {
    return trajectory.take(robot, source);
  } catch (const std::invalid_argument& error) {
    read.fail(joints, error.what());
  }
}

}  // namespace firstcontact::detail
