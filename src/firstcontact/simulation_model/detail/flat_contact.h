/// @file
/// Contacts over flat edges and flat corners as contacts over a face.

#pragma once

#include <array>

#include <firstcontact/motion/pose.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/detail/surface_neighbours.h>

namespace firstcontact {
class Shape;
}

namespace firstcontact::detail {

/// A body of a contact.
struct PlacedSurface {
  const Shape* shape = nullptr;
  const SurfaceNeighbours* neighbours = nullptr;
  Pose pose = {};
};

/// Gives a contact of a vertex with an edge or a vertex within a flat face the normal and the
/// points of that face.
///
/// The nearest point of an edge ahead is aside of an approaching body, so its normal leans. The
/// surface goes on flat there, and only the normal of the face can push. Otherwise a ball that
/// slides over such an edge is turned aside, and falls about the edge while it is above it.
void lay_on_face(const std::array<PlacedSurface, 2>& bodies, Contact& contact);

}  // namespace firstcontact::detail
