/// @file
/// The order in which two bodies are treated, and how they then move against each other.

#pragma once

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/motion/constant_rate_pair.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Whether A comes before B by content, so that a query and its swap do the same arithmetic.
inline bool in_order(const MovingShape& A, const MovingShape& B) {
  const int shapes = A.shape.compare(B.shape);
  return shapes != 0 ? shapes < 0 : A.X_WS.compare(B.X_WS) <= 0;
}

/// How the centres of two shapes move against each other.
inline ConstantRatePair motion_of(const MovingShape& A, const MovingShape& B, double resolution) {
  return {A.X_WS, B.X_WS, A.shape.hierarchy().centre, B.shape.hierarchy().centre, resolution};
}

}  // namespace firstcontact::detail
