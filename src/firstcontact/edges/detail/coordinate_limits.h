/// @file
/// The limits of a robot's coordinates, and its length.

#pragma once

#include <cstddef>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/robot/robot_model.h>

namespace firstcontact::detail {

/// Takes the limits of a coordinate, or its sampled range where it has none; within those of the
/// joints that mimic it.
///
/// @param coordinate  its joint and index are known
void take_limits(const RobotModel& model, SpaceCoordinate& coordinate);

/// [m]  Bounds the distance of any point of the robot from the root, without the displacements of
/// sliding and floating joints.
[[nodiscard]] double length_of(const RobotModel& model);

}  // namespace firstcontact::detail
