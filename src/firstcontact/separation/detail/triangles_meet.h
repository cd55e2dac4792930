/// @file
/// The verifier's own proof that two triangles have a point in common.

#pragma once

#include <array>

#include <firstcontact/math/interval_vector.h>

namespace firstcontact::detail {

using IntervalTriangle = std::array<IntervalVector3, 3>;

/// Whether an edge of one triangle surely passes through the inside of the other one.
///
/// True is proven for all members of the intervals. False proves nothing: degenerate and coplanar
/// triangles that meet give false, too.
[[nodiscard]] bool triangles_meet(const IntervalTriangle& A, const IntervalTriangle& B);

}  // namespace firstcontact::detail
