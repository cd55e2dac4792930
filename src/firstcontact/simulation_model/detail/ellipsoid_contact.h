/// @file
/// Contacts of ellipsoids.

#pragma once

#include <array>

#include <firstcontact/query/contact.h>
#include <firstcontact/simulation_model/detail/round_feature.h>

namespace firstcontact::detail {

/// Makes a contact of the exact search one of the other body's feature.
///
/// The search knows points to its rounding. A point on an edge may count as one of a face beside
/// it. So a face to which the normal is not perpendicular becomes its nearest edge or corner. Then
/// the closest points, the normal and the distance are computed from the features. They stay as the
/// search found them where that gives another distance.
///
/// @param bodies  at least one is an ellipsoid
/// @returns the ellipsoids, and the cylinder's circle, on which the contact is
std::array<RoundFeature, 2> make_ellipsoidal(const std::array<PlacedRound, 2>& bodies,
                                             Contact& contact);

}  // namespace firstcontact::detail
