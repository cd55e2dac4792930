/// @file
/// What `info` says of a robot.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot_files/read_urdf.h>

namespace firstcontact::app {

/// What the links of a robot weigh.
struct RobotMass {
  double total = 0.0;       ///< [kg]  Of the links whose mass is given.
  std::size_t missing = 0;  ///< Links without one.
};
[[nodiscard]] RobotMass mass_of(const RobotModel& robot);

/// "mesh", "box", "sphere", "cylinder" or "capsule".
[[nodiscard]] const char* geometry_kind(const LinkGeometry& geometry);

/// What is unusual about a robot.
///
/// @param robot  read with its collision shapes
[[nodiscard]] std::vector<std::string> robot_remarks(const RobotModel& robot);

/// Prints counts, masses, the tree with limits and collision geometry, what is unusual about it,
/// and what became of its files.
///
/// @param reading  with collision shapes
void print_robot(const std::string& name, const RobotReading& reading);

/// Prints the pairs of links that touch in the default pose as lines of an SRDF file.
///
/// @param robot  read with its collision shapes
void print_always_in_contact(const RobotModel& robot);

}  // namespace firstcontact::app
