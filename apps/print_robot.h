/// @file
/// The output of `info` for a robot.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot_files/read_urdf.h>

namespace firstcontact::app {

/// The masses of a robot's links.
struct RobotMass {
  double total = 0.0;       ///< [kg]  Sum over the links whose mass is given.
  std::size_t missing = 0;  ///< Number of links without a mass.
};
[[nodiscard]] RobotMass mass_of(const RobotModel& robot);

/// The kind of a geometry: "mesh", "box", "sphere", "cylinder" or "capsule".
[[nodiscard]] const char* geometry_kind(const LinkGeometry& geometry);

/// Describes unusual properties of a robot.
///
/// @param robot  read with its collision shapes
[[nodiscard]] std::vector<std::string> robot_remarks(const RobotModel& robot);

/// Prints counts, masses, the tree with limits and collision geometry, remarks, and the reports on
/// files.
///
/// @param reading  with collision shapes
void print_robot(const std::string& name, const RobotReading& reading);

/// Prints the pairs of links that touch in the default pose as lines of an SRDF file.
///
/// @param robot  read with its collision shapes
void print_always_in_contact(const RobotModel& robot);

}  // namespace firstcontact::app
