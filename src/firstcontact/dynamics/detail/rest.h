/// @file
/// Islands at rest: their steps are as the one before.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/dynamics/detail/island.h>
#include <firstcontact/dynamics/detail/island_plan.h>
#include <firstcontact/dynamics/detail/island_state.h>

namespace firstcontact::detail {

/// Whether bodies that a plan moves over the whole step are held where they are: contacts carry
/// each of them, and before and after it is no faster than a few times what is left of the laws
/// anyway. So is at rest what would only gather speed by some 1e-6 of gravity (in heaps 4e-3).
[[nodiscard]] bool comes_to_rest(const IslandState& state, const Plan& plan,
                                 const std::vector<Touch>& touches);

/// Whether all members were found at rest in the step before, and nothing changed since that acts
/// on them: no force on them begins or ends, nothing scripted moves near them.
[[nodiscard]] bool stays_at_rest(const StepContext& step, const std::vector<std::size_t>& members);

/// Of members that stay at rest. What touches and presses is as in the step before.
[[nodiscard]] IslandTrack track_at_rest(const StepContext& step, std::vector<std::size_t> members);

}  // namespace firstcontact::detail
