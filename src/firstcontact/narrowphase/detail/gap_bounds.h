/// @file
/// Errors and accelerations of the gap between moving features, along any direction.

#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/root_isolation.h>
#include <firstcontact/narrowphase/elementary_contact.h>

namespace firstcontact::detail {

/// Factor above 1 that outweighs the roundings of the few operations in a bound.
inline constexpr double kUp = 1.0 + 0x1p-40;

/// The bounds that hold throughout the piece for all points of two features.
class GapBounds {
 public:
  /// @param reach_A, reach_B    [m]  of the features' points from the paths' points
  /// @param circle_A, circle_B  [m]  from the axes
  GapBounds(const ElementaryMotion& motion, double reach_A, double reach_B, double circle_A,
            double circle_B) {
    const double w_A = motion.A.rate;
    const double w_B = motion.B.rate;
    const double from_A = motion.A.lever_length + reach_A;
    const double from_B = motion.B.lever_length + reach_B;
    size = (from_A + from_B + motion.offset_bound) * kUp;
    position_error = motion.rounding * size + motion.position_error +
                     motion.A.rotation_error * from_A + motion.B.rotation_error * from_B;
    slip =
        motion.rounding * (motion.drift_length + (w_A + w_B) * size) + (w_A + w_B) * position_error;
    unsteadiness = slip * (w_A + w_B);
    acceleration_A_ = w_A * w_A * circle_A;
    acceleration_B_ = w_B * w_B * circle_B;
  }

  /// The bound for the gap times |d| along a direction d that stands still in the world.
  ///
  /// Derivation: a point at rho from its axis u has the acceleration -w^2 rho, and
  /// |d . rho| <= |d x u| |rho|.
  ///
  /// @param axis_B  as seen from A now
  [[nodiscard]] CurvatureBound along(const Eigen::Vector3d& d,
                                     const Eigen::Vector3d& axis_B) const {
    const double across2 = d.x() * d.x() + d.y() * d.y();
    const double length = std::sqrt(across2 + d.z() * d.z()) * kUp;
    return {position_error * length, slip * length,
            (acceleration_A_ * std::sqrt(across2) + acceleration_B_ * d.cross(axis_B).norm() +
             unsteadiness * length) *
                kUp};
  }

  double size;            ///< [m]  Roundings are relative to it.
  double position_error;  ///< [m]
  double slip;            ///< [m per step]  Error of a velocity.
  double unsteadiness;    ///< [m per step^2]  Addition of errors of positions to an acceleration.

 private:
  double acceleration_A_;
  double acceleration_B_;
};

/// The reciprocal 1 / x, and 0 where x = 0.
inline double inverse(double x) { return x > 0.0 ? 1.0 / x : 0.0; }

/// The greatest length of the vectors.
template <class... Vectors>
double longest(const Vectors&... v) {
  return std::sqrt(std::max({v.squaredNorm()...}));
}

}  // namespace firstcontact::detail
