/// @file
/// The order in which two bodies are treated, and their relative motion.

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

/// The relative motion of the centres of two shapes.
inline ConstantRatePair motion_of(const MovingShape& A, const MovingShape& B, double resolution) {
  return {A.X_WS, B.X_WS, A.shape.hierarchy().centre, B.shape.hierarchy().centre, resolution};
}

}  // namespace firstcontact::detail
