/// @file
/// Contacts of polygons as those of the circles that they stand for.

#pragma once

#include <array>

#include <firstcontact/query/contact.h>
#include <firstcontact/simulation_model/detail/round_feature.h>

namespace firstcontact::detail {

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
