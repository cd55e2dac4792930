/// @file
/// Lazy PRM* on proven edges.

#pragma once

#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/found_path.h>
#include <firstcontact/planning/detail/plan_work.h>

namespace firstcontact::detail {

/// Finds paths by RRT-Connect, and shorter ones by a graph of free places.
///
/// RRT-Connect is begun anew until four paths in a row, with their shortcuts, are not shorter by 1
/// %. All of them are parts of the graph, so that the answer is never longer than the first. New
/// places could be on a shorter path: the sum of their distances from the start and to a goal is
/// less than the cost. Each is joined to its e (1 + 1/d) ln n nearest ones. An edge is checked only
/// once it lies on the shortest path that is left.
///
/// It ends where the graph has doubled, to 1000 places or more, without a path that is shorter by
/// 1 %. It also ends where 20,000 samples in a row could not be on a shorter path, or with the
/// time. Start and goals are free.
///
/// Source: J. Gammell, S. Srinivasa, T. Barfoot, "Informed RRT*", IROS 2014, for the samples.
///
/// @param range  longest edge of RRT-Connect's trees
[[nodiscard]] FoundPath lazy_prm_star(PlanWork& work, const Configuration& start,
                                      const std::vector<Configuration>& goals, double range,
                                      RandomNumbers& random);

}  // namespace firstcontact::detail
