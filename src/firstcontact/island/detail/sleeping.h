/// @file
/// Sleeping islands: their steps repeat the step before.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/island/detail/island.h>
#include <firstcontact/simulation_model/detail/manifold.h>

namespace firstcontact::detail {

struct IslandState;
struct Plan;
struct StepContext;

/// Whether an island that a plan moves over the whole step falls asleep: its bodies are held.
///
/// A contact presses each body or a tie holds it, and no scripted body moves beside it. Before and
/// after the plan the speeds are at most a little above the residual of exact solutions. That is at
/// most 3e-5 of what gravity adds in a step. Bodies that gather speed more slowly than that fall
/// asleep, too; without gravity none do. Heaps, which are solved less exactly, rarely fall asleep.
[[nodiscard]] bool falls_asleep(const IslandState& state, const Plan& plan,
                                const std::vector<ManifoldPoint>& touches);

/// Whether all members slept in the step before, and nothing that acts on them changed.
///
/// So no force on them begins or ends, and no scripted body moves near them.
[[nodiscard]] bool stays_asleep(const StepContext& step, const std::vector<std::size_t>& members);

/// Makes the track of sleeping members. Their touches press as in the step before.
[[nodiscard]] IslandTrack track_asleep(const StepContext& step, std::vector<std::size_t> members);

}  // namespace firstcontact::detail
