/// @file
/// Two bodies at one instant, with their relative motion from there on.

#pragma once

#include <Eigen/Core>

namespace firstcontact {

/// The relative state of two bodies. World axes, origin at point C of body A; any frame serves as
/// the world that both motions share.
///
/// From t on each body P turns at a constant rate about its pivot Qp, and the pivots move on lines.
/// This motion, which follows from these numbers alone, is the body's model motion. The exact
/// motion of a point may depart from it. Take points within the radii for which the state was made,
/// at distances d_A, d_B from the pivots of their bodies. Summed over both bodies, the departure is
/// at most
///   drift tau + (bend + bend_A d_A + bend_B d_B) tau^2 / 2,   0 <= tau <= time left of the piece.
/// All four are zero for motions of constant rates, up to the rounding of the numbers here.
struct RelativeState {
  double t = 0.0;
  Eigen::Matrix3d R_WA = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_AB = Eigen::Vector3d::Zero();   ///< [m]  From A's point C to B's.
  Eigen::Vector3d p_AQa = Eigen::Vector3d::Zero();  ///< [m]  A's pivot.
  Eigen::Vector3d p_AQb = Eigen::Vector3d::Zero();  ///< [m]  B's pivot.

  Eigen::Vector3d axis_A = Eigen::Vector3d::Zero();  ///< [-]  Unit; zero where A does not turn.
  Eigen::Vector3d axis_B = Eigen::Vector3d::Zero();  ///< [-]  The same for B.
  double rate_A = 0.0;                               ///< [rad per step]  >= 0; about axis_A.
  double rate_B = 0.0;                               ///< [rad per step]  >= 0; about axis_B.
  Eigen::Vector3d pivot_velocity =
      Eigen::Vector3d::Zero();  ///< [m per step]  B's pivot relative to A's.
  double drift = 0.0;           ///< [m per step]
  double bend = 0.0;            ///< [m per step^2]
  double bend_A = 0.0;          ///< [per step^2]
  double bend_B = 0.0;          ///< [per step^2]

  /// [m per step^2]  The whole bend of points at these distances [m] from their pivots.
  [[nodiscard]] double bend_of(double d_A, double d_B) const {
    return bend + bend_A * d_A + bend_B * d_B;
  }

  double position_error = 0.0;    ///< [m]  Error of p_AB, beyond one rounding of its size.
  double rotation_error_A = 0.0;  ///< [-]  Error of R y, relative to |y|; beyond 22 2^-53 |y|.
  double rotation_error_B = 0.0;  ///< [-]  The same for B.
};

}  // namespace firstcontact
