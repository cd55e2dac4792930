/// @file
/// Limits of joints from the robot, from a file as MoveIt has it, and for all that have none.

#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/robot/robot_model.h>

namespace firstcontact {

/// The limits that one source has for a joint coordinate.
struct GivenLimits {
  std::optional<double> velocity = {};      ///< [rad/s or m/s]
  std::optional<double> acceleration = {};  ///< [rad/s^2 or m/s^2]
  std::optional<double> jerk = {};          ///< [rad/s^3 or m/s^3]
  PositionLimits positions = {};
};

/// Reads MoveIt's joint_limits.yaml, or the same as JSON.
///
/// Under `joint_limits` each joint has `has_velocity_limits` and `max_velocity`, and likewise for
/// `acceleration`, `deceleration` and `jerk`; of positions `min_position` and `max_position`. A
/// limit whose `has_...` is false is none. The smaller one of an acceleration and a deceleration
/// limits both. Default scaling factors are for requests, and are left out.
///
/// @param source  names the text in errors; its extension gives the format
/// @param robot   as joined_model() where several robots move: joints are then ROBOT/NAME
/// @throws ParseError  names the joint: it is not of the robot, a limit is not > 0, or positions
///         have limits but do not slide or turn between two ends
[[nodiscard]] FIRSTCONTACT_API std::map<std::string, GivenLimits> parse_joint_limits(
    std::string_view text, const std::filesystem::path& source, const RobotModel& robot);

/// Reads a file of limits, as parse_joint_limits() reads its text.
[[nodiscard]] FIRSTCONTACT_API std::map<std::string, GivenLimits> read_joint_limits(
    const std::filesystem::path& file, const RobotModel& robot);

/// The limits of the joints of a path.
///
/// Each number is that of the first source that has it: `given`, the robot (velocities alone),
/// `others`. A velocity limit of 0 in the robot counts as none, as many files have it for an
/// unknown one.
///
/// A joint that others mimic is so slow that each of them keeps its own limits. Their limits have
/// the same sources, except that the smaller velocity of `given` and the robot counts.
///
/// @throws std::invalid_argument  names the joint without a limit of velocity or acceleration, or
///         with one that is not > 0. Also names a joint of `given` that the robot lacks, and a
///         floating joint.
[[nodiscard]] FIRSTCONTACT_API std::vector<RateLimits> limits_of(
    const RobotModel& robot, const std::vector<std::string>& joint_names,
    const std::map<std::string, GivenLimits>& given, const GivenLimits& others);

/// Multiplies velocity and acceleration limits by factors, as requests of MoveIt give them.
///
/// @param velocity_scaling, acceleration_scaling  [-]  in (0, 1]
FIRSTCONTACT_API void scale_limits(double velocity_scaling, double acceleration_scaling,
                                   std::vector<RateLimits>& limits);

/// The limits of positions among given limits, for RetimingScene::positions.
[[nodiscard]] FIRSTCONTACT_API std::map<std::string, PositionLimits> position_limits_of(
    const std::map<std::string, GivenLimits>& given);

}  // namespace firstcontact
