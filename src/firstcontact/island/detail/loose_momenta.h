/// @file
/// The momenta of an island that nothing outside acts on.

#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

struct IslandState;
struct ManifoldPoint;

struct Momenta {
  Eigen::Vector3d about = Eigen::Vector3d::Zero();    ///< [m]  A fixed point.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [kg m^2/s]  About that point.
};

/// Predicts the momenta of an island a share of a plan ahead. It has no value where bodies around
/// the island or locked axes act on it, or where a robot of it is held.
///
/// Impulses of contacts and ties are internal then, so only gravity and given forces change them.
///
/// @param touches  of the plan, with their impulses
/// @param span     [s]  of the plan
/// @param share    [-]  of it
[[nodiscard]] std::optional<Momenta> momenta_ahead(const IslandState& state,
                                                   const std::vector<ManifoldPoint>& touches,
                                                   double span, double share);

/// Gives an island these momenta: all bodies and robots move and turn faster by the same small
/// velocities, what is tied together as one body. So joints do not notice, and no tied group or
/// single body changes its way more than another.
///
/// Impulses act where bodies are at one time, and bodies get elsewhere by the curvature of their
/// way and by what is off a joint. So a plan misses the momenta by its order.
void take_momenta(const Momenta& momenta, IslandState& state);

}  // namespace firstcontact::detail
