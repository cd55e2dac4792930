/// @file
/// Writes a timed motion as a file that trajectory controllers take.

#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/robot/robot_model.h>

namespace firstcontact {

/// The file that holds a trajectory.
enum class TrajectoryFormat {
  yaml,  ///< trajectory_msgs/JointTrajectory, as `ros2 topic pub` takes it.
  json,  ///< The same message as JSON.
  csv,   ///< A header with `time` and joint names, then a line for each point.
};

/// The ending of each format's files, in the order of the formats.
inline constexpr std::array<const char*, 3> kTrajectoryEndings{".yaml", ".json", ".csv"};

/// The format of a file by its ending; `.yml` is YAML, too.
///
/// @throws std::invalid_argument  names the endings
[[nodiscard]] FIRSTCONTACT_API TrajectoryFormat trajectory_format_of(std::string_view path);

/// Writes a motion. Numbers read back to the same doubles, times are written to the nanosecond.
///
/// In YAML every number has a point, and every exponent a sign. Readers of YAML 1.1, such as that
/// of ROS, take other numbers for words.
[[nodiscard]] FIRSTCONTACT_API std::string write_trajectory(const TimedMotion& motion,
                                                            TrajectoryFormat format);

/// Requires that a file holds the names of joints, so that they are read back as they are.
///
/// A table has columns of its own beside those of joints, such as `time`.
///
/// @throws std::invalid_argument  names the first joint that a file of this format cannot hold
FIRSTCONTACT_API void require_names(const std::vector<std::string>& joint_names,
                                    TrajectoryFormat format, const RobotModel& robot);

}  // namespace firstcontact
