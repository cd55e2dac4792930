/// @file
/// Cuts a polygon in space into triangles inside of it.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

/// A polygon: its outer ring, then its holes, as numbers of vertices.
struct PolygonRings {
  std::span<const std::uint32_t> corners;      ///< Of all rings, one after the other.
  std::span<const std::uint32_t> hole_begins;  ///< Where each hole begins in `corners`.
};

/// How a polygon was cut.
struct PolygonCut {
  /// The fan about the first corner is right; `triangles` is empty.
  bool is_fan = true;
  bool is_concave = false;  ///< The outer ring, as seen along the axis nearest to its normal.
  /// No triangulation is right: the rings cross, or fold over in their plane. `triangles` is empty.
  bool crosses = false;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Cuts a polygon of at least four corners, or with holes. Orientation is that of the outer ring;
/// holes may have either.
///
/// The polygon is cut as it appears along the coordinate axis nearest to its normal (M. E. Newell;
/// I. E. Sutherland, R. F. Sproull, R. A. Schumacker, "A characterization of ten hidden-surface
/// algorithms", ACM Computing Surveys 6 (1974)); for a planar polygon this is exact. The fan about
/// the first corner is taken wherever it is right, which is so for every convex polygon.
/// Otherwise see triangulate_rings().
///
/// @param vertices  n points; finite
/// @param polygon   numbers below n
[[nodiscard]] PolygonCut cut_polygon(std::span<const Eigen::Vector3d> vertices,
                                     const PolygonRings& polygon);

/// Whether a polygon is certainly convex, as seen along its normal; then its fan is right.
/// Quick, and false where rounding leaves it open.
///
/// @param normal  of newell_normal()
[[nodiscard]] bool is_plainly_convex(std::span<const Eigen::Vector3d> vertices,
                                     std::span<const std::uint32_t> corners,
                                     const Eigen::Vector3d& normal);

/// A vector along the normal of a ring, twice its area long [m^2], rounded.
[[nodiscard]] Eigen::Vector3d newell_normal(std::span<const Eigen::Vector3d> vertices,
                                            std::span<const std::uint32_t> corners);

/// [m]  The thickness of a ring's corners along its normal, less than what rounding can account
/// for.
///
/// Two ways to cut the ring are no farther apart along the normal, and those of a quadrilateral so
/// far.
[[nodiscard]] double deviation_from_plane(std::span<const Eigen::Vector3d> vertices,
                                          std::span<const std::uint32_t> corners,
                                          const Eigen::Vector3d& normal);

}  // namespace firstcontact::detail
