/// @file
/// The verifier's own arithmetic for the pieces of a run: poses with proven errors.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/separation/detail/covered_motion.h>

namespace firstcontact::detail {

/// The exact motion of a piece from its begin to its end [s], as its doubles define it.
///
/// The pivot moves on a line, and the body turns about it at a constant rate.
class PieceMotion : public CoveredMotion {
 public:
  /// @param from  [s]  begin of the piece, < piece.to
  /// @param p_BC  [m]  the pivot
  PieceMotion(const RunPiece& piece, double from, const Eigen::Vector3d& p_BC);

  /// Makes a motion that stays at the pose from one time to the other.
  PieceMotion(const Pose& X_WB, double from, double to, const Eigen::Vector3d& p_BC);

  /// The place of the body frame by the stored pose, as an origin.
  [[nodiscard]] const Eigen::Vector3d& position() const override { return position_; }

  /// [rad]  The turn over the whole piece, rounded.
  [[nodiscard]] double angle() const { return angle_.midpoint(); }

  [[nodiscard]] IntervalTransform enclosure(double time,
                                            const Eigen::Vector3d& origin) const override;

  [[nodiscard]] BodyInstant around(double time, double half,
                                   const Eigen::Vector3d& origin) const override;

  [[nodiscard]] BodyInstant instant(double time, const Eigen::Vector3d& origin) const {
    return around(time, 0.0, origin);
  }

 private:
  Eigen::Vector3d position_;
  IntervalMatrix3 R_;            // Rotation at the begin.
  IntervalVector3 p_BC_W_;       // Pivot at the begin.
  IntervalVector3 translation_;  // [m]
  IntervalVector3 axis_;
  Interval angle_{0.0};  // [rad]
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin_ = Eigen::Vector3d::Zero();
};

/// [m]  A bound of the distance of any point of a body at two poses.
///
/// @param reach  [m]  bound of the distance of points from the pivot
[[nodiscard]] double deviation_bound(const IntervalTransform& a, const IntervalTransform& b,
                                     double reach);

}  // namespace firstcontact::detail
