/// @file
/// When two shapes are in contact, by questions about them.

#pragma once

#include <functional>
#include <vector>

#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/motion/time_window.h>

namespace firstcontact::detail {

/// What can be asked about two shapes.
struct ContactQueries {
  /// First contact in a window before which the two are proven free, and not inside of each other.
  std::function<FirstContactResult(const TimeWindow&)> first_contact;
  std::function<double(double t)> distance;  ///< [m]  Rounded; 0 for one inside of a solid.
};

struct IntervalSearch {
  TimeWindow window;
  double margin = 0.0;      ///< [m]
  double resolution = 0.0;  ///< [-]  See ContactInterval; > 0.
};

struct IntervalsFound {
  std::vector<ContactInterval> intervals;  ///< In order.
  double tolerance_used = 0.0;             ///< [m]  The greatest of all searches.
  WorkCount work;                          ///< Of the searches after the first.
};

/// Finds all intervals of contact in a window.
///
/// After a contact the distance is looked at in steps of the resolution; where the two have come
/// apart the end of the contact is bisected, and first contact asked for again.
///
/// @param first  the answer to first contact in the window
[[nodiscard]] IntervalsFound contact_intervals(const FirstContactResult& first,
                                               const IntervalSearch& search,
                                               const ContactQueries& queries);

/// The union of intervals of a pair of members, in order. Gaps up to the resolution are closed.
[[nodiscard]] std::vector<ContactInterval> joined(std::vector<ContactInterval> intervals,
                                                  double resolution);

}  // namespace firstcontact::detail
