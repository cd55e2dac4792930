/// @file
/// Joint positions that a question states beside the robot's motion.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact::detail {

/// Positions of joints that move, and a warning for those that were left out.
struct GivenPositions {
  JointPositions positions;
  std::vector<std::string> warnings;
};

/// Reads positions from words: states of the SRDF, or NAME=POSITION.
///
/// Later states override earlier ones; a joint is named once.
///
/// @param what  whose positions these are, for errors and warnings
/// @throws std::invalid_argument if the robot has no such state or joint
[[nodiscard]] GivenPositions positions_of(const std::vector<std::string>& texts,
                                          const std::string& what, const SceneRobot& robot);

/// Reads positions from a planning scene's robot_state, for joints that the robot's trajectory does
/// not name.
///
/// Joints that mimic others are left out. Joints that the robot does not have are left out with a
/// warning.
///
/// @param source  names the file in warnings
[[nodiscard]] GivenPositions positions_at_rest(const JointPositions& state,
                                               const std::string& source, const SceneRobot& robot);

}  // namespace firstcontact::detail
