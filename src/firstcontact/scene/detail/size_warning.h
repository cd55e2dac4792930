/// @file
/// What is so large that its unit is likely to be a wrong one.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact::detail {

/// Warns of a body whose mesh is 1,000 m across or more. Of shapes whose size stands in the scene,
/// of clouds and of height maps, any size is meant.
void warn_of_size(const Body& body, const Shape& shape, std::vector<std::string>& warnings);

/// Warns of links that are more than 100 m across.
void warn_of_sizes(const SceneRobot& robot, const RobotModel& loaded,
                   std::vector<std::string>& warnings);

}  // namespace firstcontact::detail
