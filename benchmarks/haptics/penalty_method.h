/// @file
/// A discrete penalty method as a peer of the god-object: forces by the depth of penetration.

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The gains of a penalty method.
struct PenaltyGains {
  double stiffness = 1000.0;  ///< [N/m]  Of a point; that of more than ten points is ten times it.
  double damping = 0.0;       ///< [s]  By stiffness.
  /// Whether a spring holds the tool at the device, as the god-object's does. The tool is where the
  /// spring and the penalties are in equilibrium. Else the tool is at the device.
  bool is_coupled = false;
};

/// A force and its torque about the centre of the tool.
struct PenaltyForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]
};

/// A tool and a fixed body as closed meshes, with points on both that may penetrate the other.
///
/// Distances are exact and signed, by the nearest triangle; no grid rounds them. The normal of a
/// point that penetrates is that of the nearest triangle of the other surface whose normal is
/// opposed to the point's own. So a point does not leave through the wrong side of a wall.
class PenaltyMethod {
 public:
  /// @param X_WB     pose of the tool at the begin
  /// @param p_BC     [m]  centre of the tool
  /// @param spacing  [m]  greatest distance of neighbouring points on a triangle
  PenaltyMethod(const Mesh& tool, const Mesh& body, const Pose& X_WB, const Eigen::Vector3d& p_BC,
                double spacing, const PenaltyGains& gains);
  ~PenaltyMethod();

  /// Computes the force on the hand.
  ///
  /// @param target   pose X_WB of the tool at the device
  /// @param seconds  [s]  since the tick before
  PenaltyForce tick(const Pose& target, double seconds);

  /// [m]  Depth of the deepest point of the tool in the last tick.
  [[nodiscard]] double depth() const;
  [[nodiscard]] const Pose& tool() const;  ///< Pose of the tool in the last tick.

  /// The springs of the coupling, as HapticCoupling has them by default.
  static constexpr double kCoupling = 1000.0;      ///< [N/m]
  static constexpr double kAngularCoupling = 1.0;  ///< [N m/rad]

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace firstcontact
