/// @file
/// Bounds of the motion of the last link of a chain of joints.

#pragma once

#include <algorithm>
#include <cmath>

#include <firstcontact/robot/joint_path.h>

namespace firstcontact::detail {

/// Bounds of the sizes of the derivatives of a link's points, joint by joint from the tip to F.
///
/// LinkPath::window() has the derivation.
class ChainBounds {
 public:
  /// @param beyond  [m]  distance of any point of the link from the origin at the tip
  /// @param reach   [m]  distance of any point of the link from its centre
  /// @param T       [-]  time from the instant of known places to any other of the window
  ChainBounds(double beyond, double reach, double T) : beyond_(beyond), reach_(reach), T_(T) {}

  /// Passes a joint that rests, or a fixed transform between joints, of that length [m].
  void pass_rest(double length) { beyond_ += length; }

  /// Passes a joint that moves.
  ///
  /// @param from_axis  [m]  distance of the link's centre from the axis at the known time; with its
  ///                   error
  /// @param step       [m]  distance from the parent's origin to the pivot
  /// @param lever      [m]  distance from the pivot to the child's origin
  void pass(const JointBounds& bounds, double from_axis, double step, double lever) {
    const auto& [w1, w2, w3] = bounds.angle;
    beyond_ += lever;
    const double by_axis = from_axis + reach_ + v_ * T_;
    const double rho = std::min(by_axis, beyond_) * kUp;
    const double more_rho = by_axis < beyond_ ? 1.0 + more_.rate * T_ : 1.0;
    const double turning = length_of(w2, w1 * w1);
    const double twisting = length_of(w3 + w1 * w1 * w1, 3.0 * w1 * w2);
    more_.jerk += 3.0 * w1 * more_.acceleration + 3.0 * turning * more_.rate + twisting * more_rho;
    more_.acceleration += 2.0 * w1 * more_.rate + turning * more_rho;
    more_.rate += w1 * more_rho;
    j_ = bounds.pivot.jerk + j_ + 3.0 * w1 * a_ + 3.0 * turning * v_ + twisting * rho;
    a_ = bounds.pivot.acceleration + a_ + 2.0 * w1 * v_ + turning * rho;
    v_ = bounds.pivot.rate + v_ + w1 * rho;
    beyond_ += step + bounds.pivot.rate * T_;
  }

  [[nodiscard]] CoordinateSegment::Bounds bounds() const { return {v_ * kUp, a_ * kUp, j_ * kUp}; }

  /// [per metre]  The greatest growth of the bounds for each metre by which the link reaches
  /// farther.
  ///
  /// rho is a concave function of the reach, and so are all the bounds.
  [[nodiscard]] CoordinateSegment::Bounds per_metre() const {
    return {more_.rate * kUp, more_.acceleration * kUp, more_.jerk * kUp};
  }

 private:
  /// Factor above 1 that covers sums and products of the bounds of some hundred joints.
  static constexpr double kUp = 1.0 + 0x1p-40;

  /// The length of (x, y), rounded up; std::hypot takes several times as long.
  static double length_of(double x, double y) {
    constexpr double kUnderflow = 1e-290;
    const double square = x * x + y * y;
    return square > kUnderflow ? std::sqrt(square) * kUp : std::abs(x) + std::abs(y);
  }

  double beyond_;
  double reach_;
  double T_;
  double v_ = 0.0;
  double a_ = 0.0;
  double j_ = 0.0;
  CoordinateSegment::Bounds more_;  // Derivatives of the bounds by the reach.
};

}  // namespace firstcontact::detail
