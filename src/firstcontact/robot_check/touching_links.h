/// @file
/// Links that touch where the robot rests: pairs that are best left out of a check.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

/// Two links by index, the smaller one first.
struct LinkPairIndex {
  std::size_t link = 0;
  std::size_t other = 0;

  friend bool operator==(const LinkPairIndex&, const LinkPairIndex&) = default;
};

/// Makes the motion of a robot at rest in its default configuration.
///
/// Every coordinate is 0, or the limit next to it; floating and ball joints are at the identity.
[[nodiscard]] FIRSTCONTACT_API RobotMotion at_rest(const RobotModel& model);

/// Finds all pairs of links whose collision geometries are no farther than `margin` apart at t = 0.
///
/// They are in order of their indices, those of adjacent links included. A solid touches geometry
/// that is inside of it. Poses are rounded to doubles first: pairs within 1e-12 of the robot's size
/// may go either way.
///
/// @param motion  the motion of a robot whose collision shapes were made (LoadShapes)
/// @param margin  [m]  >= 0
/// @throws std::invalid_argument if a collision geometry has no shape, or the margin is out of
///         range
[[nodiscard]] FIRSTCONTACT_API std::vector<LinkPairIndex> touching_links(const RobotMotion& motion,
                                                                         double margin = 0.0);

}  // namespace firstcontact
