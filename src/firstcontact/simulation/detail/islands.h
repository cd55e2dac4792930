/// @file
/// A step of all bodies: islands that advance apart from each other, joined where they meet.

#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include <firstcontact/island/detail/island.h>
#include <firstcontact/simulation_model/detail/manifold.h>

namespace firstcontact::detail {

class IslandThreads;
struct StepStart;
struct SimulationModel;

/// Advances every free body. Two islands of which the motions found bring bodies of both into
/// contact were one: they are joined and advanced anew, until no two meet.
///
/// Islands advance side by side; what each does is the same on any thread.
///
/// @returns  nothing if it was stopped
[[nodiscard]] std::optional<std::vector<IslandTrack>> advance_islands(
    const SimulationModel& model, const StepStart& start, const std::vector<ManifoldPoint>& guesses,
    IslandThreads& threads, const std::stop_token& stop);

}  // namespace firstcontact::detail
