/// @file
/// The speeds of a mover among things that move.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/scene/plan_question.h>

namespace firstcontact::detail {

/// [rad/s or m/s]  The greatest speed of each coordinate, or of the origin and the turn of a body.
///
/// It is that of the question, else that of the robot. A joint that others mimic is so slow that
/// each of them keeps the velocity limit of the robot.
///
/// @param moving  the cause that makes speeds matter, for errors
/// @throws std::invalid_argument  names the coordinate that has none
[[nodiscard]] std::vector<double> planned_speeds(const PlanQuestion& question,
                                                 const ConfigurationSpace& space,
                                                 const std::string& moving);

}  // namespace firstcontact::detail
