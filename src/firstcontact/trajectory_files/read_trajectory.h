/// @file
/// Reads a robot's trajectory from a file.

#pragma once

#include <filesystem>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact {

/// Reads a trajectory for a robot (docs/trajectories.md).
///
/// - .json, .yaml, .yml: `joint_names` and `points` with `time` [s], `positions`, and if wanted
///   `velocities` and `accelerations`. Or trajectory_msgs/JointTrajectory as ROS prints it, alone
///   or inside of a message that holds one. The file has a single trajectory; unknown keys are
///   errors.
/// - .csv: a header with `time` and joint names, then a line of numbers for each point. Commas,
///   semicolons, tabs or blanks separate columns. Columns NAME.velocity and NAME.acceleration,
///   where there are any, are there for every joint.
///
/// A point that stands twice is taken once. Columns of joints that are fixed and do not move are
/// left out. `warnings` report both. Points that contradict each other are an error.
///
/// Numbers are read exactly, whatever the locale.
///
/// @throws ParseError  one line with path, line, place and what was expected
[[nodiscard]] FIRSTCONTACT_API Trajectory read_trajectory(const std::filesystem::path& path,
                                                          const RobotModel& robot);

/// Parses the text of a trajectory, as read_trajectory() reads it.
///
/// @param source  names the text in errors; its extension gives the format
[[nodiscard]] FIRSTCONTACT_API Trajectory parse_trajectory(std::string_view text,
                                                           const std::filesystem::path& source,
                                                           const RobotModel& robot);

}  // namespace firstcontact
