/// @file
/// Two bodies at rest, as a query sees them.

#pragma once

#include <Eigen/Core>

#include <firstcontact/motion/constant_rate_path.h>
#include <firstcontact/motion/pair_motion.h>

namespace firstcontact::detail {

/// The motion of two bodies at rest, at less cost than ConstantRatePair and equal to the last bit.
///
/// Refers to the paths.
class RestingPair final : public PairMotion {
 public:
  /// @param A,B  paths that neither turn nor move
  RestingPair(const ConstantRatePath& A, const ConstantRatePath& B) : A_(A), B_(B) {}

  double enter(double /*t*/) override { return 1.0; }

  [[nodiscard]] RelativeState state(double t) const override {
    RelativeState state;
    state.t = t;
    state.R_WA = A_.state(t).R_WB;
    state.R_WB = B_.state(t).R_WB;
    state.p_AB = without_sign((B_.pivot_begin() - A_.pivot_begin()).value());
    state.p_AQb = state.p_AB;
    state.position_error = A_.position_error() + B_.position_error();
    state.rotation_error_A = A_.rotation_error();
    state.rotation_error_B = B_.rotation_error();
    return state;
  }

  [[nodiscard]] double speed_bound(double /*radius_A*/, double /*radius_B*/) const override {
    return 0.0;
  }

  [[nodiscard]] Eigen::Vector3d origin(double /*t*/) const override {
    return without_sign(A_.pivot_begin().value());
  }

 private:
  /// Turns -0 into 0, as adding the displacement since the begin does.
  static Eigen::Vector3d without_sign(const Eigen::Vector3d& v) {
    return v + Eigen::Vector3d::Zero();
  }

  const ConstantRatePath& A_;
  const ConstantRatePath& B_;
};

}  // namespace firstcontact::detail
