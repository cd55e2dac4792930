/// @file
/// Closest approach of two moving shapes over the step.

#pragma once

#include <firstcontact/query/first_contact.h>

namespace firstcontact {

/// The options of a closest approach.
struct ClosestApproachOptions {
  double tolerance = 1e-6;  ///< [m]  distance - lower_bound is at most this; > 0.
  WorkBudget budget = {};   ///< Beyond this much work the search ends with what is proven so far.
};

/// Where two shapes are closest over the step.
struct ClosestApproach {
  /// [m]  The distance that is attained at t; an upper bound of the least distance over the step.
  double distance = std::numeric_limits<double>::infinity();
  double lower_bound = 0.0;                        ///< [m]  Proven for all t in [0, 1].
  double t = 0.0;                                  ///< [-]  A time where `distance` is attained.
  UndecidedReason reason = UndecidedReason::none;  ///< Not `none` where the budget ended the
                                                   ///< search.
  std::optional<Contact> closest = {};             ///< The closest feature pair at t.
};

/// The closest approach of two shapes, with its errors and its work.
struct ClosestApproachResult : ClosestApproach {
  double tolerance_used = 0.0;   ///< [m]
  double enclosure_error = 0.0;  ///< [m]  Sum of both shapes: the bodies may be farther apart by
                                 ///< this.
  WorkCount work;
};

/// Finds the least distance of A and B over the step, to the tolerance, with a time where it is
/// attained.
///
/// Where the shapes touch, that time is the one of their first contact, and the distance is at most
/// the tolerance. Otherwise sampling and descent find the distance. Then first_contact() proves
/// `lower_bound`, which is its margin.
///
/// @throws std::invalid_argument if an option is outside its documented range.
[[nodiscard]] FIRSTCONTACT_API ClosestApproachResult
closest_approach(const MovingShape& A, const MovingShape& B, Workspace& workspace,
                 const ClosestApproachOptions& options = {});

}  // namespace firstcontact
