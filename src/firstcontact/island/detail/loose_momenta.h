/// @file
/// The momenta of an island without forces from outside.

#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

struct IslandState;
struct ManifoldPoint;

/// The momenta of an island about a fixed point.
struct Momenta {
  Eigen::Vector3d about = Eigen::Vector3d::Zero();    ///< [m]  A fixed point.
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [kg m^2/s]  About that point.
};

/// Predicts the momenta of an island a share of a plan ahead. There is no value where bodies around
/// the island or locked axes act on it, or where a robot of it is held.
///
/// Otherwise impulses of contacts and ties are internal, so only gravity and given forces change
/// the momenta.
///
/// @param touches  of the plan, with their impulses
/// @param span     [s]  of the plan
/// @param share    [-]  of the plan
[[nodiscard]] std::optional<Momenta> momenta_ahead(const IslandState& state,
                                                   const std::vector<ManifoldPoint>& touches,
                                                   double span, double share);

/// Gives an island these momenta. All bodies and robots change their linear and angular velocities
/// by the same small amounts, a tied group as one body. So joints keep their velocities, and all
/// groups and single bodies change alike.
///
/// Impulses act at the places of bodies at one time. Bodies depart from these by the curvature of
/// their paths and by corrections of joints. So a plan keeps the momenta only to its order.
void take_momenta(const Momenta& momenta, IslandState& state);

}  // namespace firstcontact::detail
