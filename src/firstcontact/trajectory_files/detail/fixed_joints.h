/// @file
/// Positions in files for joints that the robot has fixed.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/scene/trajectory.h>

namespace firstcontact {
class RobotModel;
}

namespace firstcontact::detail {

/// The names of fixed joints among positions.
[[nodiscard]] std::vector<std::string> fixed_joints_in(const RobotModel& robot,
                                                       const JointPositions& positions);

/// The positions without those of fixed joints.
[[nodiscard]] JointPositions without_fixed_joints(const RobotModel& robot,
                                                  JointPositions positions);

/// The warning about all joints of one place: "2 fixed joints are given a position: a, b; ...".
///
/// It is empty where there are none.
///
/// @param names  names of the joints, each once or more
[[nodiscard]] std::string fixed_joints_warning(std::vector<std::string> names);

}  // namespace firstcontact::detail
