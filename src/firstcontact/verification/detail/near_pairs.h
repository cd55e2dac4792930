/// @file
/// The bodies of a step that can come near each other.

#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/verification/detail/run_follower.h>

namespace firstcontact::detail {

/// A box that holds the body during the whole step.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const RunMember& member, const FollowedBody& body);

/// Finds all pairs of boxes that are no farther from each other than `reach` along every axis, in
/// order.
///
/// @param reach  [m]  may be infinite
[[nodiscard]] std::vector<BodyPair> near_pairs(const std::vector<Eigen::AlignedBox3d>& boxes,
                                               double reach);

}  // namespace firstcontact::detail
