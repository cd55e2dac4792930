/// @file
/// The pairs of features that are close at one instant.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/detail/workspace_data.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// The feature of a whole mesh for a feature of a triangle in the hierarchy's order.
[[nodiscard]] Feature global_feature(const Shape& shape, std::uint32_t triangle,
                                     const TriangleFeature& local);

/// The close pair of two triangles, with the features of the whole meshes.
[[nodiscard]] ClosePair close_pair(const ContactFrame& frame, std::uint32_t triangle_A,
                                   std::uint32_t triangle_B, const ClosestFeatures& closest);

/// Lists the pairs of features within `band` [m] (radii included) in workspace.close_pairs.
///
/// Some of them are listed more than once. If there are very many, only those that ContactSelection
/// chooses are listed. Then the function returns how many there are.
///
/// @param state  at the instant
/// @param most   >= 1, the number that is asked for
std::optional<ContactCount> find_close(const ContactFrame& frame, const RelativeState& state,
                                       double band, std::size_t most, WorkspaceData& workspace);

/// Lists the close features of all pairs of triangles that the last search opened.
void find_close_among_opened(const ContactFrame& frame, const RelativeState& state, double band,
                             WorkspaceData& workspace);

}  // namespace firstcontact::detail
