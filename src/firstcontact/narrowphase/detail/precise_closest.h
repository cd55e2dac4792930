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
  std::size_t count = 3;                 ///< Number of corners; a point has 1, an edge 2.
};

struct PreciseClosest {
  DoubleDoubleVector3 d;  ///< [m]  Vector from a point of A to one of B.
  DoubleDouble square;    ///< [m^2]  Square of its length.
  TriangleFeature feature_A;
  TriangleFeature feature_B;
};

/// The closest points as triangle_distance() finds them: nine pairs of edges, six corners over a
/// face, edges through a face.
///
/// The points always lie on the features. So |d| bounds the distance from above, up to the rounding
/// of differences.
[[nodiscard]] PreciseClosest precise_closest(const PreciseCorners& A, const PreciseCorners& B);

/// The direction that the closest features define, of any length, as separating_direction() has it.
[[nodiscard]] DoubleDoubleVector3 precise_direction(const PreciseCorners& A,
                                                    const PreciseCorners& B,
                                                    const PreciseClosest& closest);

/// The vector along an edge.
inline DoubleDoubleVector3 edge_of(const PreciseCorners& c, int from) {
  const auto i = static_cast<std::size_t>(from);
  return c.p[(i + 1) % c.count] - c.p[i];
}

}  // namespace firstcontact::detail
