/// @file
/// Directions along which two triangles may be apart.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/math/export.h>
#include <firstcontact/narrowphase/advance.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {

/// The direction that the closest features define, of any length and either sign.
///
/// It is the normal of a face, or the product of two edges. For an edge and a corner it is the part
/// of p_B - p_A across the edge. For two corners it is p_B - p_A. Unlike p_B - p_A the first three
/// stay accurate where the points nearly coincide.
[[nodiscard]] FIRSTCONTACT_API Eigen::Vector3d separating_direction(const TrianglePair& pair,
                                                                    const ClosestFeatures& closest);

/// Calls use(n) for each normal of a plane that may separate two triangles.
///
/// These are both face normals, the nine products of edges and, for coplanar triangles, the six
/// normals of edges within their face. Each has any length, zero where degenerate.
template <class Use>
void for_each_plane_normal(const TrianglePair& pair, const Use& use) {
  const auto edge = [](const Triangle& T, int k) { return Eigen::Vector3d(T[(k + 1) % 3] - T[k]); };
  for (const Triangle* T : {&pair.A, &pair.B}) {
    const Eigen::Vector3d normal = edge(*T, 0).cross(edge(*T, 1));
    use(normal);
    for (int k = 0; k < 3; ++k) {
      use(Eigen::Vector3d(normal.cross(edge(*T, k))));
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      use(Eigen::Vector3d(edge(pair.A, i).cross(edge(pair.B, j))));
    }
  }
}

}  // namespace firstcontact
