/// @file
/// A hierarchy of oriented boxes over the triangles of a mesh.

#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Four boxes, each around one child: a node, or a single triangle. Two cache lines.
///
/// Box k has the centre c, the axes R(q) with q = (sqrt(1 - |v|^2), v) exactly, and the half
/// extents h, the longest last. It contains its triangles exactly, all roundings outward.
/// Coordinates are relative to Hierarchy::centre, in units of Hierarchy::unit.
struct alignas(64) HierarchyNode {
  static constexpr int kWidth = 4;
  /// Extents have 6 bits of exponent and 10 of mantissa: (code << shift) + origin is a float's
  /// code.
  static constexpr int kExtentShift = 13;
  static constexpr std::uint32_t kExtentOrigin = 65u << 23;

  float centre[3][kWidth];    ///< [unit]  Centres.
  float rotation[3][kWidth];  ///< [-]  Vector part v of the unit quaternion, |v|^2 <= 0.58.
  /// [unit]  Codes of half extents, rounded up; see half_extent().
  std::uint16_t extent[3][kWidth];
  std::uint32_t node_base_and_used;  ///< Index of the first child node << 4 | mask of used slots.
  std::uint32_t triangle_base_and_leaf;  ///< First child triangle << 4 | mask of triangle slots.

  /// [unit]  The half extent of a box along one of its axes.
  [[nodiscard]] float half_extent(int axis, int slot) const {
    const auto code = static_cast<std::uint32_t>(extent[axis][slot]);
    return std::bit_cast<float>((code << kExtentShift) + kExtentOrigin);
  }
  /// The code of the least extent that can be stored, at or above a value below 2.
  FIRSTCONTACT_API static std::uint16_t extent_code(double value);

  [[nodiscard]] unsigned used() const { return node_base_and_used & 15u; }
  [[nodiscard]] unsigned leaves() const { return triangle_base_and_leaf & 15u; }
  [[nodiscard]] bool is_leaf(int slot) const { return (leaves() >> slot & 1u) != 0; }
  [[nodiscard]] std::uint32_t child_node(int slot) const {
    return (node_base_and_used >> 4) + rank(used() & ~leaves(), slot);
  }
  [[nodiscard]] std::uint32_t child_triangle(int slot) const {
    return (triangle_base_and_leaf >> 4) + rank(leaves(), slot);
  }

 private:
  /// Counts the slots of a mask before a given one. Not every processor can count bits, so the
  /// number of bits of each k < 16 is digit k of a constant.
  static std::uint32_t rank(unsigned mask, int slot) {
    constexpr std::uint64_t kBits = 0x4332322132212110u;
    return static_cast<std::uint32_t>(kBits >> (4 * (mask & ((1u << slot) - 1u)))) & 15u;
  }
};
static_assert(sizeof(HierarchyNode) == 128);

/// The hierarchy, with the mesh's vertices and triangles in its own order for locality.
struct Hierarchy {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  Centre, in the body frame.
  double radius = 0.0;  ///< [m]  Bound of every vertex's distance from the centre, at all times.
  double unit = 1.0;    ///< [m]  A power of two, at least the radius.
  std::vector<HierarchyNode> nodes;                     ///< The root is the first.
  std::vector<Eigen::Vector3d> vertices;                ///< [m]  Relative to the centre, rounded.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into vertices.
  std::vector<std::uint32_t> vertex_index;              ///< Index in the mesh of each vertex.
  std::vector<std::uint32_t> triangle_index;            ///< Index in the mesh of each triangle.

  /// The boxes at t = 1 of a body that deforms, with the same links and axes; empty where the body
  /// is rigid.
  ///
  /// These boxes and `vertices_to` are relative to the centre at t = 1. In between, centres,
  /// extents and vertices change linearly.
  std::vector<HierarchyNode> nodes_to;
  std::vector<Eigen::Vector3d> vertices_to;  ///< [m]  Places of the vertices at t = 1.
  /// [m per step]  Bound of every vertex's speed relative to the centre.
  double deformation_speed = 0.0;

  [[nodiscard]] bool deforms() const { return !vertices_to.empty(); }

  /// [m]  The place of a vertex at t, relative to the centre; within 2^-51 of the radius where the
  /// body deforms.
  [[nodiscard]] Eigen::Vector3d vertex(std::uint32_t index, double t) const {
    return deforms() ? Eigen::Vector3d((1.0 - t) * vertices[index] + t * vertices_to[index])
                     : vertices[index];
  }

  /// Computes the boxes of a node at t; where they change, `scratch` holds them.
  ///
  /// An interpolated box contains its triangles. Derivation: take the distances of a vertex from
  /// the centre along an axis of the box, at both ends. Their interpolation bounds the distance
  /// from the interpolated centre.
  FIRSTCONTACT_API const HierarchyNode& node(std::uint32_t index, double t,
                                             HierarchyNode& scratch) const;
};

/// Builds the hierarchy top-down, on all cores for large meshes; the same on every run.
///
/// Boxes follow the principal axes of their vertices, and are improved over a few candidates. S.
/// Gottschalk, M. C. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996, fit the convex hull instead.
///
/// @param mesh  not empty, finite, indices in range, below 2^28 triangles
FIRSTCONTACT_API Hierarchy build_hierarchy(const Mesh& mesh);

/// Makes the hierarchy of the same triangles while their vertices move to other places, each on a
/// line.
///
/// @param rest  the hierarchy of a body that does not deform
/// @param to    [m]  for each of its vertices, in its order, the place at t = 1 relative to the
///         centre at t = 1
FIRSTCONTACT_API Hierarchy deforming_hierarchy(const Hierarchy& rest,
                                               std::vector<Eigen::Vector3d> to);

/// The axes of box `slot`, one per row, to double precision (error below 2^-50).
FIRSTCONTACT_API Eigen::Matrix3d box_axes(const HierarchyNode& node, int slot);

}  // namespace firstcontact
