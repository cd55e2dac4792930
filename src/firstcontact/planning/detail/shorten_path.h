/// @file
/// Certified shortcuts.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/plan_work.h>

namespace firstcontact::detail {

/// Replaces stretches of a path by edges that are shorter and proven.
///
/// First it skips places. Then it replaces stretches between two random places of edges, whole or
/// in one coordinate of joints only. The ends stay, bit for bit, and the cost never grows. A round
/// ends early when many tries in a row have not helped. Further rounds of half as many tries
/// follow, as long as each saves 2 % of the cost.
///
/// Source: R. Geraerts, M. Overmars, "Creating high-quality paths for motion planning", IJRR 26
/// (2007).
///
/// @param tries  the most edges that are tried in place of others in the first round
void shorten_path(PlanWork& work, std::vector<Configuration>& path, std::size_t tries,
                  RandomNumbers& random);

}  // namespace firstcontact::detail
