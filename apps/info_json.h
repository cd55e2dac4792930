/// @file
/// What `info` says, as JSON: one line for each file.

#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/articulated/robot_model.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/mesh_defects.h>

namespace firstcontact::app {

/// @returns  with the line feed, as all here
[[nodiscard]] std::string mesh_json(const std::string& file, const Mesh& mesh,
                                    const MeshDefects& found);

[[nodiscard]] std::string points_json(const std::string& file,
                                      const std::vector<Eigen::Vector3d>& points);

/// @param robot  read with its collision shapes
[[nodiscard]] std::string robot_json(const std::string& file, const RobotModel& robot);

}  // namespace firstcontact::app
