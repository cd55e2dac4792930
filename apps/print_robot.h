/// @file
/// What `info` says of a robot.

#pragma once

#include <string>

#include <firstcontact/articulated/robot_model.h>

namespace firstcontact::app {

/// Prints counts, the tree with limits and collision geometry, and what is unusual about it.
///
/// @param robot  read with its collision shapes
void print_robot(const std::string& name, const RobotModel& robot);

}  // namespace firstcontact::app
