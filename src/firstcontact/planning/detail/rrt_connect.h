/// @file
/// RRT-Connect on proven edges.

#pragma once

#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/found_path.h>
#include <firstcontact/planning/detail/plan_work.h>

namespace firstcontact::detail {

/// Grows one tree from the start and one from all goals until they meet, or the time is over.
///
/// Start and goals are free.
[[nodiscard]] FoundPath rrt_connect(PlanWork& work, const Configuration& start,
                                    const std::vector<Configuration>& goals, double range,
                                    RandomNumbers& random);

}  // namespace firstcontact::detail
