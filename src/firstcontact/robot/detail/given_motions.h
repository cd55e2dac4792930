/// @file
/// The motions that were given to the joints of a robot, by name.

#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include <firstcontact/robot/robot_motion.h>

namespace firstcontact::detail {

/// Returns the motions of all joints that have one: a RobotMotion of them moves alike.
[[nodiscard]] inline std::map<std::string, JointMotion> given_motions(const RobotMotion& motion) {
  std::map<std::string, JointMotion> motions;
  for (std::size_t joint = 0; joint < motion.model().joints().size(); ++joint) {
    if (const std::optional<JointMotion> given = motion.given(joint)) {
      motions.emplace(motion.model().joints()[joint].name, *given);
    }
  }
  return motions;
}

}  // namespace firstcontact::detail
