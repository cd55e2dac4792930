/// @file
/// A step of a simulation, with scripts that wait where they would crush something.

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
/// The step is taken in parts in which scripted bodies move straight. A script may crush a body
/// that cannot yield. If it may wait (JamRule), it goes as far as it can, and waits in the rest of
/// the step.
///
/// @param state  is advanced; left halfway where the step was stopped
/// @returns nothing if it was stopped
[[nodiscard]] std::optional<RunStep> advance_step(const SimulationModel& model,
                                                  const Script& script, const Simulation& settings,
                                                  IslandThreads& threads,
                                                  const std::stop_token& stop,
                                                  SimulationState& state);

/// Whether a step jammed, and nearly all of it was lost.
[[nodiscard]] bool is_lost(const RunStep& step);

}  // namespace firstcontact::detail
