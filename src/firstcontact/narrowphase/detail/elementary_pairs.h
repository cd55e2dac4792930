/// @file
/// The pairs of features that decide the distance of two triangles, all at once on vector units.
///
/// They are nine pairs of edges, and six corners over the other triangle's face.

#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact::detail {

/// The squares of distances of all elementary pairs.
///
/// The nearest pair cannot be foreseen, so that nothing here branches. Values are within a few
/// roundings of those of their points. These points lie on the triangles.
struct ElementaryPairs {
  static constexpr std::size_t kStride = 4;  // Three, and a fourth that repeats the third.
  static constexpr double kNone = std::numeric_limits<double>::max();

  /// Edge i of A and edge j of B at [kStride i + j].
  struct Edges {
    alignas(32) std::array<double, 3 * kStride> square;  // [m^2]  Square of the distance.
    std::array<double, 3 * kStride> s;                   // [-]  Place on A's edge.
    std::array<double, 3 * kStride> t;                   // [-]  Place on B's edge.
  };

  /// The corners of one triangle S over the face of the other one, T.
  ///
  /// A foot is T[0] + u (T[1] - T[0]) + v (T[2] - T[0]).
  struct Corners {
    alignas(32) std::array<double, kStride> square;  // [m^2]  Square of the distance; kNone where
                                                     // the foot is not inside.
    std::array<double, kStride> u;                   // [-]
    std::array<double, kStride> v;                   // [-]
    std::array<double, kStride> height;              // Height over T's plane, in any unit.
  };

  Edges edges;
  std::array<Corners, 2> corners;  // A's corners over B's face, then B's over A's.

  /// The index of the least square, up to 2^-47 of it.
  ///
  /// It is one among those of edges, or 12 + k and 16 + k for corner k of A and of B.
  int nearest;
};

void find_elementary_pairs(const Triangle& A, const Triangle& B, ElementaryPairs& pairs);

}  // namespace firstcontact::detail
