/// @file
/// The poses that a simulated hand wants to reach, over time.

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
  double time = 0.0;  ///< [s]  Time since the begin of the simulation; finite.
  Pose X_DH = {};
};

/// The pose and the velocity that a hand wants at one time.
struct HandTarget {
  Pose X_DH = {};
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]    Velocity of H's origin, in D.
  /// [rad/s]  Angular velocity of H, in D.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
};

/// A path through via points, with a stop at each.
///
/// Between two via points the hand moves on a line and turns about one axis, with the least jerk.
///
/// Source: T. Flash, N. Hogan, "The coordination of arm movements: an experimentally confirmed
/// mathematical model", Journal of Neuroscience 5 (1985).
class FIRSTCONTACT_API OperatorPath {
 public:
  /// Makes the path through `points`.
  ///
  /// @throws std::invalid_argument  if there is no point, the times do not increase, or a number is
  /// not finite or a quaternion zero
  explicit OperatorPath(std::vector<ViaPoint> points);

  /// The target of the hand at a time. Before the first point and after the last one the hand rests
  /// there.
  ///
  /// @param time  [s]
  /// @param hint  the piece at which the search begins; set to the piece that was found
  [[nodiscard]] HandTarget at(double time, std::size_t& hint) const noexcept;

  /// [s]  Time of the last via point.
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

/// The options of a random path. The path knows no scene: it may lead through walls.
struct RandomPathOptions {
  std::uint64_t seed = 1;
  std::size_t count = 20;      ///< Number of via points; > 0.
  Pose centre = {};            ///< Centre of the ball that contains the points.
  double radius = 0.1;         ///< [m]    Radius of that ball; >= 0.
  double max_angle = 0.5;      ///< [rad]  Turn away from the pose of the centre; in [0, pi].
  double slowest = 0.05;       ///< [m/s]  Least mean speed between two points; > 0.
  double fastest = 1.0;        ///< [m/s]  Greatest mean speed between two points; >= slowest.
  double most_turn_rate = 10;  ///< [rad/s]  Greatest mean rate of turn between two points; > 0.
  double longest_rest = 0.3;   ///< [s]    Longest rest at a point; >= 0.
};

/// Makes random via points. Places are uniform in the ball and axes are uniform. Angles, speeds and
/// rests are uniform between their limits. Equal options give equal points.
///
/// @throws std::invalid_argument  if an option is outside its range
[[nodiscard]] FIRSTCONTACT_API std::vector<ViaPoint> random_via_points(
    const RandomPathOptions& options);

}  // namespace firstcontact
