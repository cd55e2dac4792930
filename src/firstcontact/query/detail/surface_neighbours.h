/// @file
/// The features of a mesh around an edge or a vertex.

#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/contact.h>

namespace firstcontact::detail {

/// The distance by which a neighbour of a feature may reach farther than the feature.
struct NeighbourSlack {
  double beside = 0.0;  ///< [m]  >= 0  Of neighbours that are nearer than `far_from`.
  double far = 0.0;     ///< [m]  >= 0  Of the others.
  double far_from = std::numeric_limits<double>::infinity();  ///< [m]
};

/// How far a surface goes on straight around a feature.
enum class Extent {
  corner,  ///< In no direction.
  line,    ///< Along an edge.
  plane,   ///< In all directions of a flat face.
};

/// Separates contacts at which a surface bulges towards the other body from those with a nearer
/// neighbour.
/// A neighbour is a feature next to that of the contact. A corner that slides over a flat edge
/// between two triangles touches only the triangle below it.
class SurfaceNeighbours {
 public:
  /// @param slack  [m]  >= 0  Distance by which a neighbour may reach farther. So all corners of a
  ///               face that lies on another one touch, however it is tilted.
  SurfaceNeighbours(const Shape& shape, double slack)
      : SurfaceNeighbours(shape, NeighbourSlack{.beside = slack, .far = slack}) {}
  SurfaceNeighbours(const Shape& shape, const NeighbourSlack& slack);

  /// Whether no neighbour of the feature reaches farther along the direction than the feature does.
  ///
  /// @param direction_B  [-]  unit, body axes: from the feature to the other body
  [[nodiscard]] bool is_outermost(const Feature& feature, const Eigen::Vector3d& direction_B) const;

  /// How far the surface goes on straight around a feature. A vertex may be within a flat face or
  /// on a straight edge, as where a mesh is cut finer than it is shaped.
  [[nodiscard]] Extent extent(const Feature& feature) const;

  /// Whether the feature is an edge that divides a flat face.
  [[nodiscard]] bool is_flat_edge(const Feature& feature) const {
    return feature.type == FeatureType::edge && is_flat_[feature.index];
  }

  /// [m]  The distance around an edge or a vertex within which the surface is surely one flat face;
  /// 0 at a bend.
  [[nodiscard]] double flat_around(const Feature& feature) const;

  /// The index of a feature; all triangles of a flat face have one index.
  [[nodiscard]] std::uint32_t surface_index(const Feature& feature) const {
    return feature.type == FeatureType::face ? flat_face_[feature.index] : feature.index;
  }

  /// Calls use(vector) for the offsets [m] from an edge or a vertex to the ends of its neighbours.
  template <class Use>
  void for_each_offset(const Feature& feature, const Use& use) const {
    const OffsetRows& rows = feature.type == FeatureType::edge ? edges_ : vertices_;
    for (const Offset& offset : rows.of(feature.index)) {
      use(offset.vector);
    }
  }

 private:
  /// The vector from a feature to the end of a neighbour.
  struct Offset {
    Eigen::Vector3d vector;  // [m]
    double most;             // [m]  Most by which it may reach farther than the feature.
  };

  /// Offsets from each feature to the ends of its neighbours: from an edge across its faces, from a
  /// vertex along its edges.
  struct OffsetRows {
    std::vector<std::uint32_t> first;  // Row of feature k: first[k] to first[k + 1].
    std::vector<Offset> offsets;

    [[nodiscard]] std::span<const Offset> of(std::uint32_t feature) const {
      return {offsets.data() + first[feature], offsets.data() + first[feature + 1]};
    }
  };
  static bool none_is_farther(std::span<const Offset> offsets, const Eigen::Vector3d& direction_B);
  void find_flat_vertices(const Shape& shape);
  void find_straight_vertices(const Shape& shape);
  void find_flat_faces(const Shape& shape);

  std::vector<bool> is_flat_;             // For each edge.
  std::vector<bool> is_flat_vertex_;      // For each vertex: whether all of its edges are flat.
  std::vector<bool> is_straight_vertex_;  // Likewise, but for two that are one line.
  std::vector<std::uint32_t> flat_face_;  // For each triangle: the first one of its flat face.
  OffsetRows edges_;
  OffsetRows vertices_;
};

}  // namespace firstcontact::detail
