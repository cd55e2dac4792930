/// @file
/// The least distance of two geometries in a piece of time: finds a lesser one, or proves that
/// there is none.

#pragma once

#include <firstcontact/motion/time_window.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/geometry_search.h>

namespace firstcontact::detail {

/// [-]  Part of the tolerance; the rest covers the rounding of differences.
inline constexpr double kShareOfTolerance = 0.999;

/// Lowers a distance that is known already, of these geometries or of others.
class LeastDescent {
 public:
  /// @param best  with distance, t, closest and reason
  LeastDescent(const RobotCheckOptions& options, ClosestApproach& best)
      : options_(options), tolerance_(kShareOfTolerance * options.tolerance), best_(best) {}

  /// [m]  The distance at a time of the piece.
  double look(GeometrySearch& search, double t);

  /// Whether the distance at t is less than the best one; if so, it becomes the best one.
  bool improve(GeometrySearch& search, double t);

  /// Descends from a time of the window, along the distance of the two triangles that are closest
  /// there.
  ///
  /// That distance costs little. The descent goes on as long as it gains.
  void descend(GeometrySearch& search, const TimeWindow& window, double t);

  /// Proves that the two are farther apart than the best distance less the tolerance.
  ///
  /// Or it finds a lesser distance for which that holds.
  void run(GeometrySearch& search, const TimeWindow& window);

 private:
  void sample(GeometrySearch& search, const TimeWindow& window);

  const RobotCheckOptions& options_;
  double tolerance_;
  ClosestApproach& best_;
};

}  // namespace firstcontact::detail
