#include <firstcontact/retiming/joint_limits.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/json_tree.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/text_tree.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::JsonObject;
using detail::JsonReader;
using detail::JsonValue;

/// One limit of a joint in the file.
///
/// @param name  "velocity": its keys are "has_velocity_limits" and "max_velocity"
std::optional<double> limit_in(const JsonObject& joint, const std::string& name,
                               const JsonReader& read) {
  const JsonValue* has = find(joint, "has_" + name + "_limits");
  const JsonValue* most = find(joint, "max_" + name);
  if (has != nullptr && !read.boolean(*has)) {
    return std::nullopt;
  }
  if (most == nullptr) {
    if (has != nullptr) {
      read.fail(*has, "expected " + detail::in_quotes("max_" + name) + " beside it, got none");
    }
    return std::nullopt;
  }
  return read.positive(*most);
}

GivenLimits limits_in(const JsonValue& value, const JsonReader& read) {
  const JsonObject& joint = read.object(
      value, {{"has_position_limits", "min_position", "max_position", "has_velocity_limits",
               "min_velocity", "max_velocity", "has_acceleration_limits", "min_acceleration",
               "max_acceleration", "has_deceleration_limits", "max_deceleration", "has_jerk_limits",
               "min_jerk", "max_jerk", "has_effort_limits", "max_effort", "angle_wraparound"}});
  GivenLimits limits{.velocity = limit_in(joint, "velocity", read),
                     .acceleration = limit_in(joint, "acceleration", read),
                     .jerk = limit_in(joint, "jerk", read)};
  const JsonValue* slows = find(joint, "max_deceleration");
  const JsonValue* has_one = find(joint, "has_deceleration_limits");
  if (slows != nullptr && (has_one == nullptr || read.boolean(*has_one))) {
    const double size = std::abs(read.number(*slows));  // Some files give it with a minus sign.
    if (!(size > 0.0)) {
      read.fail_expected("a number that is not 0", *slows);
    }
    limits.acceleration = std::min(limits.acceleration.value_or(size), size);
  }
  return limits;
}

/// The limits of positions of a joint in the file.
void take_positions(const JsonValue& value, const Joint& moved, const JsonReader& read,
                    GivenLimits& limits) {
  const auto& joint = std::get<JsonObject>(value.value);
  const JsonValue* has = find(joint, "has_position_limits");
  const JsonValue* lower = find(joint, "min_position");
  const JsonValue* upper = find(joint, "max_position");
  if (has != nullptr && !read.boolean(*has)) {
    return;
  }
  if (lower == nullptr && upper == nullptr) {
    if (has != nullptr) {
      read.fail(*has, "expected \"min_position\" or \"max_position\" beside it, got none");
    }
    return;
  }
  if (moved.type != JointType::revolute && moved.type != JointType::prismatic) {
    read.fail(lower != nullptr ? *lower : *upper,
              "expected limits of positions of a revolute or prismatic joint alone, " +
                  detail::in_quotes(moved.name) + " is another one");
  }
  PositionLimits& positions = limits.positions;
  positions.lower = lower != nullptr ? std::optional(read.number(*lower)) : std::nullopt;
  positions.upper = upper != nullptr ? std::optional(read.number(*upper)) : std::nullopt;
  if (positions.lower && positions.upper && !(*positions.lower <= *positions.upper)) {
    read.fail(*upper, "expected no less than \"min_position\"");
  }
}

[[noreturn]] void refuse_missing(const std::string& joint, const char* rate) {
  throw std::invalid_argument("joint " + detail::in_quotes(joint) + ": expected a limit of the " +
                              rate + ", got none");
}

