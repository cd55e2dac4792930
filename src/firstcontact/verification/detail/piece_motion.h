/// @file
/// The verifier's own arithmetic for the pieces of a run: poses with proven errors.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/record/run_step.h>

namespace firstcontact::detail {

/// Where a body is at an instant, and how it moves from there on.
struct BodyInstant {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();     ///< [-]  R_WB
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();     ///< [m]  World axes, from an origin.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]  Of the pivot.
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< [rad/s]
  double pivot_error = 0.0;                            ///< [m]
  double turn_error = 0.0;  ///< [-]  Of R: times a point's distance from the pivot.
};

/// The exact motion of a piece from its begin to its end, as its doubles define it.
///
/// The pivot moves on a line, and the body turns about it at a constant rate.
class PieceMotion {
 public:
  /// @param from  [s]  where the piece begins, < piece.to
  /// @param p_BC  [m]  the pivot
  PieceMotion(const RunPiece& piece, double from, const Eigen::Vector3d& p_BC);

  /// Stays at the pose from one time to the other.
  PieceMotion(const Pose& X_WB, double from, double to, const Eigen::Vector3d& p_BC);

  [[nodiscard]] double from() const { return from_; }  ///< [s]
  [[nodiscard]] double to() const { return to_; }      ///< [s]

  /// Where the stored pose puts the body frame; a good origin.
  [[nodiscard]] const Eigen::Vector3d& position() const { return position_; }

  /// [rad]  Over the whole piece, rounded.
  [[nodiscard]] double angle() const { return angle_.midpoint(); }

  /// Contains R_WB and the pivot's position at a time.
  ///
  /// @param time    [s]  from from() to to()
  /// @param origin  [m]  positions are from here
  [[nodiscard]] IntervalTransform enclosure(double time, const Eigen::Vector3d& origin) const;

  [[nodiscard]] BodyInstant instant(double time, const Eigen::Vector3d& origin) const;

 private:
  double from_;
  double to_;
  Eigen::Vector3d position_;
  IntervalMatrix3 R_;            // At the begin.
  IntervalVector3 p_BC_W_;       // At the begin.
  IntervalVector3 translation_;  // [m]
  IntervalVector3 axis_;
  Interval angle_{0.0};  // [rad]
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin_ = Eigen::Vector3d::Zero();
};

/// [m]  How far at most two poses put any point of a body apart.
///
/// @param reach  [m]  no point is farther from the pivot
[[nodiscard]] double deviation_bound(const IntervalTransform& a, const IntervalTransform& b,
                                     double reach);

}  // namespace firstcontact::detail
