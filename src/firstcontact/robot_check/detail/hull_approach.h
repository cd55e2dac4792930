/// @file
/// The approach of two convex hulls; a search for the contact of shapes begins after it.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/pair_motion.h>
#include <firstcontact/motion/time_window.h>

namespace firstcontact::detail {

/// The corners of a convex polytope around a shape.
struct HullCorners {
  /// [m]  From the centre of the shape's hierarchy; none where the shape deforms.
  std::vector<Eigen::Vector3d> points = {};
  /// The triangles at corner k, in the hierarchy's order, are triangles[first[k]] to
  /// triangles[first[k + 1] - 1]. A corner that is no vertex of the shape has none.
  std::vector<std::uint32_t> first = {};
  std::vector<std::uint32_t> triangles = {};

  [[nodiscard]] std::span<const std::uint32_t> triangles_at(std::size_t corner) const {
    return std::span(triangles).subspan(first[corner], first[corner + 1] - first[corner]);
  }
};

/// The corners of ShapeBounds.
[[nodiscard]] HullCorners hull_corners(const Shape& shape);

/// A convex set that holds a shape, except for the shape's thickening. Refers to the corners.
struct ShapeHull {
  const Shape* shape = nullptr;
  const HullCorners* corners = nullptr;
  ConvexCore core = {};  ///< Core in the frame of the hierarchy's centre.
  double error = 0.0;    ///< [m]  Thickness that the set needs to hold the shape.
};

/// The hull of a shape in a pair; the set itself where the shape is one.
///
/// @param corners  hull_corners() of the shape; at least one
[[nodiscard]] ShapeHull hull_of(const Shape& shape, const Shape& partner,
                                const HullCorners& corners);

/// How long two hulls stay apart.
struct HullApproach {
  double t = 0.0;  ///< [-]  Proven: farther apart than the threshold from the begin until then.
  std::optional<double> t_contact = {};  ///< [-]  Proven: the shapes have met by then.
};

/// Follows two hulls from the begin of a window, as long as they are farther apart than a
/// threshold.
///
/// It ends where they are nearly that near, or come near too slowly for few steps. It ends sooner
/// where a contact of the shapes is found to follow within `early`: see have_met().
///
/// @param motion     relative motion of the shapes' hierarchies; pieces of it are entered
/// @param threshold  [m]  thickenings of the shapes included
/// @param tolerance  [m]  by which a contact may be farther
/// @param early      [-]  0: no contact is looked for
[[nodiscard]] HullApproach follow_hulls(const ShapeHull& A, const ShapeHull& B, PairMotion& motion,
                                        const TimeWindow& window, double threshold,
                                        double tolerance, double early);

}  // namespace firstcontact::detail
