/// @file
/// A step of all bodies: islands advance separately, and are joined where they meet.

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

/// Advances every free body.
///
/// Islands advance side by side; the result of each is the same on any thread. Where motions bring
/// bodies of two islands into contact, the two are joined and advanced anew, until no two meet.
///
/// @returns nothing if it was stopped
[[nodiscard]] std::optional<std::vector<IslandTrack>> advance_islands(
    const SimulationModel& model, const StepStart& start, const std::vector<ManifoldPoint>& guesses,
    IslandThreads& threads, const std::stop_token& stop);

}  // namespace firstcontact::detail
