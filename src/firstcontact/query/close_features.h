/// @file
/// The features of two shapes that are close at one instant.

#pragma once

#include <vector>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/placed_shape.h>

namespace firstcontact {

/// Finds every feature pair of A(t) and B(t) within `band`, sorted by features, each once.
///
/// It is the contact state of first_contact() at a time of the caller's choice. It replaces the
/// contents of `contacts`.
///
/// The list is complete except for pairs whose distance differs from the band by less than the
/// rounding error. Only surfaces count: geometry inside a solid that is not near its surface is not
/// listed.
///
/// Surfaces that slide in each other, as a screw thread in its nut, may have very many pairs. A
/// caller that needs only a few of them, and the nearest, sets `beside`.
///
/// @param t       [-]  in [0, 1]
/// @param band    [m]  finite, >= 0; radii are included in distances
/// @param beside  [m]  >= 0; 0 for all pairs. Else, of very many pairs that are nearer to each
///                other than about this and face alike, only the nearest may be listed
/// @throws std::invalid_argument if t, the band or `beside` is outside its range.
FIRSTCONTACT_API void close_features(const MovingShape& A, const MovingShape& B, double t,
                                     double band, Workspace& workspace,
                                     std::vector<Contact>& contacts, double beside = 0.0);

/// Finds the close feature pairs of two shapes at rest, equal to the last bit.
///
/// @param A,B     shapes that do not deform
/// @param band    [m]  finite, >= 0; radii are included in distances
/// @param beside  [m]  finite, >= 0; as above
/// @throws std::invalid_argument if the band or `beside` is outside its range.
FIRSTCONTACT_API void close_features(const PlacedShape& A, const PlacedShape& B, double band,
                                     Workspace& workspace, std::vector<Contact>& contacts,
                                     double beside = 0.0);

/// Finds the closest points of two shapes at rest where curved shapes are the convex sets that they
/// are, as first_contact() takes them.
///
/// A convex set has one pair of points with each triangle of the other shape, or with the other
/// set. Other shapes are asked as by close_features().
///
/// @param A,B     shapes that do not deform
/// @param band    [m]  finite, >= 0; radii are included in distances
/// @throws std::invalid_argument if the band is outside its range.
FIRSTCONTACT_API void close_points_of_sets(const PlacedShape& A, const PlacedShape& B, double band,
                                           Workspace& workspace, std::vector<Contact>& contacts);

}  // namespace firstcontact
