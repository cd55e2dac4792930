/// @file
/// The first contact of two geometries whose threshold depends on time, through tracking errors.

#pragma once

#include <cstdint>
#include <functional>

#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/shape_pair.h>

namespace firstcontact::detail {

/// The questions about two geometries with tracking errors.
struct TrackedQueries {
  /// [m]  Bound of the effect of the errors over a window.
  std::function<double(const TimeWindow&)> error;
  /// First contact in a window, with a bound [m] that counts in all of it, a tolerance [m] and the
  /// most steps.
  std::function<FirstContactResult(const TimeWindow&, double, double, std::uint64_t)> first_contact;
};

/// Finds the first contact in a window. The two are then no farther apart than margin + bound +
/// tolerance, with the bound of that time.
///
/// A bound over a window is larger than at its instants. So a contact that it finds may be none.
/// Shorter windows from there on decide, until the excess is a part of the tolerance.
///
/// Free stretches of time keep the margin and the bound of each of their instants. So a piece of a
/// free motion is free, whatever its windows, if the motion had twice the tolerance beyond its
/// margin.
///
/// @param steps  the most steps of all questions together
[[nodiscard]] FirstContactResult first_contact_within_errors(const TimeWindow& window,
                                                             double tolerance, std::uint64_t steps,
                                                             const TrackedQueries& queries);

}  // namespace firstcontact::detail
