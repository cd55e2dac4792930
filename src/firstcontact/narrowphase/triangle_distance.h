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
/// They always lie on the triangles: `distance` is an upper bound of the true distance up to a few
/// units in the last place of the coordinates. So it is for every shape of the triangles: needles,
/// points, parallel, coplanar and piercing ones.
///
/// Least over the nine pairs of edges and the six projections of a corner into a face; a pair that
/// none of these decides pierces, which is tested by itself. Coordinates and sizes between 1e-70
/// and 1e70 are meant: beyond, products overflow, and `distance` may be too large.
FIRSTCONTACT_API ClosestFeatures triangle_distance(const Triangle& A, const Triangle& B);

/// Up to 21 feature pairs: nine of edges, six of a corner and a face, six piercings.
struct FeaturePairs {
  std::array<ClosestFeatures, 21> pairs;
  std::size_t count = 0;
};

/// Finds all elementary pairs within `band` [m]; of those with the same features the nearest.
///
/// Each has the features in whose interiors its closest points lie.
///
/// @param features_A,features_B  which corners (bits 0 to 2) and edges (bits 3 to 5) are asked; all
///                               faces are
FIRSTCONTACT_API FeaturePairs feature_pairs_within(const Triangle& A, const Triangle& B,
                                                   double band, unsigned features_A = 0x3f,
                                                   unsigned features_B = 0x3f);

}  // namespace firstcontact
