/// @file
/// When two parts are in contact.

#pragma once

#include <vector>

#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/detail/part_search.h>

namespace firstcontact::detail {

/// The answer of a candidate over its window.
struct PartAnswer {
  FirstContactResult first;            ///< When free, `t` is 1.
  std::vector<RobotContact> contacts;  ///< At first.t.
  std::vector<ContactInterval> intervals;
  std::uint64_t steps = 0;
};

/// First contact in the window up to `horizon`.
///
/// @param may_start_inside  whether the two were not tested just before the window
[[nodiscard]] PartAnswer first_contact_of(PartSearch& search, const PartCandidate& candidate,
                                          double horizon, bool may_start_inside);

/// All intervals of contact in the window, in order, with what the first of them is.
///
/// After a contact the distance is looked at in steps of the resolution; where the two have come
/// apart the end of the contact is bisected, and first contact asked for again.
[[nodiscard]] PartAnswer contact_intervals_of(PartSearch& search, const PartCandidate& candidate,
                                              double resolution);

/// The union of intervals of a pair of members, in order. Gaps up to the resolution are closed.
[[nodiscard]] std::vector<ContactInterval> joined(std::vector<ContactInterval> intervals,
                                                  double resolution);

}  // namespace firstcontact::detail
