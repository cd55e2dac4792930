/// @file
/// The contacts of a pair with one or two convex sets.

#pragma once

#include <cstdint>

#include <firstcontact/moving_pairs/detail/contact_frame.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// The feature, at a point of its surface, of a shape that is treated as a convex set.
///
/// A curved shape has the face of its triangles over the point, found by formulas. Other shapes
/// have the feature nearest to the point.
///
/// @param p_S  [m]  in the body frame
[[nodiscard]] Feature feature_at(const Shape& shape, const Eigen::Vector3d& p_S);

/// The closest features of two leaves.
[[nodiscard]] ClosePair close_convex_pair(const ContactFrame& frame, const RelativeState& state,
                                          std::uint32_t a, std::uint32_t b,
                                          const ClosestFeatures& closest);

/// Lists the closest points of the set and each triangle within `band` [m] (radii included), or
/// those of two sets, in workspace.close_pairs.
void find_close_to_convex(const ContactFrame& frame, const RelativeState& state, double band,
                          WorkspaceData& workspace);

}  // namespace firstcontact::detail
