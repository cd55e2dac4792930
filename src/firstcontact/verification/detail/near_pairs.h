/// @file
/// Which bodies of a step can come near each other at all.

#pragma once

#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/verification/detail/run_follower.h>

namespace firstcontact::detail {

/// Holds the body during the whole step.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const RunMember& member, const FollowedBody& body);

/// All pairs of boxes that are no farther from each other than `reach` along every axis, in order.
///
/// @param reach  [m]  may be infinite
[[nodiscard]] std::vector<BodyPair> near_pairs(const std::vector<Eigen::AlignedBox3d>& boxes,
                                               double reach);

}  // namespace firstcontact::detail
