/// @file
/// Queries of a corner and a face, or of two edges, whose corners move on lines. The queries are
/// nearly degenerate, with exact coordinates of a size of about 1. Their kinds follow B. Wang, Z.
/// Ferguson, T. Schneider, X. Jiang, M. Attene, D. Panozzo, "A large-scale benchmark and an
/// inclusion-based algorithm for continuous collision detection", ACM Trans. Graph. 40 (2021).

#pragma once

#include <array>
#include <cstdint>

#include "support/first_contact_oracle.h"
#include "support/moving_soup.h"

namespace firstcontact::oracle {

enum class LinearFamily {
  crossing,  ///< Features meet well inside, at any time.
  passing,   ///< One feature crosses beside the other's end or side, by a gap.
  grazing,   ///< A feature comes as near as a gap and turns back, over one that tilts.
  coplanar,  ///< All corners stay in one plane.
  parallel,  ///< Edges, or an edge and the path of a corner, stay parallel.
  at_end,    ///< Features are nearest at t = 0 or 1.
  carried,   ///< All corners have one velocity, at a gap.
  thin,      ///< Features in layers so near a coordinate plane that doubles hold gaps of 1e-18.
  tilting,   ///< A feature tilts at a gap that stays.
};
inline constexpr int kLinearFamilies = static_cast<int>(LinearFamily::tilting) + 1;

/// Fact about a query that is known from its construction.
enum class BuiltIn { nothing, touch, gap };

struct LinearQuery {
  bool edges = false;
  std::array<Vector3<double>, 4> from;  ///< Positions of the face and the vertex, or of A's ends
                                        ///< and B's.
  std::array<Vector3<double>, 4> to;
  BuiltIn built_in = BuiltIn::nothing;
  double least_distance = 0.0;  ///< [m]  Lower bound of a gap that was built in.
};

/// Makes a query; the same numbers give the same query on every platform.
///
/// Gaps are 0 or from 1e-18 to 1e-10, of either sign; rounding to doubles adds its own error.
[[nodiscard]] LinearQuery linear_query(LinearFamily family, std::uint64_t seed);

/// True answer of a query: the fact that was built in, or else the oracle's proof.
///
/// The oracle needs too many windows where a tiny gap lasts, as it does while features graze or
/// tilt.
struct LinearTruth {
  bool touches = false;   ///< Proven: as near as 1e-20 of the size.
  bool is_apart = false;  ///< Proven: farther apart than the tolerance, always.
  double t = 0.0;         ///< [-]  Upper bound of the first contact, where it touches.
};
[[nodiscard]] LinearTruth linear_truth(const LinearQuery& query, double tolerance);

/// Makes two soups of one triangle each; a triangle is degenerate unless it is a face.
[[nodiscard]] std::array<MovingSoup, 2> soups_of(const LinearQuery& query);

}  // namespace firstcontact::oracle
