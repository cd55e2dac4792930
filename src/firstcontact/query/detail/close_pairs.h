/// @file
/// The pairs of features that are close at one instant.

#pragma once

#include <cstdint>

#include <firstcontact/query/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// With the features of the whole meshes.
[[nodiscard]] ClosePair close_pair(const ContactFrame& frame, std::uint32_t triangle_A,
                                   std::uint32_t triangle_B, const ClosestFeatures& closest);

/// Lists every pair of features within `band` [m] (radii included) in workspace.close_pairs, some
/// of them more than once.
///
/// @param state  at the instant
void find_close(const ContactFrame& frame, const RelativeState& state, double band,
                WorkspaceData& workspace);

/// The same of the pairs of triangles that the last search opened.
void find_close_among_opened(const ContactFrame& frame, const RelativeState& state, double band,
                             WorkspaceData& workspace);

}  // namespace firstcontact::detail
