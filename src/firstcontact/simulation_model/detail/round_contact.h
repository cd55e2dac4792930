/// @file
/// Contacts of polygons as those of the circles that they stand for.

#pragma once

#include <array>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/simulation_model/detail/round_circles.h>

namespace firstcontact::detail {

/// The circle on which a contact is.
struct RoundFeature {
  const RoundCircle* circle = nullptr;  ///< Null: the contact is on none.
  bool is_hole = false;                 ///< Whether the circle goes round the other body.

  /// [m]  Of the circle; negative: of a hole, whose surface is on the other side of its axis.
  [[nodiscard]] double radius() const { return is_hole ? -circle->inner : circle->outer; }
};

/// A body with or without circles, where it is.
struct PlacedRound {
  const Shape* shape = nullptr;
  const RoundCircles* circles = nullptr;  ///< Null: none.
  Pose pose = {};
};

/// [m]  The point of a round feature that is farthest along a direction, beside a point of it.
[[nodiscard]] Eigen::Vector3d nearest_on_circle(const Pose& pose, const RoundFeature& feature,
                                                const Eigen::Vector3d& beside,
                                                const Eigen::Vector3d& outwards);

/// Replaces polygons of a contact by their circles: its closest points, normal and distance become
/// those of the circles, where these are near to the point that is nearest to the other body.
///
/// So are contacts on the sides of cylinders, on rims that stand on a face, and on rims along a
/// line that is parallel to their axis. A circle is outside of an outer polygon, and inside of a
/// hole. So the distance becomes smaller. Where it becomes larger, or smaller by more than the sag
/// and the curve up to the nearest point explain, the contact stays as it is.
///
/// @param most_sag  [m]  of a circle
/// @returns  on which circles it is then
std::array<RoundFeature, 2> make_round(const std::array<PlacedRound, 2>& bodies, double most_sag,
                                       Contact& contact);

}  // namespace firstcontact::detail
