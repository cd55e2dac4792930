/// @file
/// Where a simulated hand wants to be, over time.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A pose that the hand wants to reach at a time.
struct ViaPoint {
  double time = 0.0;  ///< [s]  From the begin of the simulation; finite.
  Pose X_DH = {};
};

/// The wish of a hand at one time.
struct HandTarget {
  Pose X_DH = {};
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< [m/s]    Of H's origin, in D.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]  In D.
};

/// A path through via points, with a stop at each.
///
/// Between two of them the hand moves on a line and turns about one axis, with the least jerk.
///
/// Source: T. Flash, N. Hogan, "The coordination of arm movements: an experimentally confirmed
/// mathematical model", Journal of Neuroscience 5 (1985).
class FIRSTCONTACT_API OperatorPath {
 public:
  /// @throws std::invalid_argument  if there is no point, the times do not increase, or a number is
  /// not finite or a quaternion zero
  explicit OperatorPath(std::vector<ViaPoint> points);

  /// The wish at a time. Before the first point and behind the last one the hand rests there.
  ///
  /// @param time  [s]
  /// @param hint  where the search for the piece begins; keeps the piece that was found
  [[nodiscard]] HandTarget at(double time, std::size_t& hint) const noexcept;

  /// [s]  Of the last point.
  [[nodiscard]] double end_time() const noexcept;

 private:
  struct Piece {
    double begin = 0.0;     // [s]
    double duration = 0.0;  // [s]
    Pose from;
    Eigen::Vector3d translation;      // [m]
    Eigen::Vector3d rotation_vector;  // [rad]
  };

  std::vector<Piece> pieces_;
  Pose first_;
  Pose last_;
  double end_time_ = 0.0;
};

/// A path without knowledge of any scene: it may lead through walls.
struct RandomPathOptions {
  std::uint64_t seed = 1;
  std::size_t count = 20;      ///< Via points; > 0.
  Pose centre = {};            ///< Of the ball in which the points are.
  double radius = 0.1;         ///< [m]    Of that ball; >= 0.
  double max_angle = 0.5;      ///< [rad]  Turn away from the pose of the centre; in [0, pi].
  double slowest = 0.05;       ///< [m/s]  Mean speeds between two points; > 0.
  double fastest = 1.0;        ///< [m/s]  >= slowest.
  double most_turn_rate = 10;  ///< [rad/s]  Mean rate of turn, at most; > 0.
  double longest_rest = 0.3;   ///< [s]    Rests at points are up to this; >= 0.
};

/// Makes random via points: places uniform in the ball, axes uniform, angles, speeds and rests
/// uniform between their limits. The same for the same options.
///
/// @throws std::invalid_argument  if an option is outside its range
[[nodiscard]] FIRSTCONTACT_API std::vector<ViaPoint> random_via_points(
    const RandomPathOptions& options);

}  // namespace firstcontact
