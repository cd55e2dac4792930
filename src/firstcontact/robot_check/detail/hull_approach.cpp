#include <firstcontact/robot_check/detail/hull_approach.h>

#include <algorithm>
#include <cstdint>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/convex_pair.h>
#include <firstcontact/robot_check/detail/convex_meeting.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Part of the hulls' reach; nearer hulls are left to the search of the shapes.
constexpr double kHullsNear = 0x1p-14;

/// Most steps in a piece of the motion: about twice what most hulls take that come near.
constexpr int kMostSteps = 6;

/// [-]  Rounding of sums of a few vectors.
constexpr double kHullRounding = 0x1p-48;

/// [-]  Part of the radius; a vertex this near a corner is that corner, up to its rounding.
constexpr double kSamePlace = kHullRounding;

/// Lists the triangles at each corner that is a vertex. Corners are in the order of the vertices.
void list_triangles(const Hierarchy& hierarchy, double near, HullCorners& corners) {
  const std::size_t count = corners.points.size();
  std::vector<std::size_t> corner_of(hierarchy.vertices.size(), count);
  std::size_t next = 0;
  for (std::size_t v = 0; v < corner_of.size() && next < count; ++v) {
    const Vector3d apart = corners.points[next] - hierarchy.vertices[v];
    if (apart.lpNorm<Eigen::Infinity>() <= near) {
      corner_of[v] = next++;
    }
  }
  std::vector<std::vector<std::uint32_t>> lists(count + 1);
  for (std::uint32_t k = 0; k < hierarchy.triangles.size(); ++k) {
    for (const std::uint32_t vertex : hierarchy.triangles[k]) {
      lists[corner_of[vertex]].push_back(k);
    }
  }
  for (std::size_t corner = 0; corner < count; ++corner) {
    corners.first.push_back(static_cast<std::uint32_t>(corners.triangles.size()));
    corners.triangles.insert(corners.triangles.end(), lists[corner].begin(), lists[corner].end());
  }
  corners.first.push_back(static_cast<std::uint32_t>(corners.triangles.size()));
}

}  // namespace

HullCorners hull_corners(const Shape& shape) {
  HullCorners corners;
  const Hierarchy& hierarchy = shape.hierarchy();
  if (hierarchy.deforms()) {
    return corners;
  }
  const ShapeBounds& bounds = shape.bounds();
  const Vector3d to_centre = bounds.centre - hierarchy.centre;
  for (Eigen::Index k = 0; k < bounds.corners.rows(); ++k) {
    corners.points.emplace_back(to_centre + bounds.corners.row(k).transpose());
  }
  list_triangles(hierarchy, kSamePlace * hierarchy.radius, corners);
  return corners;
}

ShapeHull hull_of(const Shape& shape, const Shape& partner, const HullCorners& corners) {
  ShapeHull hull{.shape = &shape, .corners = &corners};
  if (is_asked_as_convex(shape, partner)) {
    hull.core = shape.convex_core();
    return hull;
  }
  const ShapeBounds& bounds = shape.bounds();
  const double to_centre = (bounds.centre - shape.hierarchy().centre).norm();
  const double reach =
      (to_centre + bounds.half_extents.norm() + bounds.error) * (1.0 + kHullRounding);
  hull.error = bounds.error + kHullRounding * (reach + bounds.centre.norm());
  if (shape.convex_set() != nullptr) {
    hull.core = shape.convex_core();
  } else {
    hull.core.kind = ConvexKind::hull;
    hull.core.points = corners.points;
    hull.core.reach = reach;
  }
  return hull;
}

HullApproach follow_hulls(const ShapeHull& A, const ShapeHull& B, PairMotion& motion,
                          const TimeWindow& window, double threshold, double tolerance,
                          double early) {
  ConvexContactOptions options{.threshold = threshold + A.error + B.error,
                               .tolerance = kHullsNear * (A.core.reach + B.core.reach),
                               .t_begin = window.begin,
                               .most_steps = 1};
  ConvexGuess guess;
  int steps = 0;  // In a piece of the motion.
  bool is_new = true;
  while (options.t_begin < window.end) {
    if (is_new) {
      options.t_end = std::min(motion.enter(options.t_begin), window.end);
      steps = 0;
    }
    const double before = options.t_begin;
    const ConvexContact found = convex_first_contact({A.core, B.core, motion}, options, guess);
    options.t_begin = found.t;
    is_new = found.verdict == ConvexVerdict::free;
    if (is_new) {
      continue;
    }
    const bool ends = found.verdict != ConvexVerdict::unfinished || ++steps == kMostSteps;
    if (early > 0.0 && found.t > window.begin && (ends || found.t - before < early)) {
      const double t = std::min(found.t + early * (1.0 - 0x1p-20), options.t_end);
      if (have_met(A, B, motion.state(t), guess, threshold, tolerance)) {
        return {found.t, t};
      }
    }
    if (ends) {
      break;
    }
  }
  return {.t = options.t_begin};
}

}  // namespace firstcontact::detail
