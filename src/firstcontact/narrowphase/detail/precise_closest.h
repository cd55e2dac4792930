/// @file
/// The closest points of two features of few corners, in double-double.

#pragma once

#include <array>
#include <cstddef>

#include <firstcontact/math/double_double.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact::detail {

struct PreciseCorners {
  std::array<DoubleDoubleVector3, 3> p;  ///< [m]
  std::size_t count = 3;                 ///< A point has 1, an edge 2.
};

struct PreciseClosest {
  DoubleDoubleVector3 d;  ///< [m]  From a point of A to one of B.
  DoubleDouble square;    ///< [m^2]  Of its length.
  TriangleFeature feature_A;
  TriangleFeature feature_B;
};

/// Closest points as triangle_distance() finds them: nine pairs of edges, six corners over a face,
/// edges through a face. They always lie on the features, so that |d| bounds the distance from
/// above but for the rounding of differences.
[[nodiscard]] PreciseClosest precise_closest(const PreciseCorners& A, const PreciseCorners& B);

/// As separating_direction(): the one that the closest features define, of any length.
[[nodiscard]] DoubleDoubleVector3 precise_direction(const PreciseCorners& A,
                                                    const PreciseCorners& B,
                                                    const PreciseClosest& closest);

/// The way along an edge.
inline DoubleDoubleVector3 edge_of(const PreciseCorners& c, int from) {
  const auto i = static_cast<std::size_t>(from);
  return c.p[(i + 1) % c.count] - c.p[i];
}

}  // namespace firstcontact::detail
