/// @file
/// The curved surface of a contact.

#pragma once

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/simulation_model/detail/round_circles.h>
#include <firstcontact/simulation_model/detail/round_ellipsoid.h>

namespace firstcontact::detail {

/// The circle or the ellipsoid on which a contact is.
struct RoundFeature {
  const RoundCircle* circle = nullptr;        ///< Null: the contact is on none.
  bool is_hole = false;                       ///< Whether the circle goes round the other body.
  const RoundEllipsoid* ellipsoid = nullptr;  ///< Null: the contact is on none.

  friend bool operator==(const RoundFeature&, const RoundFeature&) = default;

  [[nodiscard]] bool is_curved() const { return circle != nullptr || ellipsoid != nullptr; }

  /// [m]  Radius of the circle; negative for a hole, whose surface is on the other side of its
  /// axis.
  [[nodiscard]] double radius() const { return is_hole ? -circle->inner : circle->outer; }
};

/// A body at its place, with its circles or its ellipsoid.
struct PlacedRound {
  const Shape* shape = nullptr;               ///< Triangles: SimBody::surface.
  bool is_curved = false;                     ///< Whether the triangles stand for a curved shape.
  const RoundCircles* circles = nullptr;      ///< Null: none.
  const RoundEllipsoid* ellipsoid = nullptr;  ///< Null: it is no ellipsoid.
  Pose pose = {};
};

/// [m]  The point of a curved feature that is farthest along a direction, beside one of its points.
[[nodiscard]] Eigen::Vector3d farthest_on(const Pose& pose, const RoundFeature& feature,
                                          const Eigen::Vector3d& beside,
                                          const Eigen::Vector3d& outwards);

}  // namespace firstcontact::detail
