/// @file
/// The angular momentum of an island that nothing outside acts on.

#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

struct IslandState;
struct ManifoldPoint;

/// [N m s]  About the centre of mass of an island, a share of a plan ahead; nothing where bodies
/// around the island, robots or locked axes act on it.
///
/// Impulses of contacts and ties are internal then, so only given forces change it.
///
/// @param touches  of the plan, with their impulses
/// @param span     [s]  of the plan
/// @param share    [-]  of it
[[nodiscard]] std::optional<Eigen::Vector3d> angular_momentum_ahead(
    const IslandState& state, const std::vector<ManifoldPoint>& touches, double span, double share);

/// Gives an island an angular momentum [N m s]: all bodies turn faster by the same small angular
/// velocity, what is tied together as one body. So joints do not notice, and no tied group or
/// single body gets another linear momentum.
///
/// Impulses act where bodies are at one time, and bodies get elsewhere by the curvature of their
/// way and by what is off a joint. So a plan misses the momentum by its order.
void take_angular_momentum(const Eigen::Vector3d& momentum, IslandState& state);

}  // namespace firstcontact::detail
