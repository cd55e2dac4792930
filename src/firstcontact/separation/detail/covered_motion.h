/// @file
/// A smooth motion of a body over a stretch of time, for the verifier's proof.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// The place of a body at an instant, and bounds of its motion around it.
struct BodyInstant {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();     ///< [-]  R_WB
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();     ///< [m]  World axes, relative to a given
                                                       ///< origin.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]  Velocity of the pivot.
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< [rad/s]
  double pivot_error = 0.0;                            ///< [m]
  double turn_error = 0.0;      ///< [-]  Error of R, per distance of a point from the pivot.
  double velocity_error = 0.0;  ///< [m/s]  In addition to the rounding of the velocity itself.
  double spin_error = 0.0;      ///< [rad/s]  In addition to the rounding of the spin itself.
  /// Whether the pivot moves on a line or a screw and the body turns about one axis, both at
  /// constant rates.
  bool constant_rates = true;
  double lever = 0.0;  ///< [m]  With constant rates: bound of the distance of the pivot from the
                       ///< axis.
  /// [m/s^2, 1/s^2]  Otherwise: bounds of the acceleration of points.
  ///
  /// A point at a distance r from the pivot accelerates by at most acceleration + r
  /// turn_acceleration.
  double acceleration = 0.0;
  double turn_acceleration = 0.0;
  /// [m, -]  A point at a distance r may be off its nominal place by tracking + r turn_tracking.
  double tracking = 0.0;
  double turn_tracking = 0.0;
};

/// The exact motion of a body from one time to another. Its body frame has a pivot.
class CoveredMotion {
 public:
  CoveredMotion(double from, double to) : from_(from), to_(to) {}
  virtual ~CoveredMotion() = default;

  [[nodiscard]] double from() const { return from_; }
  [[nodiscard]] double to() const { return to_; }

  /// [m]  A place near the body, as an origin.
  [[nodiscard]] virtual const Eigen::Vector3d& position() const = 0;

  /// Encloses R_WB and the pivot's position at a time.
  ///
  /// @param time    between from() and to()
  /// @param origin  [m]  origin of positions
  [[nodiscard]] virtual IntervalTransform enclosure(double time,
                                                    const Eigen::Vector3d& origin) const = 0;

  /// The instant in the middle of a window; bounds of accelerations and tracking hold for all of
  /// it.
  ///
  /// @param half    half the length of the window, which lies within the motion
  /// @param origin  [m]
  [[nodiscard]] virtual BodyInstant around(double time, double half,
                                           const Eigen::Vector3d& origin) const = 0;

 protected:
  CoveredMotion(const CoveredMotion&) = default;
  CoveredMotion(CoveredMotion&&) = default;
  CoveredMotion& operator=(const CoveredMotion&) = default;
  CoveredMotion& operator=(CoveredMotion&&) = default;

 private:
  double from_;
  double to_;
};

/// The instant of an enclosure, its pivot and rotation only.
[[nodiscard]] BodyInstant instant_of(const IntervalTransform& X);

/// The middle of each component; a bound of their errors as a length is added to `error`.
[[nodiscard]] Eigen::Vector3d middle(const IntervalVector3& v, double& error);

/// The rotation of q / |q|.
[[nodiscard]] IntervalMatrix3 exact_rotation(const Eigen::Quaterniond& quaternion);

/// The exact transform of a pose.
[[nodiscard]] IntervalTransform exact_transform(const Pose& pose);

/// The direction v / |v| of a vector that is not zero.
[[nodiscard]] IntervalVector3 exact_direction(const Eigen::Vector3d& v);

/// The rotation about a unit axis, applied to each column.
[[nodiscard]] IntervalMatrix3 rotated(const IntervalVector3& axis, const Interval& angle,
                                      const IntervalMatrix3& R);

}  // namespace firstcontact::detail
