// The near parts of two convex bodies hold all features within the band.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/detail/near_patches.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/query/distance.h>

#include "support/random.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Pair = std::tuple<FeatureType, std::uint32_t, FeatureType, std::uint32_t>;

Pair pair_of(const Feature& a, const Feature& b) { return {a.type, a.index, b.type, b.index}; }

TEST(NearPatches, HoldAllFeaturesWithinTheBand) {
  const Shape A = make_cylinder(0.02, 0.2, 1e-4).as_triangles();
  const Shape B = make_cone(0.03, 0.1, 1e-4).as_triangles();
  constexpr double kBand = 1e-4;
  Workspace workspace;
  test::Random random(9);
  std::size_t features = 0;
  for (int k = 0; k < 100; ++k) {
    const Vector3d n = random.direction();
    const Pose X_WA{Vector3d(3.0, -2.0, 1.0), random.rotation()};
    Pose X_WB{X_WA.position + n, random.rotation()};
    for (int step = 0; step < 30; ++step) {  // Brings B nearer, to half of the band.
      const double gap =
          distance({A, Motion::fixed(X_WA)}, {B, Motion::fixed(X_WB)}, 0.0, workspace).distance;
      X_WB.position -= (gap - 0.5 * kBand) * n;
    }
    const PlacedShape placed_A(A, X_WA);
    const PlacedShape placed_B(B, X_WB);
    std::vector<Contact> all;
    close_features(placed_A, placed_B, kBand, workspace, all);
    const NearPatches near = near_patches(placed_A, placed_B, kBand);
    ASSERT_FALSE(near.are_apart);
    if (!near.patches) {
      continue;  // An end lies flat.
    }
    const auto& [of_A, of_B] = *near.patches;
    std::vector<Contact> found;
    close_features(PlacedShape(of_A.shape, X_WA), PlacedShape(of_B.shape, X_WB), kBand, workspace,
                   found);
    std::vector<Pair> expected;
    std::vector<Pair> pairs;
    for (const Contact& contact : all) {
      expected.push_back(pair_of(contact.feature_A, contact.feature_B));
    }
    for (const Contact& contact : found) {
      pairs.push_back(
          pair_of(of_A.in_whole(A, contact.feature_A), of_B.in_whole(B, contact.feature_B)));
    }
    std::ranges::sort(expected);
    std::ranges::sort(pairs);
    EXPECT_EQ(pairs, expected) << k;
    features += pairs.size();
  }
  EXPECT_GT(features, 100U);
}

TEST(NearPatches, AreNoneForBodiesThatAreApart) {
  const Shape A = make_cylinder(0.02, 0.2);
  const PlacedShape lower(A, {});
  const PlacedShape upper(A, {{0.0, 0.0, 0.2003}, Eigen::Quaterniond::Identity()});
  EXPECT_TRUE(near_patches(lower, upper, 2e-4).are_apart);
  EXPECT_FALSE(near_patches(lower, upper, 4e-4).are_apart);
}

}  // namespace
}  // namespace firstcontact::detail
