/// @file
/// Which features of a mesh lie around an edge or a vertex.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/contact.h>

namespace firstcontact::detail {

/// Tells contacts at which a surface bulges towards the other body from those at which a
/// neighbouring feature is nearer: a corner that slides over a flat edge between two triangles
/// touches none but the one below it.
class SurfaceNeighbours {
 public:
  explicit SurfaceNeighbours(const Shape& shape);

  /// Whether no neighbour of the feature reaches farther along the direction than the feature does.
  ///
  /// @param direction_B  [-]  unit, body axes: from the feature to the other body
  [[nodiscard]] bool is_outermost(const Feature& feature, const Eigen::Vector3d& direction_B) const;

 private:
  /// Unit directions from each feature into its neighbours: of an edge into its faces, of a vertex
  /// along its edges.
  struct Directions {
    std::vector<std::uint32_t> first;  // Of feature k: first[k] to first[k + 1].
    std::vector<Eigen::Vector3d> directions;
  };
  [[nodiscard]] static bool is_outermost(const Directions& of, std::uint32_t index,
                                         const Eigen::Vector3d& direction_B);

  Directions edges_;
  Directions vertices_;
};

}  // namespace firstcontact::detail
