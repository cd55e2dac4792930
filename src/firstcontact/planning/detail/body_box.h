/// @file
/// The box in which a body is planned where the question has none.

#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>

namespace firstcontact {
class RobotScene;
}

namespace firstcontact::detail {

/// [m]  Corners of a box around all that there is at any time, with room for the mover around it.
///
/// Members are as large as the mover sees them: with their thickness, the margin of the pair and
/// both paddings. What moves is looked at at some times; the room around it makes up for those
/// between.
///
/// @param scene  its first robot is the mover
[[nodiscard]] std::array<Eigen::Vector3d, 2> box_around(const RobotScene& scene,
                                                        const std::vector<Pose>& goals);

}  // namespace firstcontact::detail
