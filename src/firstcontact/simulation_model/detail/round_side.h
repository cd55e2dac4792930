/// @file
/// Prisms that roll as the cylinders that they stand for.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/contact.h>

namespace firstcontact::detail {

/// The side of a prism with so many facets that it rolls round.
struct RoundSide {
  Eigen::Vector3d centre_B = Eigen::Vector3d::Zero();  ///< [m]  On the axis, halfway.
  Eigen::Vector3d axis_B = Eigen::Vector3d::UnitZ();   ///< [-]
  double radius = 0.0;                                 ///< [m]  Of the corners.
  std::vector<bool> is_on_ring = {};                   ///< Of each vertex; others are within caps.
};

/// The round side of a shape: its vertices lie on two equal circles about x, y or z, or on the axis
/// between their centres, and no facet is farther inside of the circle than `sag`.
///
/// Cylinders are such prisms, and meshes of cylinders and discs. A thickened shape has none.
///
/// @param sag  [m]
[[nodiscard]] std::optional<RoundSide> find_round_side(const Shape& shape, double sag);

/// A body with or without a round side, where it is.
struct PlacedRoundSide {
  const Shape* shape = nullptr;
  const RoundSide* side = nullptr;  ///< Null: none.
  Pose pose = {};
};

/// [m]  The point of a round side that is farthest along a direction, beside a point of it.
[[nodiscard]] Eigen::Vector3d nearest_on_side(const PlacedRoundSide& body,
                                              const Eigen::Vector3d& beside,
                                              const Eigen::Vector3d& outwards);

/// Replaces the facets of a contact by the circles around them: its closest points, normal and
/// distance become those of cylinders where features on a round side, or on its rim, are near the
/// line that is nearest to the other body.
///
/// @returns  of which bodies a round side is part of it
std::array<bool, 2> make_round(const std::array<PlacedRoundSide, 2>& bodies, Contact& contact);

}  // namespace firstcontact::detail
