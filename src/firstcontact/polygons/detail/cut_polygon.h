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
  std::span<const std::uint32_t> corners;      ///< Corners of all rings, one ring after the other.
  std::span<const std::uint32_t> hole_begins;  ///< Index in `corners` at which each hole begins.
};

/// The triangles of a polygon, and how they were found.
struct PolygonCut {
  /// Whether the fan about the first corner is right; `triangles` is then empty.
  bool is_fan = true;
  bool is_concave = false;  ///< Whether the outer ring is concave, as seen along the axis nearest
                            ///< to its normal.
  /// Whether no triangulation is right, as the rings cross, or fold over in their plane.
  ///
  /// `triangles` is then empty.
  bool crosses = false;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Cuts a polygon of at least four corners, or with holes.
///
/// Triangles have the orientation of the outer ring; holes may have either orientation. The polygon
/// is cut as seen along the coordinate axis nearest to its normal, which is exact for a planar
/// polygon. The fan about the first corner is taken wherever it is right, as it is for every convex
/// polygon. Otherwise see triangulate_rings().
///
/// Source: M. E. Newell's normal, after I. E. Sutherland, R. F. Sproull, R. A. Schumacker, "A
/// characterization of ten hidden-surface algorithms", ACM Computing Surveys 6 (1974).
///
/// @param vertices  n points; finite
/// @param polygon   numbers below n
[[nodiscard]] PolygonCut cut_polygon(std::span<const Eigen::Vector3d> vertices,
                                     const PolygonRings& polygon);

/// Whether a polygon is certainly convex, as seen along its normal; then its fan is right.
///
/// The test is quick, and false where rounding leaves the answer open.
///
/// @param normal  the result of newell_normal()
[[nodiscard]] bool is_plainly_convex(std::span<const Eigen::Vector3d> vertices,
                                     std::span<const std::uint32_t> corners,
                                     const Eigen::Vector3d& normal);

/// A vector along the normal of a ring, twice its area long [m^2], rounded.
[[nodiscard]] Eigen::Vector3d newell_normal(std::span<const Eigen::Vector3d> vertices,
                                            std::span<const std::uint32_t> corners);

/// [m]  The thickness of a ring's corners along its normal, less a bound of its rounding.
///
/// Two ways to cut the ring are no farther apart along the normal. Those of a quadrilateral are
/// exactly so far apart.
[[nodiscard]] double deviation_from_plane(std::span<const Eigen::Vector3d> vertices,
                                          std::span<const std::uint32_t> corners,
                                          const Eigen::Vector3d& normal);

}  // namespace firstcontact::detail
