/// @file
/// The distance of the members of a robot scene at chosen times, as sampling finds it.

#pragma once

#include <limits>
#include <span>
#include <stop_token>
#include <vector>

#include <firstcontact/math/export.h>

namespace firstcontact {

class RobotScene;

/// The least distance of all pairs that are tested at one time.
///
/// It is without padding, margins and tracking errors.
struct RobotGap {
  double distance = std::numeric_limits<double>::infinity();     ///< [m]  Infinite without a pair.
  double lower_bound = std::numeric_limits<double>::infinity();  ///< [m]  Proven at that time.
  bool contact = false;  ///< Whether a pair is no farther apart than its threshold.
};

/// Samples the gap at each of the times. Proves nothing about the times between them.
///
/// @param times  [-]  each in [0, 1]
/// @param stop   ends the sampling early, with fewer gaps
/// @throws std::invalid_argument if a time is outside its range
[[nodiscard]] FIRSTCONTACT_API std::vector<RobotGap> robot_gaps(const RobotScene& scene,
                                                                std::span<const double> times,
                                                                const std::stop_token& stop = {});

}  // namespace firstcontact
