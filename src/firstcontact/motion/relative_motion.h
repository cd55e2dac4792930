/// @file
/// The relative motion of two bodies of constant rates, relative to the centre of the first.

#pragma once

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/constant_rate_path.h>
#include <firstcontact/motion/relative_state.h>

namespace firstcontact {

/// Two paths that share a piece of time.
///
/// Differences of far-away positions are taken in double-double, so that large offsets common to
/// both bodies cost no precision.
class FIRSTCONTACT_API RelativeMotion {
 public:
  /// Prepares the motion of B relative to A over the piece that their paths share.
  ///
  /// @param resolution  [m]  levers are evaluated in double-double where doubles would not reach it
  RelativeMotion(const ConstantRatePath& A, const ConstantRatePath& B, double resolution);

  [[nodiscard]] RelativeState state(double t) const;

  [[nodiscard]] const ConstantRatePath& A() const { return A_; }
  [[nodiscard]] const ConstantRatePath& B() const { return B_; }

  /// [m per step]  The velocity of B's pivot relative to A's, rounded.
  [[nodiscard]] const Eigen::Vector3d& pivot_velocity() const { return velocity_; }

  /// [m]  Bound of the error of p_AB, beyond one rounding of its size.
  [[nodiscard]] double position_error() const { return position_error_; }

 private:
  ConstantRatePath A_;
  ConstantRatePath B_;
  double t_begin_;
  DoubleDoubleVector3 p_QaQb_;
  DoubleDoubleVector3 relative_velocity_;
  Eigen::Vector3d velocity_;
  bool precise_;
  double position_error_;
};

}  // namespace firstcontact
