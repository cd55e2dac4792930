/// @file
/// The close pairs of features of two meshes of few triangles.

#pragma once

#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Whether both meshes are small enough, and all their triangles have an area.
[[nodiscard]] bool are_few(const ContactFrame& frame);

/// Lists every pair of features within `band` [m] (radii included) in workspace.close_pairs.
///
/// Each is listed once, with its nearest points. workspace.close_keys has their order by features.
/// Boxes separate few pairs of so few triangles. So each feature is placed once, and the edges of
/// one body meet all those of the other on vector units. So do corners and faces.
///
/// @param frame  frame of two meshes that are_few()
/// @param state  relative state at the instant
void find_close_of_few(const ContactFrame& frame, const RelativeState& state, double band,
                       WorkspaceData& workspace);

}  // namespace firstcontact::detail
