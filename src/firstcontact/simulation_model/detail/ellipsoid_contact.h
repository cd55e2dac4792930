/// @file
/// Contacts of the ellipsoids that triangles stand for.

#pragma once

#include <array>

#include <firstcontact/query/contact.h>
#include <firstcontact/simulation_model/detail/round_feature.h>

namespace firstcontact::detail {

/// Replaces the triangles of ellipsoids in a contact by the ellipsoids.
///
/// The closest points, the normal and the distance become theirs. Where the nearest point of an
/// edge is its end, the feature becomes that corner.
///
/// An ellipsoid is outside of its triangles, so the distance becomes smaller. The contact stays as
/// it is where the distance becomes larger, or smaller by more than the sag. Then another feature
/// of the other body is the nearest one.
///
/// @param most_sag  [m]  of an ellipsoid
/// @returns the ellipsoids on which the contact then is
std::array<RoundFeature, 2> make_ellipsoidal(const std::array<PlacedRound, 2>& bodies,
                                             double most_sag, Contact& contact);

}  // namespace firstcontact::detail