/// The lesser of two limits, each of which may be missing.
std::optional<double> least(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

/// Chooses the limits of the joints of one robot from their sources.
class LimitSources {
 public:
  LimitSources(const RobotModel& robot, const std::map<std::string, GivenLimits>& given,
               const GivenLimits& others)
      : robot_(robot), given_(given), others_(others) {
    for (const auto& [name, limits] : given) {
      if (!names_fixed_joint(robot, name)) {
        (void)find_coordinate(robot, name);
      }
    }
  }

  /// The limits of a joint, within those of the joints that mimic it.
  [[nodiscard]] RateLimits limits(const std::string& name) const {
    const JointCoordinate coordinate = find_coordinate(robot_, name);
    if (robot_.joints()[coordinate.joint].type == JointType::floating) {
      throw std::invalid_argument("joint " + detail::in_quotes(name) +
                                  ": expected joints with coordinates of their own, this one is "
                                  "floating: no controller of joints executes its pose");
    }
    const GivenLimits given = given_for(name);
    const std::optional<double> own = velocity_of_robot(coordinate.joint);
    const GivenLimits first = with_others({.velocity = given.velocity ? given.velocity : own,
                                           .acceleration = given.acceleration,
                                           .jerk = given.jerk});
    if (!first.velocity) {
      refuse_missing(name, "velocity");
    }
    if (!first.acceleration) {
      refuse_missing(name, "acceleration");
    }
    RateLimits limits{*first.velocity, *first.acceleration, first.jerk};
    narrow_by_mimics(coordinate.joint, 1.0, limits);
    return limits;
  }

 private:
  [[nodiscard]] GivenLimits given_for(const std::string& name) const {
    const auto found = given_.find(name);
    return found == given_.end() ? GivenLimits{} : found->second;
  }

  [[nodiscard]] std::optional<double> velocity_of_robot(std::size_t joint) const {
    const std::optional<double> velocity = robot_.joints()[joint].limits.velocity;
    return velocity.value_or(0.0) != 0.0 ? velocity : std::nullopt;
  }

  [[nodiscard]] GivenLimits with_others(const GivenLimits& first) const {
    return {.velocity = first.velocity ? first.velocity : others_.velocity,
            .acceleration = first.acceleration ? first.acceleration : others_.acceleration,
            .jerk = first.jerk ? first.jerk : others_.jerk};
  }

  /// Narrows the limits of a coordinate to those of the joints that mimic it, and so on.
  ///
  /// @param factor  [-]  the named joint moves this many times as fast as the coordinate
  void narrow_by_mimics(std::size_t joint, double factor, RateLimits& limits) const {
    for (std::size_t other = 0; other < robot_.joints().size(); ++other) {
      const Joint& follower = robot_.joints()[other];
      if (!follower.mimic || follower.mimic->joint != robot_.joints()[joint].name) {
        continue;
      }
      const double speed = std::abs(follower.mimic->multiplier) * factor;
      if (speed > 0.0) {
        narrow(limits_of_follower(other), speed, limits);
        narrow_by_mimics(other, speed, limits);
      }
    }
  }

  /// The given limits of a follower. The velocity of its robot always counts, as the proof has it.
  [[nodiscard]] GivenLimits limits_of_follower(std::size_t joint) const {
    const GivenLimits given = given_for(robot_.joints()[joint].name);
    return with_others({.velocity = least(given.velocity, velocity_of_robot(joint)),
                        .acceleration = given.acceleration,
                        .jerk = given.jerk});
  }

  static void narrow(const GivenLimits& follower, double speed, RateLimits& limits) {
    const auto within = [&](const std::optional<double>& limit) {
      // Rounded down: the follower's limit holds where the leader's does.
      return limit ? std::optional(std::nextafter(*limit / speed, 0.0)) : std::nullopt;
    };
    limits.velocity = *least(limits.velocity, within(follower.velocity));
    limits.acceleration = *least(limits.acceleration, within(follower.acceleration));
    limits.jerk = least(limits.jerk, within(follower.jerk));
  }

  const RobotModel& robot_;
  const std::map<std::string, GivenLimits>& given_;
  const GivenLimits& others_;
};

}  // namespace

std::map<std::string, GivenLimits> parse_joint_limits(std::string_view text,
                                                      const std::filesystem::path& source,
                                                      const RobotModel& robot) {
  const std::string name = source.string();
  if (!detail::is_tree_extension(detail::file_extension(source))) {
    throw ParseError(name, "expected limits of joints, a .yaml or .json file");
  }
  const JsonValue root = detail::parse_tree(text, source);
  const JsonReader read(root, name);
  (void)read.object(root, {{"joint_limits", "default_velocity_scaling_factor",
                            "default_acceleration_scaling_factor"}});
  const JsonValue& joints = read.member(root, "joint_limits");
  const auto* members = std::get_if<JsonObject>(&joints.value);
  if (members == nullptr) {
    read.fail_expected("an object with the joints", joints);
  }
  std::map<std::string, GivenLimits> result;
  for (const detail::JsonMember& member : *members) {
    if (names_fixed_joint(robot, member.key)) {
      continue;
    }
    std::size_t joint = 0;
    try {
      joint = find_coordinate(robot, member.key).joint;
    } catch (const std::invalid_argument& error) {
      read.fail(member.value, error.what());
    }
    GivenLimits& limits = result[member.key];
    limits = limits_in(member.value, read);
    take_positions(member.value, robot.joints()[joint], read, limits);
  }
  return result;
}

std::map<std::string, GivenLimits> read_joint_limits(const std::filesystem::path& file,
                                                     const RobotModel& robot) {
  return parse_joint_limits(detail::read_file(file, "limits of joints"), file, robot);
}

std::vector<RateLimits> limits_of(const RobotModel& robot,
                                  const std::vector<std::string>& joint_names,
                                  const std::map<std::string, GivenLimits>& given,
                                  const GivenLimits& others) {
  const LimitSources sources(robot, given, others);
  std::vector<RateLimits> limits;
  for (const std::string& name : joint_names) {
    limits.push_back(sources.limits(name));
  }
  require_limits(joint_names, limits);
  return limits;
}

void scale_limits(double velocity_scaling, double acceleration_scaling,
                  std::vector<RateLimits>& limits) {
  for (RateLimits& limit : limits) {
    limit.velocity *= velocity_scaling;
    limit.acceleration *= acceleration_scaling;
  }
}

std::map<std::string, PositionLimits> position_limits_of(
    const std::map<std::string, GivenLimits>& given) {
  std::map<std::string, PositionLimits> positions;
  for (const auto& [joint, limits] : given) {
    if (limits.positions.lower || limits.positions.upper) {
      positions[joint] = limits.positions;
    }
  }
  return positions;
}

}  // namespace firstcontact
