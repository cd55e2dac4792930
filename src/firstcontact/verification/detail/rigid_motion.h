/// @file
/// The verifier's own arithmetic for the in-between motions of bodies.

#pragma once

#include <optional>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/interval_vector.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/separation/detail/covered_motion.h>

namespace firstcontact::detail {

/// The error that arithmetic cannot decide between two motions, as for nearly half a turn.
class UncertainMotion : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A turn about a unit axis.
struct Turn {
  IntervalVector3 axis;
  Interval angle{0.0};  ///< [rad]
  double off = 0.0;     ///< [rad]  Bound of a turn that is too small for an axis, and is left out.
};

/// The motion of the body's origin, besides the turn of the body.
struct OriginWay {
  /// [m]  A line; along the axis where there is a centre; the chord of an arc.
  IntervalVector3 translation;
  /// [m]  From the origin at the begin to a point of the axis about which the origin turns, too.
  std::optional<IntervalVector3> to_axis = {};
  /// [m]  For an arc about an axis that may be far away: the part of the chord across the axis.
  ///
  /// The turn is then not zero.
  std::optional<IntervalVector3> across = {};
};

/// A motion at constant rates: the origin moves on a line, a screw or an arc.
class RigidMotion : public CoveredMotion {
 public:
  /// @param p_BC  [m]  the pivot
  RigidMotion(double from, double to, const Pose& X_WB, const OriginWay& way, const Turn& turn,
              const Eigen::Vector3d& p_BC);

  [[nodiscard]] const Eigen::Vector3d& position() const override { return position_; }
  [[nodiscard]] IntervalTransform enclosure(double time,
                                            const Eigen::Vector3d& origin) const override;
  [[nodiscard]] BodyInstant around(double time, double half,
                                   const Eigen::Vector3d& origin) const override;

  /// Sets how far any point of the body may be off its nominal place [m].
  void set_tracking(double tracking) { tracking_ = tracking; }

  /// Whether the motion is a rest.
  [[nodiscard]] bool rests() const;

  /// The rates that a chain of joints needs of its base.
  struct Rates {
    IntervalVector3 velocity;  ///< Velocity of the pivot.
    IntervalVector3 spin;
    double lever = 0.0;  ///< [m]  Bound of the distance of the pivot from the axis.
  };
  [[nodiscard]] Rates rates(double time) const;

 private:
  [[nodiscard]] Interval part(double time) const;
  [[nodiscard]] IntervalVector3 turned(const IntervalVector3& v, const Interval& angle) const;
  [[nodiscard]] IntervalVector3 change(const IntervalVector3& v, const Interval& angle) const;

  Eigen::Vector3d position_;
  IntervalMatrix3 R_;       // Rotation at the begin.
  IntervalVector3 p_BC_W_;  // Pivot at the begin.
  OriginWay way_;
  Turn turn_;
  Interval half_sine_{0.0};   // Only for an arc.
  IntervalVector3 spin_;      // Per unit of time.
  Interval per_length_{1.0};  // 1 / (to - from)
  double lever_ = 0.0;
  double tracking_ = 0.0;
};

/// The turn of a rotation vector [rad].
[[nodiscard]] Turn turn_of(const Eigen::Vector3d& rotation_vector);

/// The shortest turn from one orientation to another.
///
/// Half a turn is that about the axis whose first component that is not zero is positive.
///
/// @throws UncertainMotion
[[nodiscard]] Turn least_turn(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to);

/// The motion from one pose to another.
///
/// @throws UncertainMotion
[[nodiscard]] RigidMotion motion_between(double from, double to, const Pose& X_from,
                                         const Pose& X_to, Between between,
                                         const Eigen::Vector3d& p_BC);

/// The motion of a body over a scene, t = time / duration from 0 to 1, piece by piece.
///
/// @param motion    any but VertexMotion
/// @param duration  [s]
/// @param p_BC      [m]
/// @throws UncertainMotion
[[nodiscard]] std::vector<RigidMotion> rigid_motions(const BodyMotion& motion, double duration,
                                                     const Eigen::Vector3d& p_BC);

}  // namespace firstcontact::detail
