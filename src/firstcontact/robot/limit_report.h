/// @file
/// A report of the times at which a robot's motion leaves the limits of its joints.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/time_window.h>
#include <firstcontact/robot/robot_motion.h>

namespace firstcontact {

/// The limit of a joint that a motion leaves.
enum class JointLimit { lower_position, upper_position, velocity };

/// The words of JointLimit in files and in Python, in this order.
inline constexpr std::array<const char*, 3> kJointLimitWords{"lower_position", "upper_position",
                                                             "velocity"};

/// One joint beyond one of its limits. Units: rad or m; per second for velocities.
struct LimitViolation {
  std::size_t joint = 0;
  JointLimit what = JointLimit::lower_position;
  double limit = 0.0;     ///< As the model has it.
  double excess = 0.0;    ///< The most by which the motion goes beyond the limit, to the tolerance.
  double t_excess = 0.0;  ///< [-]  The time at which the excess is attained.
  /// The windows of time with the violation, in order, at least one.
  ///
  /// Outside of them the coordinate is proven to exceed the limit by no more than the tolerance. In
  /// each there is a time at which it exceeds the limit.
  std::vector<TimeWindow> intervals;
};

/// Finds all limits that a motion leaves by more than a tolerance, in order of the joints.
///
/// Joints of one coordinate have limits, those that mimic others included. A velocity limit of 0
/// counts as none, as many files have it for an unknown one. Proven for the exact polynomials that
/// the input defines: nothing is sampled.
///
/// @param duration   [s]  of the step; > 0
/// @param tolerance  [rad or m; per s]  > 0
/// @throws std::invalid_argument if a number is outside its range
[[nodiscard]] FIRSTCONTACT_API std::vector<LimitViolation> limit_report(const RobotMotion& motion,
                                                                        double duration,
                                                                        double tolerance = 1e-9);

}  // namespace firstcontact
