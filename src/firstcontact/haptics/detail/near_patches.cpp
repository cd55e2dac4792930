#include <firstcontact/haptics/detail/near_patches.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/haptics/detail/hull_proof.h>
#include <firstcontact/narrowphase/convex_closest.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [triangles]  The most of a patch. Where more are near, a search in the whole shape is as short.
constexpr std::size_t kMostTriangles = 200;
/// [-]  More than the rounding of distances along a direction, by the sizes of the bodies.
constexpr double kRounding = 1e-12;

/// [-]  The gap along a direction that is good enough, by the distance.
constexpr double kNearlyBest = 0.99;

/// Finds the direction from A to B, world axes, along which their hulls are farthest apart, nearly.
Vector3d direction_between(const PlacedShape& A, const PlacedShape& B) {
  const Eigen::Quaterniond R_WA = A.pose().rotation.normalized();
  const Eigen::Quaterniond R_WB = B.pose().rotation.normalized();
  const Vector3d centre_A = R_WA * A.shape().hierarchy().centre;
  const Vector3d centre_B =
      (B.pose().position - A.pose().position) + R_WB * B.shape().hierarchy().centre;
  const ConvexCore core_A = hull_of(A.shape());
  const ConvexCore core_B = hull_of(B.shape());
  ConvexGuess guess;
  guess.n = (centre_B - centre_A).stableNormalized();
  return closest_points({core_A, R_WA.toRotationMatrix(), centre_A},
                        {core_B, R_WB.toRotationMatrix(), centre_B},
                        {.least = 0.0, .near = kNearlyBest}, guess)
      .n;
}

/// [m]  The heights of the vertices of a body along a direction of the world, from its origin.
std::vector<double> heights_along(const Vector3d& n_W, const PlacedShape& S) {
  const Vector3d n_S = S.pose().rotation.normalized().conjugate() * n_W;
  std::vector<double> heights;
  heights.reserve(S.shape().mesh().vertices.size());
  for (const Vector3d& vertex : S.shape().mesh().vertices) {
    heights.push_back(n_S.dot(vertex));
  }
  return heights;
}

/// Takes the triangles of which a vertex is at least as high as `least`; none if they are many.
std::optional<SurfacePatch> patch_above(double least, const std::vector<double>& heights,
                                        const Shape& shape) {
  Mesh mesh;
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> triangles;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  const std::vector<std::array<std::uint32_t, 3>>& all = shape.mesh().triangles;
  for (std::size_t t = 0; t < all.size(); ++t) {
    if (std::ranges::none_of(all[t], [&](std::uint32_t v) { return heights[v] >= least; })) {
      continue;
    }
    if (triangles.size() == kMostTriangles) {
      return {};
    }
    triangles.push_back(static_cast<std::uint32_t>(t));
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [at, is_new] =
          number.try_emplace(all[t][k], static_cast<std::uint32_t>(vertices.size()));
      if (is_new) {
        vertices.push_back(all[t][k]);
        mesh.vertices.push_back(shape.mesh().vertices[all[t][k]]);
      }
      corners[k] = at->second;
    }
    mesh.triangles.push_back(corners);
  }
  return SurfacePatch{Shape(std::move(mesh), shape.radius()), std::move(vertices),
                      std::move(triangles)};
}

}  // namespace

Feature SurfacePatch::in_whole(const Shape& whole, const Feature& feature) const {
  Feature found{.type = feature.type, .index = 0, .triangle = triangles[feature.triangle]};
  switch (feature.type) {
    case FeatureType::vertex:
      found.index = vertices[feature.index];
      break;
    case FeatureType::edge: {
      const auto [a, b] = shape.edge(feature.index);
      found.index = whole.edge_index(vertices[a], vertices[b]);
      break;
    }
    case FeatureType::face:
      found.index = triangles[feature.index];
      break;
  }
  return found;
}

NearPatches near_patches(const PlacedShape& A, const PlacedShape& B, double band) {
  const Vector3d n_W = direction_between(A, B);
  const std::vector<double> heights_A = heights_along(n_W, A);
  const std::vector<double> heights_B = heights_along(-n_W, B);
  const double top_A = *std::ranges::max_element(heights_A);
  const double top_B = *std::ranges::max_element(heights_B);
  const Vector3d p_AB_W = B.pose().position - A.pose().position;
  const double gap = n_W.dot(p_AB_W) - top_A - top_B;
  const double size = p_AB_W.norm() + A.pose().position.norm() + B.pose().position.norm() +
                      A.shape().hierarchy().centre.norm() + A.shape().hierarchy().radius +
                      B.shape().hierarchy().centre.norm() + B.shape().hierarchy().radius;
  const double thickness =
      (band + A.shape().radius() + B.shape().radius()) * (1.0 + kRounding) - gap + kRounding * size;
  if (thickness < 0.0) {
    return {.are_apart = true};
  }
  std::optional<SurfacePatch> of_A = patch_above(top_A - thickness, heights_A, A.shape());
  std::optional<SurfacePatch> of_B =
      of_A ? patch_above(top_B - thickness, heights_B, B.shape()) : std::nullopt;
  if (!of_B) {
    return {};
  }
  return {.patches = std::array{std::move(*of_A), std::move(*of_B)}};
}

}  // namespace firstcontact::detail
