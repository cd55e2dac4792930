/// @file
/// Sleeping islands: their steps are as the one before.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/island/detail/island.h>
#include <firstcontact/simulation_model/detail/manifold.h>

namespace firstcontact::detail {

struct IslandState;
struct Plan;
struct StepContext;

/// Whether bodies that a plan moves over the whole step are held where they are.
///
/// A contact presses each of them or a tie holds it, and nothing scripted moves beside them. Before
/// and after the plan none is faster than a little more than what exact solutions leave, 3e-5 of
/// what gravity adds in a step at most. Bodies that gather speed more slowly than that are at rest,
/// too; without gravity none are. Heaps, which are solved less exactly, rarely get there.
[[nodiscard]] bool falls_asleep(const IslandState& state, const Plan& plan,
                                const std::vector<ManifoldPoint>& touches);

/// Whether all members were found at rest in the step before, and nothing that acts on them
/// changed.
///
/// Nothing changed since: no force on them begins or ends, and nothing scripted moves near them.
[[nodiscard]] bool stays_asleep(const StepContext& step, const std::vector<std::size_t>& members);

/// The track of members that stay at rest. What touches and presses is as in the step before.
[[nodiscard]] IslandTrack track_asleep(const StepContext& step, std::vector<std::size_t> members);

}  // namespace firstcontact::detail
