/// @file
/// Contacts of the circles that polygons stand for.

#pragma once

#include <array>

#include <firstcontact/query/contact.h>
#include <firstcontact/simulation_model/detail/round_feature.h>

namespace firstcontact::detail {

/// Replaces polygons of a contact by their circles.
///
/// The closest points, the normal and the distance become those of the circles, where these are
/// near to the point that is nearest to the other body. That holds for contacts on the sides of
/// cylinders, on rims that stand on a face, and on rims along a line parallel to their axis.
///
/// Where the axis of a cylinder crosses an edge or another axis, the points are where both lines
/// are nearest. Beyond the end of an edge its corner becomes the feature. Beyond the end of a
/// cylinder the contact stays as it is.
///
/// A circle is outside of an outer polygon, and inside of a hole, so the distance becomes smaller.
/// The contact stays as it is where the distance becomes larger. It also stays where the distance
/// becomes smaller by more than the sag and the curve up to the nearest point explain.
///
/// @param most_sag  [m]  of a circle
/// @returns the circles on which the contact then is
std::array<RoundFeature, 2> make_round(const std::array<PlacedRound, 2>& bodies, double most_sag,
                                       Contact& contact);

}  // namespace firstcontact::detail
