/// @file
/// The output of `info` as JSON: one line for each file.

#pragma once

#include <string>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/mesh_files/read_points.h>
#include <firstcontact/robot_files/read_urdf.h>

namespace firstcontact::app {

/// Writes the report on a mesh.
///
/// @returns a line with its line feed, as all functions here
[[nodiscard]] std::string mesh_json(const std::string& file, const MeshReading& reading,
                                    const MeshDefects& found);

[[nodiscard]] std::string points_json(const std::string& file, const PointReading& cloud);

/// Writes the report on a robot.
///
/// @param reading  with collision shapes
[[nodiscard]] std::string robot_json(const std::string& file, const RobotReading& reading);

}  // namespace firstcontact::app
