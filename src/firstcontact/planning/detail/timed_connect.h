/// @file
/// Two trees in space and time.

#pragma once

#include <functional>
#include <vector>

#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/timed_place.h>
#include <firstcontact/planning/search_tree.h>

namespace firstcontact::detail {

class TimedEdges;

/// The outcome of a search with trees in space and time.
struct TimedFound {
  std::vector<TimedPlace> path;   ///< From the time 0 to the duration; empty where there is none.
  std::vector<SearchTree> trees;  ///< The two trees, where they were to be kept.
};

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
/// @param keep_trees  whether the trees are returned, too
[[nodiscard]] TimedFound timed_connect(TimedEdges& edges, const Configuration& start,
                                       const std::vector<Configuration>& goals, double range,
                                       RandomNumbers& random, const std::function<bool()>& is_over,
                                       bool keep_trees);

}  // namespace firstcontact::detail
