/// @file
/// Finds the intervals of contact of two shapes by queries of them.

#pragma once

#include <functional>
#include <vector>

#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/motion/time_window.h>

namespace firstcontact::detail {

/// The queries of two shapes.
struct ContactQueries {
  /// Finds the first contact in a window before which the two are proven free, and not inside of
  /// each other.
  std::function<FirstContactResult(const TimeWindow&)> first_contact;
  std::function<double(double t)> distance;  ///< [m]  Rounded; 0 where one is inside of a solid.
};

/// The window of a search for intervals, with its margin and resolution.
struct IntervalSearch {
  TimeWindow window;
  double margin = 0.0;      ///< [m]
  double resolution = 0.0;  ///< [-]  See ContactInterval; > 0.
};

/// The intervals that a search found.
struct IntervalsFound {
  std::vector<ContactInterval> intervals;  ///< In order.
  double tolerance_used = 0.0;             ///< [m]  The greatest tolerance of all searches.
  WorkCount work;                          ///< Work of the searches after the first.
};

/// Finds all intervals of contact in a window.
///
/// After a contact the distance is sampled in steps of the resolution. Where the two have come
/// apart, the end of the contact is bisected, and the next first contact is searched for.
///
/// @param first  the answer to first contact in the window
[[nodiscard]] IntervalsFound contact_intervals(const FirstContactResult& first,
                                               const IntervalSearch& search,
                                               const ContactQueries& queries);

/// Unites the intervals of a pair of members, in order. Gaps up to the resolution are closed.
[[nodiscard]] std::vector<ContactInterval> joined(std::vector<ContactInterval> intervals,
                                                  double resolution);

}  // namespace firstcontact::detail
