/// @file
/// Lazy PRM* on proven edges.

#pragma once

#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/found_path.h>
#include <firstcontact/planning/detail/plan_work.h>

namespace firstcontact::detail {

/// Grows a graph of free places until a path is found, then as much again to shorten it.
///
/// Each place is joined to its e (1 + 1/d) ln n nearest ones. An edge is checked only once it lies
/// on the shortest path that is left. Start and goals are free.
[[nodiscard]] FoundPath lazy_prm_star(PlanWork& work, const Configuration& start,
                                      const std::vector<Configuration>& goals,
                                      RandomNumbers& random);

}  // namespace firstcontact::detail
