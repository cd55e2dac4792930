/// @file
/// Which features of a mesh lie around an edge or a vertex.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/contact.h>

namespace firstcontact::detail {

/// Separates contacts at which a surface bulges towards the other body from those with a nearer
/// neighbour.
///
/// A neighbour is a feature next to that of the contact: a corner that slides over a flat edge
/// between two triangles touches none but the one below it.
class SurfaceNeighbours {
 public:
  /// @param slack  [m]  >= 0  By so much may a neighbour reach farther: all corners of a face that
  ///               lies on another one touch, however it is tilted.
  SurfaceNeighbours(const Shape& shape, double slack);

  /// Whether no neighbour of the feature reaches farther along the direction than the feature does.
  ///
  /// @param direction_B  [-]  unit, body axes: from the feature to the other body
  [[nodiscard]] bool is_outermost(const Feature& feature, const Eigen::Vector3d& direction_B) const;

  /// Whether the feature is an edge that divides a flat face.
  [[nodiscard]] bool is_flat_edge(const Feature& feature) const {
    return feature.type == FeatureType::edge && is_flat_[feature.index];
  }

  /// [m]  How far around an edge or a vertex the surface is surely one flat face; 0: it bends
  /// there.
  [[nodiscard]] double flat_around(const Feature& feature) const;

  /// The index of a feature, but one index for all triangles of a flat face.
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
  /// From a feature to the end of a neighbour.
  struct Offset {
    Eigen::Vector3d vector;  // [m]
    double most;             // [m]  It may reach so much farther than the feature.
  };

  /// Offsets from each feature to the ends of its neighbours: of an edge across its faces, of a
  /// vertex along its edges.
  struct OffsetRows {
    std::vector<std::uint32_t> first;  // Of feature k: first[k] to first[k + 1].
    std::vector<Offset> offsets;

    [[nodiscard]] std::span<const Offset> of(std::uint32_t feature) const {
      return {offsets.data() + first[feature], offsets.data() + first[feature + 1]};
    }
  };
  static bool none_is_farther(std::span<const Offset> offsets, const Eigen::Vector3d& direction_B);
  void find_flat_vertices(const Shape& shape);
  void find_flat_faces(const Shape& shape);

  std::vector<bool> is_flat_;             // Of each edge.
  std::vector<bool> is_flat_vertex_;      // Whether all edges of each vertex are.
  std::vector<std::uint32_t> flat_face_;  // Of each triangle the first one of its flat face.
  OffsetRows edges_;
  OffsetRows vertices_;
};

}  // namespace firstcontact::detail
