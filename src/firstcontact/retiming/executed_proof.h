/// @file
/// The proof of what a controller makes of a trajectory: its limits, and that it touches nothing.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/retiming/rate_report.h>
#include <firstcontact/retiming/retiming_scene.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/scene/loaded_scene.h>

namespace firstcontact {

/// Refuses a scene in which something else moves, as the time of the motion would then matter.
///
/// @throws std::invalid_argument  names the moving body or robot
FIRSTCONTACT_API void require_resting_surroundings(const RetimingScene& where);

/// A pair that was held to a distance of its own for a while, in place of its margin.
struct ProvenHold {
  BodyPair members = {};
  double distance = 0.0;  ///< [m]
  double from = 0.0;      ///< [s]
  double to = 0.0;        ///< [s]
};

/// The proof of a motion as its controller executes it.
struct ExecutedProof {
  /// First contact over the motion; t = 1 is its last point.
  ///
  /// Margins contain the tracking errors, and `kRoundingAllowance` for each joint.
  SceneResult contact = {};
  /// The robots with positions beyond the limits of the URDF by more than 1e-9, or velocities of
  /// joints that mimic others.
  ///
  /// Joints that rest, and that the motion does not name, are left out.
  std::vector<SceneLimits> positions = {};
  std::vector<RateUse> rates = {};    ///< As rate_report().
  std::vector<ProvenHold> held = {};  ///< In the order of the scene's holds.
  double duration = 0.0;              ///< [s]

  /// Whether all of it holds: the motion is free and within its limits.
  [[nodiscard]] bool is_proven() const {
    return contact.verdict == Verdict::free && holds_limits();
  }
  /// Whether all positions and rates are within their limits.
  [[nodiscard]] bool holds_limits() const {
    return positions.empty() && !rate_beyond_limit(rates).has_value();
  }
  /// [s]  Time of the first contact, or from which on nothing is decided.
  [[nodiscard]] double contact_time() const { return contact.t * duration; }
};

/// [rad or m]  The addition to the tracking error of every joint.
///
/// It covers the arithmetic of a controller, and the rounding where times are scaled to the step.
inline constexpr double kRoundingAllowance = 1e-9;

/// The options of a proof of a motion.
struct ProofOptions {
  double tolerance = 1e-6;  ///< [m]  As RobotCheckOptions.
  bool closest = false;     ///< Also the closest approach.
  int threads = 0;          ///< At most; 0 for one on each core.
  WorkBudget budget = {};
};

/// Proves a motion: the controller's interpolation between its points.
///
/// Several robots move at once; pairs of links of two robots are tested, too.
///
/// Pairs of the scene's holds are held for their times. They are checked with a tolerance that is
/// small beside their distances. Tracking errors count for them, too.
///
/// @param limits  one for each joint name of the motion
/// @throws std::invalid_argument  names the joint that no robot has, or what else moves; or the
///         motion does not rest where a pair has to be open
[[nodiscard]] FIRSTCONTACT_API ExecutedProof prove_motion(const TimedMotion& motion,
                                                          const std::vector<RateLimits>& limits,
                                                          const RetimingScene& where,
                                                          const ProofOptions& options = {});

/// Reads a trajectory as a controller takes it: from the text alone.
///
/// Times that are equal or go backward are refused, also where the two points are the same. So are
/// times that are no whole nanoseconds, and a trajectory that begins later than at 0.
///
/// @param source  names the text in errors; its extension gives the format
/// @param robot   as joined_model() where several robots move
/// @throws ParseError
[[nodiscard]] FIRSTCONTACT_API TimedMotion parse_timed_motion(std::string_view text,
                                                              const std::filesystem::path& source,
                                                              const RobotModel& robot);

}  // namespace firstcontact
