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

/// [m]  Corners of a box around the whole scene at all times, with room for the mover around it.
///
/// Members have the size that the mover meets: with their thickness, the margin of the pair and
/// both paddings. Moving members are sampled at some times; the room around the box covers those
/// between.
///
/// @param scene  its first robot is the mover
[[nodiscard]] std::array<Eigen::Vector3d, 2> box_around(const RobotScene& scene,
                                                        const std::vector<Pose>& goals);

}  // namespace firstcontact::detail
