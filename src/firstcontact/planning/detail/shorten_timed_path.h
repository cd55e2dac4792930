/// @file
/// Certified shortcuts in space and time.

#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/timed_place.h>

namespace firstcontact::detail {

class TimedEdges;

/// Lets a motion arrive earlier, and makes its way shorter, as far as that is proven.
///
/// Stretches between two places, first of the motion and then of its edges at random, become one
/// edge at its greatest speed. All that comes after is earlier by the time that this saves, or by
/// as much of it as halving finds to be free. The same is done to each edge that is slower than it
/// may be. Neither the way nor the arrival ever grows; the ends stay, bit for bit.
///
/// @param path     places with times from 0 to the duration, the last one at the goal
/// @param tries    the most random stretches; with 0 the path stays as it is
/// @param is_over  ends it early
void shorten_timed_path(TimedEdges& edges, std::vector<TimedPlace>& path, std::size_t tries,
                        RandomNumbers& random, const std::function<bool()>& is_over);

}  // namespace firstcontact::detail
