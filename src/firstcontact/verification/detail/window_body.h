/// @file
/// Bodies and boxes in the middle of a window of time.

#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/verification/detail/box_tree.h>
#include <firstcontact/verification/detail/covered_motion.h>

namespace firstcontact::detail {

/// Covers the roundings of a velocity.
inline constexpr double kVelocityError = 0x1p-44;
/// Covers the roundings of a position, and of a product with a direction: sums of a few terms.
inline constexpr double kPositionRounding = 64.0 * 0x1p-53;

/// A unit vector but for rounding, or zero, along which no gap is wide enough.
inline Eigen::Vector3d unit_or_zero(const Eigen::Vector3d& v) {
  const Eigen::Vector3d n = v.stableNormalized();
  return std::abs(n.squaredNorm() - 1.0) <= kPositionRounding
             ? n
             : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// How far a bound falls within a window, and what it is in its middle. [m]
struct GapBound {
  double middle = -std::numeric_limits<double>::infinity();
  double loss = 0.0;

  [[nodiscard]] double least() const { return middle - loss; }
};

/// One body in the middle of a window.
struct WindowBody {
  BodyInstant now;
  double reach = 0.0;  // [m]  Of the whole body from its pivot.
  double speed = 0.0;  // [m/s]  No point is faster.

  WindowBody(const BodyInstant& instant, double whole_reach)
      : now(instant),
        reach(whole_reach),
        speed(now.velocity.norm() + now.spin.norm() * whole_reach) {}

  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& y) const {
    return now.pivot + now.R * y;
  }
  /// The velocity of a point at Y = R y.
  [[nodiscard]] Eigen::Vector3d velocity(const Eigen::Vector3d& Y) const {
    return now.velocity + now.spin.cross(Y);
  }
  /// [m]  Of a stored point, and of the sums that place it.
  [[nodiscard]] double error() const {
    return now.pivot_error + now.turn_error * reach +
           kPositionRounding * (now.pivot.norm() + reach);
  }
  /// [m/s^2]  No point within `from_pivot` accelerates along n faster. Derivation, with constant
  /// rates: the acceleration is -w^2 y', y' from the axis and across it, and
  /// |n . y'| <= |n x w| / w |y'|.
  [[nodiscard]] double bend(const Eigen::Vector3d& n, double from_pivot) const {
    return now.constant_rates
               ? now.spin.norm() * now.spin.cross(n).norm() * (from_pivot + now.lever)
               : now.acceleration + now.turn_acceleration * from_pivot;
  }
  /// [m]  What unknown errors of the velocities of points add up to.
  [[nodiscard]] double drift(double half) const {
    return half * (speed * (kVelocityError + now.turn_error) + now.velocity_error +
                   now.spin_error * reach);
  }
  /// [m]  Any point may be so far off its nominal place.
  [[nodiscard]] double tracking() const { return now.tracking + now.turn_tracking * reach; }
};

/// A box in the middle of a window, as the world sees it.
struct WindowBox {
  const WindowBody& body;
  const BoxNode& node;
  Eigen::Vector3d lever;     // R centre
  Eigen::Vector3d centre;    // From the origin.
  Eigen::Vector3d velocity;  // Of the centre.

  WindowBox(const WindowBody& moving, const BoxNode& box)
      : body(moving),
        node(box),
        lever(moving.now.R * box.centre),
        centre(moving.now.pivot + lever),
        velocity(moving.velocity(lever)) {}

  /// [m]  No point is farther from the centre along n.
  [[nodiscard]] double support(const Eigen::Vector3d& n) const {
    return node.extent.dot((body.now.R.transpose() * n).cwiseAbs());
  }
  /// [m/s]  No point moves along n faster than the centre by more: n . (w x y) = (n x w) . y.
  [[nodiscard]] double spread(const Eigen::Vector3d& n) const {
    return support(n.cross(body.now.spin));
  }
};

}  // namespace firstcontact::detail
