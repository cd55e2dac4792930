/// @file
/// Records the results of the islands of a step.

#pragma once

#include <vector>

#include <firstcontact/record/run_step.h>

namespace firstcontact::detail {

struct IslandTrack;
struct SimulationState;
struct StepStart;
struct SimulationModel;

/// Moves a simulation over a step, as far as all of its islands came, and records it.
[[nodiscard]] RunStep record_step(const SimulationModel& model, const StepStart& start,
                                  const std::vector<IslandTrack>& tracks, SimulationState& state);

}  // namespace firstcontact::detail
