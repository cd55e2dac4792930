/// @file
/// Islands at rest: their steps are as the one before.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/simulation/detail/island.h>
#include <firstcontact/simulation/detail/touch.h>

namespace firstcontact::detail {

struct IslandState;
struct Plan;
struct StepContext;

/// Whether bodies that a plan moves over the whole step are held where they are: a contact presses
/// each of them, nothing scripted moves beside them, and before and after it none is faster than a
/// little more than what exact solutions leave, 3e-5 of what gravity adds in a step at most. What
/// gathers speed more slowly than that is at rest, too; without gravity nothing is. Heaps, which
/// are solved less exactly, hardly ever get there.
[[nodiscard]] bool comes_to_rest(const IslandState& state, const Plan& plan,
                                 const std::vector<Touch>& touches);

/// Whether all members were found at rest in the step before, and nothing changed since that acts
/// on them: no force on them begins or ends, nothing scripted moves near them.
[[nodiscard]] bool stays_at_rest(const StepContext& step, const std::vector<std::size_t>& members);

/// Of members that stay at rest. What touches and presses is as in the step before.
[[nodiscard]] IslandTrack track_at_rest(const StepContext& step, std::vector<std::size_t> members);

}  // namespace firstcontact::detail
