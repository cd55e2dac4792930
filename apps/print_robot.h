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

/// Prints the pairs of links that touch in the default pose as lines of an SRDF file.
///
/// @param robot  read with its collision shapes
void print_always_in_contact(const RobotModel& robot);

}  // namespace firstcontact::app
