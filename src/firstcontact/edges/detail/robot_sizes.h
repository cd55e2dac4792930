/// @file
/// The sizes of a robot's coordinates along an edge: their roundings are fractions of them.

#pragma once

#include <cstddef>
#include <span>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact::detail {

/// Whether a coordinate of a joint is a distance along an axis [m], in place of an angle.
[[nodiscard]] bool is_slide(JointType type, std::size_t index);

/// Sums of the sizes of coordinates. Joints that mimic others count with their own coordinate, and
/// screws as both.
struct RobotSizes {
  double planned_turns = 0.0;   ///< [rad]  For joints that the edge turns.
  double planned_slides = 0.0;  ///< [m]  For joints that the edge slides.
  double slides = 0.0;          ///< [m]  For all joints that slide, those at rest included.
};

/// Sums the sizes of a mover's coordinates.
///
/// @param rest            A motion for every joint that moves. Those that no edge moves rest.
/// @param mover           The robot, as coordinates number it.
/// @param of_coordinates  [rad or m]  A bound of the size of each coordinate.
[[nodiscard]] RobotSizes robot_sizes(const RobotMotion& rest, std::size_t mover,
                                     std::span<const SpaceCoordinate> coordinates,
                                     std::span<const double> of_coordinates);

}  // namespace firstcontact::detail
