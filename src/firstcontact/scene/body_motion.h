/// @file
/// The motions that a scene can give to a body.

#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A body at rest.
struct FixedMotion {
  Pose pose;
};

/// A motion at constant velocity over the whole duration of the scene.
struct ConstantVelocityMotion {
  Pose from;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]    world frame
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]  world frame
};

/// A rotation about one axis and a translation along it, over the whole duration of the scene.
struct ScrewMotion {
  Pose from;
  Eigen::Vector3d axis_point = Eigen::Vector3d::Zero();       ///< [m]  world frame
  Eigen::Vector3d axis_direction = Eigen::Vector3d::UnitZ();  ///< [-]  world frame, not zero
  double angle = 0.0;                                         ///< [rad]
  double translation = 0.0;                                   ///< [m]  along the axis
};

/// A motion from one pose to another over the whole duration of the scene, by the shortest
/// rotation.
struct TwoPoseMotion {
  Pose from;
  Pose to;
  Between between = Between::constant_velocity;
};

/// A motion through poses at times, at rest before the first and after the last time.
struct WaypointMotion {
  std::vector<double> times;  ///< [s]  >= 0, strictly increasing; as many as poses.
  std::vector<Pose> poses;
  Between between = Between::constant_velocity;
};

/// A motion of every vertex of a mesh on a line, from its coordinates, over the whole duration of
/// the scene.
struct VertexMotion {
  std::vector<Eigen::Vector3d> to;  ///< [m]  World frame; as many as the mesh has vertices.
};

using BodyMotion = std::variant<FixedMotion, ConstantVelocityMotion, ScrewMotion, TwoPoseMotion,
                                WaypointMotion, VertexMotion>;

/// Whether a motion takes the whole duration of the scene, however long that is, to run.
[[nodiscard]] FIRSTCONTACT_API bool spans_duration(const BodyMotion& motion);

/// The certified motion of a body's frame over the scene, t = time / duration in [0, 1].
///
/// Where vertices move, the frame is the world's and stays. Waypoint times are divided by the
/// duration in double precision. The certificate holds for the rounded quotients.
///
/// @param duration  [s]  > 0, at least the last waypoint's time
/// @throws std::invalid_argument as the factories of Motion do
[[nodiscard]] FIRSTCONTACT_API Motion normalised_motion(const BodyMotion& motion, double duration);

}  // namespace firstcontact
