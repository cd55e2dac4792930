/// @file
/// The links of a robot in a user's hand that grips move against each other.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <firstcontact/scene/haptic_question.h>

namespace firstcontact {
class RobotScene;
struct SceneRobot;
}  // namespace firstcontact

namespace firstcontact::detail {

/// The links of a tool, with their indices in the robot.
struct MovingLinks {
  std::size_t body = 0;             ///< Link of the robot that is the body of the tool.
  std::vector<std::size_t> number;  ///< Link of the robot for each of HapticToolQuestion::links.
};

/// Fills in the joints and links of a tool, without bodies.
///
/// The tool's body is the first link with a geometry that no grip moves. Its frame is that of the
/// robot's root. Joints that mimic others move along. Links without a geometry are left out, unless
/// a joint moves them.
///
/// @param robot  index of the robot that is the tool
/// @throws std::invalid_argument  names the robot: grips move all links, or a joint starts out of
///         its limits
[[nodiscard]] MovingLinks find_moving_links(const RobotScene& robots, std::size_t robot,
                                            const SceneRobot& described, HapticToolQuestion& tool);

/// Whether two links are connected by one joint, or by no joint that moves.
///
/// @param a, b  links of the tool; none for its body
[[nodiscard]] bool are_connected(const HapticToolQuestion& tool, std::optional<std::size_t> a,
                                 std::optional<std::size_t> b);

}  // namespace firstcontact::detail
