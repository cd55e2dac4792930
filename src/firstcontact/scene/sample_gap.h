/// @file
/// The gap of a scene at chosen times: what sampling sees, and what it can miss.

#pragma once

#include <cstddef>
#include <span>
#include <stop_token>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/query/workspace.h>

namespace firstcontact {

struct LoadedScene;

/// The least distance of all pairs at one time.
struct GapSample {
  double t = 0.0;            ///< [-]  Normalised to the scene's duration.
  double distance = 0.0;     ///< [m]  0 where two surfaces meet; infinite where no pair is tested.
  double lower_bound = 0.0;  ///< [m]  Proven at t; `distance` less its rounding error.
  bool contact = false;      ///< A pair is no farther apart than its margin.
};

/// Samples the gap at each of the times. Proves nothing about the times between them.
///
/// @param times  [-]  each in [0, 1]
/// @param stop   ends the sampling early, with fewer samples
/// @throws std::invalid_argument if a time is outside its range
[[nodiscard]] FIRSTCONTACT_API std::vector<GapSample> sample_gap(const LoadedScene& loaded,
                                                                 std::span<const double> times,
                                                                 Workspace& workspace,
                                                                 const std::stop_token& stop = {});

/// Makes `count` times from 0 to 1 at equal distances; at least 2.
[[nodiscard]] FIRSTCONTACT_API std::vector<double> even_times(std::size_t count);

/// Makes the times of a test that runs `rate` times a second, from the start on.
///
/// @param rate      [1/s]  > 0
/// @param duration  [s]    > 0
/// @throws std::invalid_argument if these are more than ten million times
[[nodiscard]] FIRSTCONTACT_API std::vector<double> times_at_rate(double rate, double duration);

}  // namespace firstcontact
