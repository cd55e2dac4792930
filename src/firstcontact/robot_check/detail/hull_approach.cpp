#include <firstcontact/robot_check/detail/hull_approach.h>

#include <algorithm>
#include <cstdint>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/convex_pair.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Part of the hulls' reach; nearer hulls are left to the search of the shapes.
constexpr double kHullsNear = 0x1p-14;

/// Most steps in a piece of the motion: about twice what most hulls take that come near.
constexpr std::uint64_t kMostSteps = 6;

/// [-]  Rounding of sums of a few vectors.
constexpr double kHullRounding = 0x1p-48;

}  // namespace

std::vector<Vector3d> hull_corners(const Shape& shape) {
  std::vector<Vector3d> corners;
  if (shape.hierarchy().deforms()) {
    return corners;
  }
  const ShapeBounds& bounds = shape.bounds();
  const Vector3d to_centre = bounds.centre - shape.hierarchy().centre;
  corners.reserve(static_cast<std::size_t>(bounds.corners.rows()));
  for (Eigen::Index k = 0; k < bounds.corners.rows(); ++k) {
    corners.emplace_back(to_centre + bounds.corners.row(k).transpose());
  }
  return corners;
}

ShapeHull hull_of(const Shape& shape, const Shape& partner, const std::vector<Vector3d>& corners) {
  if (is_asked_as_convex(shape, partner)) {
    return {shape.convex_core(), 0.0};
  }
  ShapeHull hull;
  hull.core.kind = ConvexKind::hull;
  hull.core.points = corners;
  const ShapeBounds& bounds = shape.bounds();
  const double to_centre = (bounds.centre - shape.hierarchy().centre).norm();
  hull.core.reach = (to_centre + bounds.half_extents.norm() + bounds.error) * (1.0 + kHullRounding);
  hull.error = bounds.error + kHullRounding * (hull.core.reach + bounds.centre.norm());
  return hull;
}

double hulls_apart_until(const ShapeHull& A, const ShapeHull& B, PairMotion& motion,
                         const TimeWindow& window, double threshold) {
  ConvexContactOptions options{.threshold = threshold + A.error + B.error,
                               .tolerance = kHullsNear * (A.core.reach + B.core.reach),
                               .t_begin = window.begin,
                               .most_steps = kMostSteps};
  ConvexGuess guess;
  while (options.t_begin < window.end) {
    options.t_end = std::min(motion.enter(options.t_begin), window.end);
    const ConvexContact found = convex_first_contact({A.core, B.core, motion}, options, guess);
    options.t_begin = found.t;
    if (found.verdict != ConvexVerdict::free) {
      break;
    }
  }
  return options.t_begin;
}

}  // namespace firstcontact::detail
