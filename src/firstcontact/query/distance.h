/// @file
/// Distance of two moving shapes at one instant.

#pragma once

#include <firstcontact/query/first_contact.h>

namespace firstcontact {

/// The distance of two shapes at one instant.
struct DistanceResult {
  double distance = 0.0;         ///< [m]  Between the closest points found; 0 when the shapes meet.
  double lower_bound = 0.0;      ///< [m]  Proven: the shapes are at least this far apart.
  double enclosure_error = 0.0;  ///< [m]  Sum of both shapes: the bodies may be farther apart by
                                 ///< this.
  std::optional<Contact> closest;  ///< The closest feature pair.
  WorkCount work;
};

/// Finds the distance of A(t) and B(t).
///
/// `distance - lower_bound` is at most the rounding error. Beside a curved body the lower bound is
/// that of the triangles around it, which may be less by their enclosure errors, too.
/// @param t  [-]  in [0, 1]
/// @throws std::invalid_argument if t is outside its range.
[[nodiscard]] FIRSTCONTACT_API DistanceResult distance(const MovingShape& A, const MovingShape& B,
                                                       double t, Workspace& workspace);

}  // namespace firstcontact
