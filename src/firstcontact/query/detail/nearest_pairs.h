/// @file
/// The nearest pairs of each neighbourhood, from very many close pairs of triangles.

#pragma once

#include <vector>

#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Keeps those pairs within `reach` that are among the three nearest of their cube and direction.
///
/// A pair is kept if fewer than three nearer ones have their place in the same cube and face a like
/// way. The nearest of all is among them.
///
/// @param edge  [m]  of the cubes, which are fixed in A's frame up to rotation
void keep_nearest(const ContactFrame& frame, const RelativeState& state, double reach, double edge,
                  std::vector<IndexPair>& pairs);

/// Keeps pairs likewise, whose closest points are known to be within the reach.
void keep_nearest(double edge, std::vector<NearTriangles>& pairs);

}  // namespace firstcontact::detail
