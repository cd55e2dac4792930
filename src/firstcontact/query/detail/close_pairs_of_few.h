/// @file
/// The pairs of features that are close, of two meshes of few triangles.

#pragma once

#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Whether both meshes are small enough.
[[nodiscard]] bool are_few(const MovingPair& pair);

/// Lists every pair of features within `band` [m] (radii included) in workspace.close_pairs, each
/// once with its nearest points, and their order by features in workspace.close_keys.
///
/// Boxes around boxes tell little of so few triangles. Each feature is placed once: edges of one
/// body meet all those of the other one on vector units, and so do corners and faces.
///
/// @param frame  of meshes that are_few()
/// @param state  at the instant
void find_close_of_few(const ContactFrame& frame, const RelativeState& state, double band,
                       WorkspaceData& workspace);

}  // namespace firstcontact::detail
