/// @file
/// When two geometries are in contact.

#pragma once

#include <vector>

#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/robot_check/detail/geometry_search.h>

namespace firstcontact::detail {

/// The answer of a candidate over its window.
struct GeometryAnswer {
  FirstContactResult first;  ///< With contacts in the world. When free, `t` is 1.
  std::vector<ContactInterval> intervals;
  WorkCount work;
};

/// First contact in the window up to `horizon`.
///
/// @param may_start_inside  whether the two were not tested just before the window
[[nodiscard]] GeometryAnswer first_contact_of(GeometrySearch& search,
                                              const GeometryCandidate& candidate, double horizon,
                                              bool may_start_inside);

/// All intervals of contact in the window, in order, with what the first of them is.
[[nodiscard]] GeometryAnswer contact_intervals_of(GeometrySearch& search,
                                                  const GeometryCandidate& candidate,
                                                  double resolution);

}  // namespace firstcontact::detail
