/// @file
/// Queries of a corner and a face, or of two edges, whose corners move on lines: nearly degenerate
/// ones, with exact coordinates of a size of about 1. After the kinds of B. Wang, Z. Ferguson, T.
/// Schneider, X. Jiang, M. Attene, D. Panozzo, "A large-scale benchmark and an inclusion-based
/// algorithm for continuous collision detection", ACM Trans. Graph. 40 (2021).

#pragma once

#include <array>
#include <cstdint>

#include "support/first_contact_oracle.h"
#include "support/moving_soup.h"

namespace firstcontact::oracle {

enum class LinearFamily {
  crossing,  ///< Features meet well inside, at any time.
  passing,   ///< One crosses beside the other's end or side, by a gap.
  grazing,   ///< Comes as near as a gap and turns back, over a feature that tilts.
  coplanar,  ///< All stays in one plane.
  parallel,  ///< Edges, or an edge and the way of a corner, stay parallel.
  at_end,    ///< Nearest at t = 0 or 1.
  carried,   ///< One velocity for all, at a gap.
  thin,      ///< In layers so near a coordinate plane that doubles hold gaps of 1e-18.
  tilting,   ///< A feature tilts at a gap that stays.
};
inline constexpr int kLinearFamilies = static_cast<int>(LinearFamily::tilting) + 1;

/// What is known of a query from how it was made.
enum class BuiltIn { nothing, touch, gap };

struct LinearQuery {
  bool edges = false;
  std::array<Vector3<double>, 4> from;  ///< Face and vertex, or A's ends and B's.
  std::array<Vector3<double>, 4> to;
  BuiltIn built_in = BuiltIn::nothing;
  double least_distance = 0.0;  ///< Of a gap: a lower bound.
};

/// The same query for the same numbers on every platform. Gaps are 0 or from 1e-18 to 1e-10, of
/// either sign; rounding to doubles adds its own.
[[nodiscard]] LinearQuery linear_query(LinearFamily family, std::uint64_t seed);

/// What is true of a query: what is built in, or else what the oracle proves. Its windows are too
/// many where a tiny gap lasts, as it does while features graze or tilt.
struct LinearTruth {
  bool touches = false;   ///< Proven: as near as 1e-20 of the size.
  bool is_apart = false;  ///< Proven: farther apart than the tolerance, always.
  double t = 0.0;         ///< [-]  Upper bound of the first contact, where it touches.
};
[[nodiscard]] LinearTruth linear_truth(const LinearQuery& query, double tolerance);

/// Two soups of one triangle each, which are degenerate but for a face.
[[nodiscard]] std::array<MovingSoup, 2> soups_of(const LinearQuery& query);

}  // namespace firstcontact::oracle
