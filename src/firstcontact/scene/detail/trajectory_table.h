/// @file
/// Reads a trajectory from comma-separated values.

#pragma once

#include <string>
#include <string_view>

#include <firstcontact/articulated/robot_model.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact::detail {

/// A header of `time` and joint names, with NAME.velocity and NAME.acceleration where wanted, then
/// one line of numbers for each point. A '#' may stand before the header; empty lines are passed
/// over.
///
/// @throws ParseError
[[nodiscard]] Trajectory read_trajectory_table(std::string_view text, const std::string& source,
                                               const RobotModel& robot);

}  // namespace firstcontact::detail
