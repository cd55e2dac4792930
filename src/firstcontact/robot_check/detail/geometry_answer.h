/// @file
/// The times at which two geometries are in contact.

#pragma once

#include <vector>

#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/robot_check/detail/geometry_search.h>

namespace firstcontact::detail {

/// The answer of a candidate over its window.
struct GeometryAnswer {
  FirstContactResult first;  ///< The first contact, with contacts in the world. When free, `t` is
                             ///< 1.
  double margin = 0.0;       ///< [m]  The distance at which contact begins, at the time of `first`.
  std::vector<ContactInterval> intervals;
  WorkCount work;
};

/// Finds the first contact in the window up to `horizon`.
///
/// @param may_start_inside  whether the two were not tested just before the window
[[nodiscard]] GeometryAnswer first_contact_of(GeometrySearch& search,
                                              const GeometryCandidate& candidate, double horizon,
                                              bool may_start_inside);

/// Finds all intervals of contact in the window, in order, and the first contact.
[[nodiscard]] GeometryAnswer contact_intervals_of(GeometrySearch& search,
                                                  const GeometryCandidate& candidate,
                                                  double resolution);

}  // namespace firstcontact::detail
