/// @file
/// The points of movers whose ways a page draws.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact::app {

/// The movers of a plan, by the names of its scene.
struct Movers {
  std::vector<std::string> robots = {};  ///< Empty where a body moves alone.
  std::string body = {};                 ///< Empty where robots move alone.
  std::vector<std::string> joints = {};  ///< Planned coordinates; ROBOT/NAME of several movers.
};

/// A point that is fixed in a member M of a scene.
struct TracedPoint {
  std::string name;                                ///< Name of the member.
  std::size_t member = 0;                          ///< Bodies are numbered before links.
  Eigen::Vector3d p_MP = Eigen::Vector3d::Zero();  ///< [m]

  /// [m]  The point in the world, for the member at a pose.
  [[nodiscard]] Eigen::Vector3d at(const Pose& X_WM) const;
};

/// The point that is traced of each mover.
///
/// For a body it is the middle of the box around its shape, along the axes of the body. For a robot
/// it is the origin of a link: of those that planned joints move and that have geometry, the link
/// with the most joints between it and the root. The first one of several counts.
[[nodiscard]] std::vector<TracedPoint> traced_points(const LoadedScene& loaded,
                                                     const Movers& movers);

/// The pose of a member of a scene.
///
/// @param t  [-]  in [0, 1]
[[nodiscard]] Pose pose_of_member(const LoadedScene& loaded, std::size_t member, double t);

}  // namespace firstcontact::app
