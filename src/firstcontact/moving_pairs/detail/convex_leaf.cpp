#include <firstcontact/moving_pairs/detail/convex_leaf.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

const Vector3d& first_corner(const Hierarchy& hierarchy, std::uint32_t triangle) {
  return hierarchy.vertices[hierarchy.triangles[triangle][0]];
}

/// Finds the feature of a triangle on which a point of it lies.
TriangleFeature feature_at(const Triangle& T, const Vector3d& p) {
  return triangle_distance({p, p, p}, T).feature_B;
}

}  // namespace

ConvexLeaf::ConvexLeaf(const MovingPair& pair, const RelativeState& state, std::uint32_t a,
                       std::uint32_t b) {
  if (pair.convex_A() != nullptr) {
    A_.emplace(PlacedConvex{.core = *pair.convex_A(), .R = state.R_WA});
  } else {
    A_.emplace(PlacedConvex{.core = triangle_core(pair.A(), a),
                            .R = state.R_WA,
                            .centre = state.R_WA * first_corner(pair.A(), a)});
  }
  if (pair.convex_B() != nullptr) {
    B_.emplace(PlacedConvex{.core = *pair.convex_B(), .R = state.R_WB, .centre = state.p_AB});
  } else {
    B_.emplace(PlacedConvex{.core = triangle_core(pair.B(), b),
                            .R = state.R_WB,
                            .centre = state.p_AB + state.R_WB * first_corner(pair.B(), b)});
  }
}

const ConvexCore& ConvexLeaf::triangle_core(const Hierarchy& hierarchy, std::uint32_t triangle) {
  const auto& t = hierarchy.triangles[triangle];
  const auto& v = hierarchy.vertices;
  corners_ = {Vector3d::Zero(), v[t[1]] - v[t[0]], v[t[2]] - v[t[0]]};
  triangle_.kind = ConvexKind::hull;
  triangle_.points = corners_;
  triangle_.reach = std::max(corners_[1].norm(), corners_[2].norm()) * (1.0 + 0x1p-48);
  return triangle_;
}

ConvexGuess guess_of(const ConvexLeaf& leaf) {
  const auto middle = [](const PlacedConvex& S) {
    return S.to_frame(S.core.kind == ConvexKind::hull && S.core.points.size() == 3
                          ? Vector3d((S.core.points[1] + S.core.points[2]) / 3.0)
                          : S.core.origin);
  };
  ConvexGuess guess;
  const Vector3d between = middle(leaf.B()) - middle(leaf.A());
  const double length = between.norm();
  if (length > 0.0) {
    guess.n = between / length;
  }
  return guess;
}

ClosestFeatures closest_features(const MovingPair& pair, const RelativeState& state,
                                 std::uint32_t a, std::uint32_t b, double within) {
  const ConvexLeaf leaf(pair, state, a, b);
  ConvexGuess guess = guess_of(leaf);
  // The search ends early only where the gap proves more than is wanted.
  constexpr double kAnyGap = 1e-12;
  const ConvexClosest found = leaf.closest({.least = within, .near = kAnyGap}, guess);
  ClosestFeatures closest;
  closest.distance = found.distance;
  closest.p_A = found.p_A;
  closest.p_B = found.p_B;
  closest.feature_A = {TriangleFeature::Type::face, 0};
  closest.feature_B = {TriangleFeature::Type::face, 0};
  if (!found.n.isZero(0.0)) {
    const Vector3d middle = 0.5 * (found.p_A + found.p_B);
    closest.p_A = middle - (0.5 * found.distance) * found.n;
    closest.p_B = middle + (0.5 * found.distance) * found.n;
  }
  const auto place = [](const PlacedConvex& S) {
    return Triangle{S.centre, S.to_frame(S.core.points[1]), S.to_frame(S.core.points[2])};
  };
  if (pair.convex_A() == nullptr) {
    closest.feature_A = feature_at(place(leaf.A()), found.p_A);
  }
  if (pair.convex_B() == nullptr) {
    closest.feature_B = feature_at(place(leaf.B()), found.p_B);
  }
  return closest;
}

}  // namespace firstcontact::detail
