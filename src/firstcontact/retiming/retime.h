/// @file
/// Retiming: from a path of robots to a trajectory that is proven as its controller executes it.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/rate_report.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/retiming/waypoint_path.h>

namespace firstcontact {

/// The way in which a path is timed.
enum class RetimingMode {
  stop,          ///< Rests at every waypoint; the geometry is that of the path.
  blend,         ///< Passes waypoints on blends, shrunk until they are proven free.
  time_optimal,  ///< As `blend`, nearly time-optimal along its geometry.
};

/// The words of RetimingMode on the command line, in this order.
inline constexpr std::array<const char*, 3> kRetimingModeWords{"stop", "blend", "time_optimal"};

/// The options of retiming.
struct RetimingOptions {
  RetimingMode mode = RetimingMode::stop;
  /// [rad or m]  Greatest distance of the motion from the path in each joint, in `blend` and
  /// `time_optimal`; > 0.
  ///
  /// Waypoints that are left out use at most half of it, and blends the rest. Without a deviation
  /// blends are as long as they gain time. Quintics of `time_optimal` may exceed it: there is no
  /// proven bound, and tests allow 2 % above 1 mm and 10 % below.
  std::optional<double> blend_deviation = {};
  ProofOptions proof = {};
};

/// [rad or m]  Waypoints that an edge passes this closely, in every joint, may be left out.
inline constexpr double kLeftOutWithin = 1e-3;
/// [-]  The same, by the greatest way of any joint of the path: a short path keeps its form.
inline constexpr double kLeftOutShare = 0.01;

/// A timed motion and its proof.
struct RetimedMotion {
  RetimingMode mode = RetimingMode::stop;  ///< Mode of the motion: `stop` where that is as fast.
  TimedMotion motion = {};
  ExecutedProof proof = {};    ///< Proof of `motion`; where it is not proven, it has the obstacle.
  double stop_duration = 0.0;  ///< [s]  Duration with rest at every waypoint.
  std::size_t blends = 0;      ///< Number of waypoints that are passed.
  std::size_t left_out = 0;    ///< Number of waypoints that edges pass closely.
  std::size_t shortened = 0;   ///< Number of times that a blend was shortened because it was not
                               ///< free.
};

/// Times a path as fast as its mode allows, and proves what a controller makes of it.
///
/// The straight edges of the path are proven first: where one is in contact, no mode has a motion.
/// Where the rounding of numbers exceeds a limit, a little less of all limits is used. Where a
/// blend is in contact or undecided, it is made shorter. Where one breaks a limit, the robot rests
/// at its waypoint. It rests, too, where the way turns back by more than 170 degrees. The result is
/// never slower than with rest at every waypoint. It is proven, or `proof` has the pair and the
/// time of the obstacle.
///
/// With `blend` and `time_optimal` a waypoint is left out where an edge passes it closely: within
/// `kLeftOutWithin`, `kLeftOutShare` of the path's extent, and half of the `blend_deviation`. So a
/// duration depends little on how finely a path is divided. Edges in place of others are proven
/// free; where one is not, its waypoints come back.
///
/// @param limits  one for each joint name of the path
/// @throws std::invalid_argument  names the joint, the waypoint, or what else in the scene moves
[[nodiscard]] FIRSTCONTACT_API RetimedMotion retime(const WaypointPath& path,
                                                    const std::vector<RateLimits>& limits,
                                                    const RetimingScene& where,
                                                    const RetimingOptions& options = {});

}  // namespace firstcontact
