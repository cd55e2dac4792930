/// @file
/// Bodies and boxes in the middle of a window of time.

#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/separation/detail/box_tree.h>
#include <firstcontact/separation/detail/closest_on_triangles.h>
#include <firstcontact/separation/detail/covered_motion.h>

namespace firstcontact::detail {

/// [-]  Covers the roundings of a velocity.
inline constexpr double kVelocityError = 0x1p-44;
/// [-]  Covers the roundings of a position, and of a product with a direction: sums of a few terms.
inline constexpr double kPositionRounding = 64.0 * 0x1p-53;

/// The unit vector up to rounding; or zero, along which no gap is wide enough.
inline Eigen::Vector3d unit_or_zero(const Eigen::Vector3d& v) {
  const Eigen::Vector3d n = v.stableNormalized();
  return std::abs(n.squaredNorm() - 1.0) <= kPositionRounding
             ? n
             : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// A bound of a gap in the middle of a window, and its fall within the window [m].
struct GapBound {
  double middle = -std::numeric_limits<double>::infinity();
  double loss = 0.0;

  [[nodiscard]] double least() const { return middle - loss; }
};

/// One body in the middle of a window.
struct WindowBody {
  BodyInstant now;
  double reach = 0.0;  // [m]  Reach of the whole body from its pivot.
  double speed = 0.0;  // [m/s]  Bound of the speed of any point.

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
  /// [m]  Error of a stored point, and of the sums that place it.
  [[nodiscard]] double error() const {
    return now.pivot_error + now.turn_error * reach +
           kPositionRounding * (now.pivot.norm() + reach);
  }
  /// [m/s^2]  Bound of the acceleration along n of a point within `from_pivot`.
  ///
  /// Derivation, with constant rates: the acceleration is -w^2 y', with y' from the axis and across
  /// it. |n . y'| <= |n x w| / w |y'|.
  [[nodiscard]] double bend(const Eigen::Vector3d& n, double from_pivot) const {
    return now.constant_rates
               ? now.spin.norm() * now.spin.cross(n).norm() * (from_pivot + now.lever)
               : now.acceleration + now.turn_acceleration * from_pivot;
  }
  /// [m]  The sum of unknown errors of the velocities of points.
  [[nodiscard]] double drift(double half) const {
    return half * (speed * (kVelocityError + now.turn_error) + now.velocity_error +
                   now.spin_error * reach);
  }
  /// [m]  Bound of the distance of any point from its nominal place.
  [[nodiscard]] double tracking() const { return now.tracking + now.turn_tracking * reach; }
};

/// A box in the middle of a window, in world axes.
struct WindowBox {
  const WindowBody& body;
  const BoxNode& node;
  Eigen::Vector3d lever;     // R centre
  Eigen::Vector3d centre;    // From the origin.
  Eigen::Vector3d velocity;  // Velocity of the centre.

  WindowBox(const WindowBody& moving, const BoxNode& box)
      : body(moving),
        node(box),
        lever(moving.now.R * box.centre),
        centre(moving.now.pivot + lever),
        velocity(moving.velocity(lever)) {}

  /// [m]  Bound of the distance of points from the centre along n.
  [[nodiscard]] double support(const Eigen::Vector3d& n) const {
    return node.extent.dot((body.now.R.transpose() * n).cwiseAbs());
  }
  /// [m/s]  Bound of the excess speed of points along n over the centre: n . (w x y) = (n x w) . y.
  [[nodiscard]] double spread(const Eigen::Vector3d& n) const {
    return support(n.cross(body.now.spin));
  }
};

/// The corners of a triangle in the middle of the window, and their velocities.
struct PlacedTriangle {
  TrianglePoints corners;
  TrianglePoints velocities;
  double reach = 0.0;

  PlacedTriangle(const WindowBody& body, const TrianglePoints& triangle, double from_pivot)
      : reach(from_pivot) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d lever = body.now.R * triangle[k];
      corners[k] = body.now.pivot + lever;
      velocities[k] = body.velocity(lever);
    }
  }

  [[nodiscard]] Eigen::Vector3d edge(std::size_t k) const {
    return corners[(k + 1) % 3] - corners[k];
  }
  [[nodiscard]] Eigen::Vector3d normal() const { return unit_or_zero(edge(0).cross(edge(1))); }
  [[nodiscard]] Eigen::Vector3d middle() const {
    return (corners[0] + corners[1] + corners[2]) / 3.0;
  }
};

}  // namespace firstcontact::detail
