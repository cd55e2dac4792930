/// @file
/// Distance of two triangles, and the features that are close.

#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/math/export.h>

namespace firstcontact {

using Triangle = std::array<Eigen::Vector3d, 3>;  ///< Corners; may coincide or be collinear.

/// A feature of one triangle: corner k, edge from corner k to corner k + 1 (mod 3), or the face.
struct TriangleFeature {
  enum class Type { vertex, edge, face };
  Type type = Type::vertex;
  int index = 0;

  friend bool operator==(const TriangleFeature&, const TriangleFeature&) = default;
};

/// A point of each triangle, and the features in whose interiors they lie.
///
/// The active constraint decides the class, never a tolerance.
struct ClosestFeatures {
  double distance = 0.0;  ///< [m]  |p_B - p_A|, up to rounding; 0 where the triangles pierce.
  Eigen::Vector3d p_A = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_B = Eigen::Vector3d::Zero();
  TriangleFeature feature_A;
  TriangleFeature feature_B;
};

/// Finds the closest points of two triangles.
///
/// Both points always lie on the triangles. So `distance` is an upper bound of the true distance,
/// up to a few units in the last place of the coordinates. That holds for every shape of the
/// triangles: needles, points, parallel, coplanar and piercing ones.
///
/// Method: the least distance over the nine pairs of edges and the six projections of a corner into
/// a face. Piercing is tested by itself. Coordinates and sizes are meant to be between 1e-70 and
/// 1e70. Beyond, products overflow, and `distance` may be too large.
FIRSTCONTACT_API ClosestFeatures triangle_distance(const Triangle& A, const Triangle& B);

/// Up to 33 feature pairs: nine of edges, six of a corner and a face, six piercings, twelve of the
/// ends of needles.
struct FeaturePairs {
  std::array<ClosestFeatures, 33> pairs;
  std::size_t count = 0;
};

/// Finds all elementary pairs within `band` [m]; for the same two features the nearest pair.
///
/// Each has the features in whose interiors its closest points lie. The far end of an edge is there
/// through the next edge, which leads away from it. A triangle whose corners are on one line has no
/// such edge: both of its ends are tested against the edges of the other.
///
/// @param features_A,features_B  bits of the corners (0 to 2) and edges (3 to 5) that may be part
///                               of a pair; faces always may
FIRSTCONTACT_API FeaturePairs feature_pairs_within(const Triangle& A, const Triangle& B,
                                                   double band, unsigned features_A = 0x3f,
                                                   unsigned features_B = 0x3f);

}  // namespace firstcontact
