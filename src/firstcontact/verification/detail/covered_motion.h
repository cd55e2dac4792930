/// @file
/// A smooth motion of a body over a stretch of time, as the verifier's proof sees it.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// Where a body is at an instant, and how it moves around it.
struct BodyInstant {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();     ///< [-]  R_WB
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();     ///< [m]  World axes, from an origin.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]  Of the pivot.
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      ///< [rad/s]
  double pivot_error = 0.0;                            ///< [m]
  double turn_error = 0.0;      ///< [-]  Of R: times a point's distance from the pivot.
  double velocity_error = 0.0;  ///< [m/s]  Beyond the rounding of the velocity itself.
  double spin_error = 0.0;      ///< [rad/s]  So too.
  /// Whether the pivot moves on a line or a screw and the body turns about one axis, both at
  /// constant rates.
  bool constant_rates = true;
  double lever = 0.0;  ///< [m]  With constant rates: the pivot is no farther from the axis.
  /// [m/s^2, 1/s^2]  Else: no point at a distance r from the pivot accelerates by more than
  /// acceleration + r turn_acceleration.
  double acceleration = 0.0;
  double turn_acceleration = 0.0;
  /// [m, -]  Any point at a distance r may be off its nominal place by tracking + r turn_tracking.
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

  /// [m]  A place near the body; a good origin.
  [[nodiscard]] virtual const Eigen::Vector3d& position() const = 0;

  /// Contains R_WB and the pivot's position at a time.
  ///
  /// @param time    from from() to to()
  /// @param origin  [m]  positions are from here
  [[nodiscard]] virtual IntervalTransform enclosure(double time,
                                                    const Eigen::Vector3d& origin) const = 0;

  /// The instant in the middle of a window. What it states of accelerations and tracking holds
  /// for the whole window.
  ///
  /// @param half    the window ends so much before and after `time`, and within the motion
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

/// The middle of each component; what they may be off is added to `error`, as a length.
[[nodiscard]] Eigen::Vector3d middle(const IntervalVector3& v, double& error);

/// The rotation of q / |q|.
[[nodiscard]] IntervalMatrix3 exact_rotation(const Eigen::Quaterniond& quaternion);

/// The exact pose.
[[nodiscard]] IntervalTransform exact_transform(const Pose& pose);

/// v / |v| of a vector that is not zero.
[[nodiscard]] IntervalVector3 exact_direction(const Eigen::Vector3d& v);

/// The rotation about a unit axis, applied to each column.
[[nodiscard]] IntervalMatrix3 rotated(const IntervalVector3& axis, const Interval& angle,
                                      const IntervalMatrix3& R);

}  // namespace firstcontact::detail
