#include <firstcontact/query/detail/convex_contacts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/moving_pairs/detail/convex_leaf.h>
#include <firstcontact/query/detail/close_pairs.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// The sector of n around z in which a point lies.
std::uint32_t sector_of(const Vector3d& p, std::uint32_t n) {
  const double turns = std::atan2(p.y(), p.x()) / (2.0 * std::numbers::pi);
  const double along = (turns < 0.0 ? turns + 1.0 : turns) * n;
  return std::min(static_cast<std::uint32_t>(std::max(0.0, along)), n - 1);
}

/// The face below a point, with the numbers of make_cylinder().
std::uint32_t face_of_cylinder(const ConvexCore& core, const Vector3d& p, std::uint32_t n) {
  const std::uint32_t k = sector_of(p, n);
  const double to_side = core.size.x() - std::hypot(p.x(), p.y());
  if (core.size.z() - std::abs(p.z()) < to_side) {
    return (p.z() < 0.0 ? 2 * n : 3 * n) + k;
  }
  const double turns = std::atan2(p.y(), p.x()) / (2.0 * std::numbers::pi);
  const double across = (turns < 0.0 ? turns + 1.0 : turns) * n - k;
  const double height = 0.5 * (p.z() / core.size.z() + 1.0);
  return 2 * k + (across >= height ? 0 : 1);
}

/// The face below a point, with the numbers of make_cone().
std::uint32_t face_of_cone(const ConvexCore& core, const Vector3d& p, std::uint32_t n) {
  const double height = p.z() + core.size.z();
  const double at_height = core.size.x() * (1.0 - 0.5 * height / core.size.z());
  const double slope = 2.0 * core.size.z() / std::hypot(core.size.x(), 2.0 * core.size.z());
  const double to_side = (at_height - std::hypot(p.x(), p.y())) * slope;
  return sector_of(p, n) + (height < to_side ? n : 0);
}

/// The face below a point, with the numbers of make_ellipsoid(): n sectors and n / 2 rings give n
/// (n - 2) faces.
std::uint32_t face_of_ellipsoid(const ConvexCore& core, const Vector3d& p, std::uint32_t faces) {
  const auto n =
      static_cast<std::uint32_t>(std::lround(1.0 + std::sqrt(1.0 + static_cast<double>(faces))));
  const std::uint32_t rings = n / 2;
  const Vector3d on_sphere = p.cwiseQuotient(core.size);
  const std::uint32_t k = sector_of(on_sphere, n);
  const double polar =
      std::acos(std::clamp(-on_sphere.z() / on_sphere.norm(), -1.0, 1.0)) / std::numbers::pi;
  const double along = std::max(0.0, polar * rings);
  const auto ring = std::min(static_cast<std::uint32_t>(along), rings - 1);
  if (ring == 0) {
    return k;
  }
  if (ring == rings - 1) {
    return faces - n + k;
  }
  const double turns = std::atan2(on_sphere.y(), on_sphere.x()) / (2.0 * std::numbers::pi);
  const double across = (turns < 0.0 ? turns + 1.0 : turns) * n - k;
  return n + (ring - 1) * 2 * n + 2 * k + (across >= along - ring ? 0 : 1);
}

/// The feature of a mesh nearest to a point, found among all triangles.
Feature nearest_feature(const Shape& shape, const Vector3d& p) {
  const Hierarchy& hierarchy = shape.hierarchy();
  const Vector3d from_centre = p - hierarchy.centre;
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = 0;
  TriangleFeature feature;
  for (std::uint32_t k = 0; k < hierarchy.triangles.size(); ++k) {
    const auto& t = hierarchy.triangles[k];
    const ClosestFeatures closest = triangle_distance(
        {from_centre, from_centre, from_centre},
        {hierarchy.vertices[t[0]], hierarchy.vertices[t[1]], hierarchy.vertices[t[2]]});
    if (closest.distance < least) {
      least = closest.distance;
      nearest = k;
      feature = closest.feature_B;
    }
  }
  return global_feature(shape, nearest, feature);
}

/// The feature of a body that is treated as a set, or of a triangle.
Feature feature_of(const Shape& shape, const ConvexCore* core, const Eigen::Matrix3d& R,
                   const Vector3d& p_CP_W, std::uint32_t triangle, const TriangleFeature& local) {
  return core == nullptr ? global_feature(shape, triangle, local)
                         : feature_at(shape, shape.hierarchy().centre + R.transpose() * p_CP_W);
}

}  // namespace

Feature feature_at(const Shape& shape, const Vector3d& p_S) {
  const ConvexCore& core = shape.convex_set()->core();
  const auto triangles = static_cast<std::uint32_t>(shape.mesh().triangles.size());
  std::uint32_t face = 0;
  if (shape.is_curved() && core.kind == ConvexKind::cylinder) {
    face = face_of_cylinder(core, p_S, triangles / 4);
  } else if (shape.is_curved() && core.kind == ConvexKind::cone) {
    face = face_of_cone(core, p_S, triangles / 2);
  } else if (shape.is_curved() && core.kind == ConvexKind::ellipsoid && !p_S.isZero(0.0)) {
    face = face_of_ellipsoid(core, p_S, triangles);
  } else {
    return nearest_feature(shape, p_S);
  }
  return {FeatureType::face, face, face};
}

ClosePair close_convex_pair(const ContactFrame& frame, const RelativeState& state, std::uint32_t a,
                            std::uint32_t b, const ClosestFeatures& closest) {
  return {feature_of(frame.A, frame.pair.convex_A(), state.R_WA, closest.p_A, a, closest.feature_A),
          feature_of(frame.B, frame.pair.convex_B(), state.R_WB, closest.p_B - state.p_AB, b,
                     closest.feature_B),
          a, b, closest};
}

void find_close_to_convex(const ContactFrame& frame, const RelativeState& state, double band,
                          WorkspaceData& workspace) {
  const MovingPair& pair = frame.pair;
  workspace.close_pairs.clear();
  const double reach = band + pair.gap_error(state);
  const BoxesAtInstant boxes(pair, state);
  auto& stack = workspace.stack;
  stack.assign(1, {false, 0, 0, root(pair.A()), root(pair.B())});
  while (!stack.empty()) {
    const BoxPair top = stack.back();
    stack.pop_back();
    if (top.is_triangle_pair) {
      const ClosestFeatures closest =
          closest_features(pair, state, top.triangle_A, top.triangle_B, reach);
      if (closest.distance <= band) {
        workspace.close_pairs.push_back(
            close_convex_pair(frame, state, top.triangle_A, top.triangle_B, closest));
      }
      continue;
    }
    boxes.open(top.A, top.B, [&](const BoxesAtInstant::Lane& lane) {
      if (!(lane.gap() > reach)) {
        stack.push_back(lane.inside());
      }
    });
  }
}

}  // namespace firstcontact::detail
