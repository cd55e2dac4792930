/// @file
/// A shape: what a body is made of, ready for queries.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

struct FeatureTable;
struct GlidingSurface;
struct Hierarchy;
struct ShapeBounds;

/// Whether the space that a closed mesh encloses belongs to the shape.
enum class Filling { surface, solid };

/// Its words in files and in Python, in this order.
inline constexpr std::array<const char*, 2> kFillingWords{"surface", "solid"};

/// A union of simplices thickened by a radius, with its bounding-volume hierarchy.
///
/// Of a solid every point belongs to it around which the triangles wind other than zero times:
/// a cavity, bounded by triangles that face into it, is outside.
///
/// Immutable and cheap to copy: copies share their data, also between threads.
class FIRSTCONTACT_API Shape {
 public:
  /// Builds the hierarchy, in parallel for large meshes; the same on every run.
  ///
  /// @param mesh     [m]  at least one triangle, all of it finite; welding is the caller's choice
  /// @param radius   [m]  thickens every simplex; >= 0
  /// @param filling  a solid needs a closed mesh whose triangles agree on their inner side
  /// @param enclosure_error  [m]  see enclosure_error(); >= 0
  /// @throws std::invalid_argument on an empty mesh, a non-finite vertex or radius, a negative
  ///         radius, an index out of range, a solid whose mesh is not closed (names the defect)
  explicit Shape(Mesh mesh, double radius = 0.0, Filling filling = Filling::surface,
                 double enclosure_error = 0.0);

  /// The same shape while its vertices move on lines, each with a velocity of its own, as seen from
  /// a body frame that moves by `translation`: vertex i is at (1 - t) mesh().vertices[i] +
  /// t (to[i] - translation) in that frame. move_vertices() chooses the translation.
  ///
  /// What a solid contains follows its surface.
  ///
  /// @param to           [m]  one for each vertex of the mesh, in world axes as the vertices are
  /// @param translation  [m]  of the body frame over the step; what all vertices have in common
  /// @throws std::invalid_argument if there are not as many as vertices, one is not finite or
  ///         beyond 1e60 m, or the shape encloses a curved body, which its triangles would no
  ///         longer
  [[nodiscard]] Shape deforming(std::span<const Eigen::Vector3d> to,
                                const Eigen::Vector3d& translation = Eigen::Vector3d::Zero()) const;

  [[nodiscard]] const Mesh& mesh() const;  ///< At t = 0.
  /// [m]  As deforming() was given them; empty, and zero, where the shape does not deform.
  [[nodiscard]] std::span<const Eigen::Vector3d> vertices_to() const;
  [[nodiscard]] const Eigen::Vector3d& translation_to() const;
  [[nodiscard]] double radius() const;  ///< [m]
  [[nodiscard]] bool is_solid() const;

  /// [m]  Where the triangles enclose a curved body from outside: no point of theirs is farther
  /// from that body. 0 where the shape is what it says.
  [[nodiscard]] double enclosure_error() const;

  /// One vertex of each set of triangles joined by shared vertices; indices into
  /// hierarchy().vertices.
  [[nodiscard]] std::span<const std::uint32_t> component_vertices() const;

  [[nodiscard]] std::size_t edge_count() const;

  /// The two vertices of an edge, smaller index first. A degenerate triangle's repeated corner
  /// makes no edge.
  [[nodiscard]] std::array<std::uint32_t, 2> edge(std::size_t index) const;

  /// The unique edge that joins two vertices of one triangle.
  [[nodiscard]] std::uint32_t edge_index(std::uint32_t vertex, std::uint32_t other) const;

  [[nodiscard]] const Hierarchy& hierarchy() const;

  /// Of each triangle, in the order of the hierarchy, the features that none before it has, so that
  /// each counts once: bit k its corner k, bit 3 + k its edge from there; all of a degenerate one
  /// whose corners repeat. Found when they are first asked for.
  [[nodiscard]] std::span<const std::uint8_t> own_features() const;

  /// The same features with all that pairing them needs, of a shape of few triangles
  /// (FeatureTable::kMostTriangles). Made when it is first asked for.
  [[nodiscard]] const FeatureTable& feature_table() const;

  /// A box and a polytope around the triangles, found when they are first asked for. Of a shape
  /// that does not deform.
  [[nodiscard]] const ShapeBounds& bounds() const;

  /// The screw along which the surface glides on itself, and its bounds there; null where there is
  /// none. Found when it is first asked for. Of a shape that does not deform.
  [[nodiscard]] const GlidingSurface* gliding() const;

  /// A total order by content (up to hash collisions), so that queries can put two bodies in an
  /// order of their own and answer alike for A and B swapped. Negative, zero or positive.
  [[nodiscard]] int compare(const Shape& other) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace firstcontact
