/// @file
/// Contacts of triangles as those of the ellipsoids that they stand for.

#pragma once

#include <array>

#include <firstcontact/query/contact.h>
#include <firstcontact/simulation_model/detail/round_feature.h>

namespace firstcontact::detail {

/// Replaces the triangles of ellipsoids in a contact by the ellipsoids: its closest points, normal
/// and distance become theirs. Where the nearest point of an edge is its end, the feature is that
/// corner then.
///
/// An ellipsoid is outside of its triangles, so the distance becomes smaller. Where it becomes
/// larger, or smaller by more than the sag, the contact stays as it is: then another feature of the
/// other body is the nearest one.
///
/// @param most_sag  [m]  of an ellipsoid
/// @returns  on which ellipsoids it is then
std::array<RoundFeature, 2> make_ellipsoidal(const std::array<PlacedRound, 2>& bodies,
                                             double most_sag, Contact& contact);

}  // namespace firstcontact::detail
