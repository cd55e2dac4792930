/// @file
/// A step of a simulation, with what its scripts do where they would crush something.

#pragma once

#include <optional>
#include <stop_token>

#include <firstcontact/record/run_step.h>

namespace firstcontact {
struct Simulation;
}

namespace firstcontact::detail {

class IslandThreads;
class Script;
struct SimulationModel;
struct SimulationState;

/// Advances a simulation by a step, or as far as could be proven.
///
/// It is taken in parts in which scripted bodies move straight. Where they would crush what cannot
/// yield and may wait (JamRule), they go as far as they can, and wait in the rest of the step.
///
/// @param state  is advanced. Where the step was stopped it is left halfway.
/// @returns  nothing if it was stopped
[[nodiscard]] std::optional<RunStep> advance_step(const SimulationModel& model,
                                                  const Script& script, const Simulation& settings,
                                                  IslandThreads& threads,
                                                  const std::stop_token& stop,
                                                  SimulationState& state);

/// Whether a step jammed, and nearly all of it was lost.
[[nodiscard]] bool is_lost(const RunStep& step);

}  // namespace firstcontact::detail
