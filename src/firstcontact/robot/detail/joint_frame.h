/// @file
/// The part of a joint's path that is the same for every motion of the robot.

#pragma once

#include <optional>

#include <firstcontact/robot/joint_path.h>
#include <firstcontact/robot/precise_transform.h>
#include <firstcontact/robot/robot_description.h>

namespace firstcontact::detail {

/// A joint that moves, in the frame R of the link that moves before it.
struct JointFrame {
  PreciseTransform X_RJ;
  std::optional<JointPath> path;  ///< The path at zero, to be moved(); only for joints with
                                  ///< coordinates.
};

[[nodiscard]] JointFrame joint_frame(const Joint& joint, const PreciseTransform& X_RJ);

}  // namespace firstcontact::detail
