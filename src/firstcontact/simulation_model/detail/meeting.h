/// @file
/// Bodies that meet at their places.

#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/query/workspace.h>

namespace firstcontact::detail {

struct SimulationModel;

/// Finds a pair that is not proven apart by its margin.
///
/// `concerns` is true for one of its bodies, and not both are held.
[[nodiscard]] std::optional<BodyPair> find_meeting(const SimulationModel& model,
                                                   const std::vector<RigidState>& states,
                                                   const std::function<bool(std::size_t)>& concerns,
                                                   Workspace& workspace);

}  // namespace firstcontact::detail
