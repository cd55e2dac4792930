/// @file
/// The time-optimal motion along a path with limits of velocity and acceleration, on a grid.

#pragma once

#include <utility>
#include <vector>

#include <firstcontact/retiming/detail/blended_path.h>
#include <firstcontact/retiming/timed_motion.h>

namespace firstcontact::detail {

/// A motion S(t) along a path: constant accelerations from knot to knot.
class PathTiming {
 public:
  struct Knot {
    double t = 0.0;  ///< [s]
    double S = 0.0;
    double rate = 0.0;      ///< [1/s]
    double integral = 0.0;  ///< [s]  Integral of S from 0 to t.
  };

  explicit PathTiming(std::vector<Knot> knots) : knots_(std::move(knots)) {}

  [[nodiscard]] double duration() const { return knots_.back().t; }
  [[nodiscard]] double length() const { return knots_.back().S; }

  /// S and its derivatives after averaging over a window of time.
  struct State {
    double S = 0.0;
    double rate = 0.0;          ///< [1/s]
    double acceleration = 0.0;  ///< [1/s^2]
  };
  /// The mean of S over [t - window, t].
  ///
  /// Its accelerations are continuous, with a jerk of at most twice the acceleration per window.
  /// The motion takes `window` longer, rests at both ends, and stays on the path.
  [[nodiscard]] State averaged(double t, double window) const;

 private:
  [[nodiscard]] Knot at(double t) const;

  std::vector<Knot> knots_;
};

/// Finds the fastest motion along a path from rest to rest.
///
/// Backward it finds the squares of the rates from which the end can be reached. Forward it takes
/// the fastest of them. Limits hold at grid points only: the caller proves the motion that follows.
///
/// Source: H. Pham, Q.-C. Pham, "A new approach to time-optimal path parameterization based on
/// reachability analysis", IEEE Transactions on Robotics 34 (2018).
///
/// @param share  share of the limits, in (0, 1]
[[nodiscard]] PathTiming phase_plane(const BlendedPath& path, const std::vector<RateLimits>& limits,
                                     double share);

}  // namespace firstcontact::detail
