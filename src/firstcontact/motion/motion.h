/// @file
/// In-between motions: the pose of a body at every instant of the step.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/constant_rate_path.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The ways in which a motion runs between two neighbouring poses.
enum class Between {
  constant_velocity,  ///< The body origin moves on a line, the body turns at a constant rate.
  screw,              ///< One rotation about, and one translation along, one axis.
};

/// The words of `Between` in files and in Python, in its order.
inline constexpr std::array<const char*, 2> kBetweenWords{"constant_velocity", "screw"};

/// One piece of a motion of constant rates, from the end of the piece before it.
struct ConstantRatePiece {
  double t_end = 1.0;  ///< [-]  In (0, 1].
  Pose X_WB;           ///< Where the piece begins.
  /// [m]  Displacement of the pivot, world frame.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  /// [rad]  Axis times angle, world frame; any number of turns.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();
};

/// The motion X_WB(t) of a rigid body over the step, t in [0, 1]. Immutable; cheap to share.
///
/// The motion contract: a motion is a sequence of pieces, each of which is smooth and rigid. Piece
/// k runs from breaks()[k] to breaks()[k + 1]. The algorithms know only the path of a piece: the
/// pose and twist at t, and a bound of accelerations. The bound holds for every point and
/// direction, up to the end of the piece. The motion is the exact real-number function that the
/// doubles below define; `path` states how far its arithmetic may deviate from that function.
///
/// All factories throw std::invalid_argument on NaN, infinities, zero quaternions or axes.
class FIRSTCONTACT_API Motion {
 public:
  /// A motion that rests at `pose`.
  static Motion fixed(const Pose& pose = {});

  /// Moves the origin of the body on a line and turns the body at a constant rate.
  ///
  /// T(t) = T(0) + t translation, R(t) = Rot(rotation_vector t) R(0).
  ///
  /// @param start            pose at t = 0
  /// @param translation      [m]    of the body origin over the step, world frame
  /// @param rotation_vector  [rad]  axis times angle over the step, world frame; any number of
  /// turns
  static Motion constant_velocity(const Pose& start, const Eigen::Vector3d& translation,
                                  const Eigen::Vector3d& rotation_vector = Eigen::Vector3d::Zero());

  /// Moves between two poses at constant velocity, by the shortest rotation. For a half turn the
  /// axis is the one whose first non-zero component is positive.
  static Motion constant_velocity(const Pose& from, const Pose& to);

  /// Rotates by angle t about one axis and translates by (translation t) along it, from the start
  /// pose.
  ///
  /// @param axis_point      [m]    a point on the axis, world frame
  /// @param axis_direction  [-]    any length but zero, world frame
  /// @param angle           [rad]  over the step; any number of turns
  /// @param translation     [m]    along the axis over the step
  static Motion screw(const Pose& start, const Eigen::Vector3d& axis_point,
                      const Eigen::Vector3d& axis_direction, double angle, double translation);

  /// Moves between two poses in a screw motion, by the shortest rotation.
  static Motion screw(const Pose& from, const Pose& to);

  /// Runs through `poses` at `times`; rests before the first and after the last.
  ///
  /// @param times  [-]  in [0, 1], strictly increasing, as many as poses; 0 or at least 1e-200
  static Motion waypoints(std::span<const double> times, std::span<const Pose> poses,
                          Between between = Between::constant_velocity);

  /// Runs piece after piece, each with a translation of a pivot Q of the body and a rotation about
  /// Q.
  ///
  /// A simulator makes such motions: Q is the centre of mass. Each piece begins at the rounded pose
  /// at which the piece before it ended.
  ///
  /// @param pieces  at least one; their ends increase, the last one is 1
  /// @param p_BQ    [m]    the pivot Q, a point of the body
  static Motion constant_rates(std::span<const ConstantRatePiece> pieces,
                               const Eigen::Vector3d& p_BQ = Eigen::Vector3d::Zero());

  /// The ends of the n pieces: 0 = breaks[0] < ... < breaks[n] = 1.
  [[nodiscard]] std::span<const double> breaks() const { return breaks_; }

  /// The path of body point C in one piece.
  ///
  /// @param piece  index in [0, breaks().size() - 1)
  /// @param p_BC   [m]  any point of the body, best the centre of its mesh
  [[nodiscard]] ConstantRatePath path(std::size_t piece, const Eigen::Vector3d& p_BC) const;

  /// The pose X_WB(t), rounded to doubles; t is clamped to [0, 1].
  [[nodiscard]] Pose pose(double t) const;

  /// Compares two motions by their defining numbers: negative, zero or positive, a total order.
  ///
  /// By this order queries sort two bodies, and so answer alike for A and B swapped.
  [[nodiscard]] int compare(const Motion& other) const;

 private:
  Motion(std::vector<double> breaks, std::vector<ConstantRateSegment> segments);

  std::vector<double> breaks_;
  std::vector<ConstantRateSegment> segments_;
};

}  // namespace firstcontact
