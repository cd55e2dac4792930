/// @file
/// A shape: what a body is made of, ready for queries.

#pragma once

#include <cstddef>
#include <memory>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

namespace detail {
struct ShapeData;
}

/// A union of simplices thickened by a radius, with its bounding-volume hierarchy.
/// Immutable and cheap to copy: copies share their data, also between threads.
class FIRSTCONTACT_API Shape {
 public:
  /// Builds the hierarchy, in parallel for large meshes; the same on every run.
  ///
  /// @param mesh    [m]  at least one triangle, all of it finite; welding is the caller's choice
  /// @param radius  [m]  thickens every simplex; >= 0
  /// @throws std::invalid_argument on an empty mesh, a non-finite vertex or radius, a negative
  ///         radius, an index out of range
  explicit Shape(Mesh mesh, double radius = 0.0);

  [[nodiscard]] const Mesh& mesh() const;
  [[nodiscard]] double radius() const;  ///< [m]
  [[nodiscard]] std::size_t edge_count() const;

  /// The two vertices of an edge, smaller index first. A degenerate triangle's repeated corner
  /// makes no edge.
  [[nodiscard]] std::array<std::uint32_t, 2> edge(std::size_t index) const;

  [[nodiscard]] const detail::ShapeData& data() const { return *data_; }

 private:
  std::shared_ptr<const detail::ShapeData> data_;
};

}  // namespace firstcontact
