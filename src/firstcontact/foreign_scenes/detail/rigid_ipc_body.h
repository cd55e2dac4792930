/// @file
/// One element of "rigid_bodies" of a fixture of Rigid IPC, and the body that it becomes.

#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/simulation.h>

namespace firstcontact::detail {

/// The kinds of motion of a body.
enum class RigidIpcType { fixed, kinematic, dynamic };

/// An element of "rigid_bodies", converted to SI units and radians.
struct RigidIpcBody {
  RigidIpcType type = RigidIpcType::dynamic;
  Pose X_WB;                ///< Pose of the scaled mesh.
  double density = 1000.0;  ///< [kg/m^3]  For a sheet kg/m^2, for edges kg/m, for points kg.
  std::array<bool, 3> locked_translation{};
  std::array<bool, 3> locked_rotation{};
  /// [m/s]  Velocity of the centre of mass.
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]  World axes.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();             ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();            ///< [N m]  World axes.
  /// [s]  End of the motion of a kinematic body.
  double moves_until = std::numeric_limits<double>::infinity();
  /// The poses of a kinematic body at the end of each of the first steps: of its centre of mass and
  /// principal axes.
  std::vector<Pose> poses;
};

/// A shape with its mass at density 1. The mass is that of the solid or, where the mesh is open, of
/// the thin sheet, wire or points.
struct WeighedShape {
  Shape shape;
  bool is_solid = false;
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< [m]  Centre of mass.
  Eigen::Matrix3d about_C = Eigen::Matrix3d::Zero();  ///< [kg m^2]  Body axes.
};

/// Makes a shape of a mesh and weighs it.
///
/// @throws std::invalid_argument if no shape can be made of the mesh
[[nodiscard]] WeighedShape weigh(const Mesh& mesh);

/// Makes the dynamics of a free body.
///
/// @throws std::invalid_argument if the body has no mass, or no moment about some axis
[[nodiscard]] FreeBody free_body(const RigidIpcBody& body, const WeighedShape& shape);

/// Makes the motion of a kinematic body. Its frame is at the centre of mass, with the mesh's axes.
///
/// @param step      [s]
/// @param duration  [s]  of the simulation
/// @throws std::invalid_argument if the motion needs too many waypoints for its turns
[[nodiscard]] BodyMotion scripted_motion(const RigidIpcBody& body, const WeighedShape& shape,
                                         double step, double duration);

}  // namespace firstcontact::detail
