/// @file
/// The geometry of a body, ready for queries.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

class ConvexSet;
struct ConvexCore;
struct FeatureTable;
struct ScrewSlidingSurface;
struct Hierarchy;
struct ShapeBounds;

/// Whether the space that a closed mesh encloses belongs to the shape.
enum class Filling { surface, solid };

/// The words of `Filling` in files and in Python, in its order.
inline constexpr std::array<const char*, 2> kFillingWords{"surface", "solid"};

/// A union of simplices thickened by a radius, with its bounding-volume hierarchy.
///
/// A point belongs to a solid where the winding number of the triangles around it is not zero. A
/// cavity, bounded by triangles that face into it, is outside.
///
/// Immutable and cheap to copy: copies share their data, also between threads.
class FIRSTCONTACT_API Shape {
 public:
  /// Builds the hierarchy, in parallel for large meshes; the same on every run.
  ///
  /// @param mesh     [m]  at least one triangle, all finite; welding is the caller's choice
  /// @param radius   [m]  thickens every simplex; >= 0
  /// @param filling  a solid needs a closed mesh whose triangles agree on their inner side
  /// @param enclosure_error  [m]  see enclosure_error(); >= 0
  /// @throws std::invalid_argument on an empty mesh, a non-finite vertex or radius, a negative
  ///         radius, an index out of range, a solid whose mesh is not closed (names the defect)
  explicit Shape(Mesh mesh, double radius = 0.0, Filling filling = Filling::surface,
                 double enclosure_error = 0.0);

  /// Makes a shape that is a convex set, exactly; the mesh is the same set, or encloses it.
  ///
  /// First contact, distance and closest approach take the set in place of the triangles where the
  /// mesh only encloses it (is_curved()). They do the same for the partner in a pair with such a
  /// shape.
  ///
  /// @param mesh             [m]  as above; the mesh of the core of the set, closed where that is
  /// solid
  /// @param enclosure_error  [m]  see enclosure_error(); 0 where the mesh is exact
  /// @param set              its rounding is the radius of the shape
  Shape(Mesh mesh, Filling filling, double enclosure_error, const ConvexSet& set);

  /// Makes the same shape with vertices that move on lines, each with a velocity of its own.
  ///
  /// In a body frame that moves by `translation`, vertex i is at
  ///   (1 - t) mesh().vertices[i] + t (to[i] - translation).
  /// move_vertices() chooses the translation. The inside of a solid follows its surface.
  ///
  /// @param to           [m]  one for each vertex of the mesh, in world axes as the vertices are
  /// @param translation  [m]  of the body frame over the step: the motion that all vertices share
  /// @throws std::invalid_argument if there are not as many as vertices, or one is not finite or
  /// beyond 1e60 m; or if the shape encloses a curved body, as its triangles would enclose it no
  /// longer
  [[nodiscard]] Shape deforming(std::span<const Eigen::Vector3d> to,
                                const Eigen::Vector3d& translation = Eigen::Vector3d::Zero()) const;

  [[nodiscard]] const Mesh& mesh() const;  ///< The mesh at t = 0.
  /// [m]  The argument `to` of deforming(); empty where the shape does not deform.
  [[nodiscard]] std::span<const Eigen::Vector3d> vertices_to() const;
  /// [m]  The argument `translation` of deforming(); zero where the shape does not deform.
  [[nodiscard]] const Eigen::Vector3d& translation_to() const;
  [[nodiscard]] double radius() const;  ///< [m]
  [[nodiscard]] bool is_solid() const;

  /// [m]  A bound of the distance of any point of the triangles from the curved body that they
  /// enclose.
  ///
  /// 0 where the triangles are exact. Queries that take the curved body itself (convex_set()) add
  /// it to nothing.
  [[nodiscard]] double enclosure_error() const;

  /// The convex set that is exactly the shape, in the body frame; null where none is known.
  [[nodiscard]] const ConvexSet* convex_set() const;

  /// Whether the shape is a convex set that its triangles only enclose, to within
  /// enclosure_error(): a cylinder, a cone, an ellipsoid.
  [[nodiscard]] bool is_curved() const;

  /// The core of the convex set, its origin at hierarchy().centre; refers to this shape.
  ///
  /// Only for a shape that has a set. A hull takes hierarchy().vertices as they are.
  [[nodiscard]] ConvexCore convex_core() const;

  /// A single box around the core of the convex set, about the same centre as hierarchy().
  ///
  /// Only for a shape that has a set. Computed when first needed.
  [[nodiscard]] const Hierarchy& convex_hierarchy() const;

  /// Makes the shape of the triangles alone, without a convex set.
  ///
  /// It shares their hierarchy. Where the set is curved, the triangles are a little larger.
  [[nodiscard]] Shape as_triangles() const;

  /// The component representatives: one vertex of each set of triangles joined by shared vertices,
  /// as indices into hierarchy().vertices.
  [[nodiscard]] std::span<const std::uint32_t> component_vertices() const;

  [[nodiscard]] std::size_t edge_count() const;

  /// The two vertices of an edge, smaller index first. A degenerate triangle's repeated corner
  /// makes no edge.
  [[nodiscard]] std::array<std::uint32_t, 2> edge(std::size_t index) const;

  /// The unique edge that joins two vertices of one triangle.
  [[nodiscard]] std::uint32_t edge_index(std::uint32_t vertex, std::uint32_t other) const;

  [[nodiscard]] const Hierarchy& hierarchy() const;

  /// The own features of each triangle: those that no triangle before it has, in the order of the
  /// hierarchy.
  ///
  /// So each feature counts once. Bit k of a triangle is its corner k, bit 3 + k the edge that
  /// begins at corner k. A degenerate triangle whose corners repeat has all of them. Computed when
  /// first needed.
  [[nodiscard]] std::span<const std::uint8_t> own_features() const;

  /// The table of the own features with all that pairing them needs; computed when first needed.
  ///
  /// Only for a shape of few triangles (FeatureTable::kMostTriangles).
  [[nodiscard]] const FeatureTable& feature_table() const;

  /// A box and a polytope around the triangles, at all times of the step; computed when first
  /// needed.
  [[nodiscard]] const ShapeBounds& bounds() const;

  /// The screw along which the surface slides in itself, with its bounds there; null where no screw
  /// does so.
  ///
  /// Only for a shape that does not deform. Computed when first needed.
  [[nodiscard]] const ScrewSlidingSurface* screw_sliding() const;

  /// Compares two shapes by content: negative, zero or positive, a total order up to hash
  /// collisions.
  ///
  /// By this order queries sort two bodies, and so answer alike for A and B swapped.
  [[nodiscard]] int compare(const Shape& other) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace firstcontact
