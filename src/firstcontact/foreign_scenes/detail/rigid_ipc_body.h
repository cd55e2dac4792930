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

enum class RigidIpcType { fixed, kinematic, dynamic };

/// SI units and radians, converted as read.
struct RigidIpcBody {
  RigidIpcType type = RigidIpcType::dynamic;
  Pose X_WB;                ///< Of the mesh as it is scaled.
  double density = 1000.0;  ///< [kg/m^3]; of a sheet kg/m^2, of edges kg/m, of points kg.
  std::array<bool, 3> locked_translation{};
  std::array<bool, 3> locked_rotation{};
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();     ///< [m/s]  Of the centre of mass.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();    ///< [rad/s]  World axes.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();               ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();              ///< [N m]  World axes.
  double moves_until = std::numeric_limits<double>::infinity();  ///< [s]  Of a kinematic body.
  /// The poses of a kinematic body's centre of mass and principal axes, at the end of each of the
  /// first steps.
  std::vector<Pose> poses;
};

/// A shape with its mass at density 1: that of the solid or, where the mesh is open, of the thin
/// sheet, wire or points.
struct WeighedShape {
  Shape shape;
  bool is_solid = false;
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< [m]
  Eigen::Matrix3d about_C = Eigen::Matrix3d::Zero();  ///< [kg m^2]  Body axes.
};

/// @throws std::invalid_argument if no shape can be made of the mesh
[[nodiscard]] WeighedShape weigh(const Mesh& mesh);

/// @throws std::invalid_argument if the body has no mass, or no moment about some axis
[[nodiscard]] FreeBody free_body(const RigidIpcBody& body, const WeighedShape& shape);

/// How a kinematic body moves, its frame at the centre of mass, with the mesh's axes.
///
/// @param step      [s]
/// @param duration  [s]  of the simulation
/// @throws std::invalid_argument if it turns too often
[[nodiscard]] BodyMotion scripted_motion(const RigidIpcBody& body, const WeighedShape& shape,
                                         double step, double duration);

}  // namespace firstcontact::detail
