/// @file
/// Of very many pairs of triangles that are close, the nearest ones of each neighbourhood.

#pragma once

#include <vector>

#include <firstcontact/query/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Keeps of some pairs those within `reach` of which fewer than three nearer ones have their place
/// in the same cube and face a like way. The nearest of all is among them.
///
/// @param edge  [m]  of the cubes, which are fixed in A's frame up to rotation
void keep_nearest(const ContactFrame& frame, const RelativeState& state, double reach, double edge,
                  std::vector<IndexPair>& pairs);

}  // namespace firstcontact::detail
