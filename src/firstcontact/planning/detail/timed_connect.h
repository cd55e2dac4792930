/// @file
/// Two trees in space and time.

#pragma once

#include <functional>
#include <vector>

#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/timed_place.h>

namespace firstcontact::detail {

class TimedEdges;

/// Looks for a way from a start at time 0 to one of several goals, where it rests until the end.
///
/// One tree grows from the start forward in time, one from the goals backward.
///
/// Source: after F. Grothe, V. Hartmann, A. Orthey, M. Toussaint, "ST-RRT*: Asymptotically-optimal
/// bidirectional motion planning through space-time", ICRA 2022. Here the horizon is fixed, and
/// their optimisation is left out.
///
/// @param range    [-]  the longest edge, in the length of the space
/// @param is_over  whether to end without an answer
/// @returns places with times from 0 to the duration; empty where none was found
[[nodiscard]] std::vector<TimedPlace> timed_connect(TimedEdges& edges, const Configuration& start,
                                                    const std::vector<Configuration>& goals,
                                                    double range, RandomNumbers& random,
                                                    const std::function<bool()>& is_over);

}  // namespace firstcontact::detail
