// Distances of edges and of corners from a face, many at once, on every instruction set, against
// brute force in exact rational numbers.

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/narrowphase/closest_features.h>
#include <firstcontact/narrowphase/feature_batches.h>

#include "support/closest_points.h"
#include "support/instruction_sets.h"
#include "support/rational.h"

namespace firstcontact::feature_batches {
namespace {

using Eigen::Vector3d;
using oracle::Rational;

constexpr double kBand = 0.4;        // [m]
constexpr double kRounding = 1e-14;  // [-]  Relative to the size.

oracle::Triangle<Rational> exact(const Triangle& T) {
  const auto corner = [](const Vector3d& v) -> oracle::Vector3<Rational> {
    return {v.x(), v.y(), v.z()};
  };
  return {corner(T[0]), corner(T[1]), corner(T[2])};
}

double exact_distance(const Triangle& A, const Triangle& B) {
  return std::sqrt(oracle::closest_points<Rational>(exact(A), exact(B)).distance2.nearest());
}

Vector3d any_vector(std::mt19937& rng) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return {uniform(rng), uniform(rng), uniform(rng)};
}

/// A needle stands for an edge; many are parallel, some points.
Triangle any_edge(std::mt19937& rng, double far) {
  const Vector3d from = Vector3d(far, -far, far) + any_vector(rng);
  const Vector3d way = rng() % 3 == 0 ? Vector3d(0.0, 0.0, 1.0) : any_vector(rng);
  const Vector3d to = rng() % 8 == 0 ? from : Vector3d(from + way);
  return {from, to, to};
}

using FeatureBatchesOn = test::OnInstructionSet;

TEST_P(FeatureBatchesOn, EdgesAreAsFarApartAsTheyAre) {
  std::mt19937 rng(1);
  int within = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const double far = trial % 2 == 0 ? 0.0 : 1e6;
    const double size = far + 2.0;
    EdgeBatch A;
    EdgeBatch B;
    std::vector<Triangle> needles;
    const Triangle one = any_edge(rng, far);
    A.add(one[0], one[1]);
    for (std::size_t count = 1 + rng() % FeatureLanes::kCapacity; count > 0; --count) {
      needles.push_back(any_edge(rng, far));
      B.add(needles.back()[0], needles.back()[1]);
    }
    prepare(A);
    prepare(B);
    EdgeDistances distances;
    edge_distances(A, 0, B, kBand, size, distances);
    ASSERT_EQ(distances.within >> needles.size(), 0u);
    for (std::size_t k = 0; k < needles.size(); ++k) {
      const double expected = exact_distance(one, needles[k]);
      if ((distances.within >> k & 1u) == 0) {
        ASSERT_GE(expected, kBand - kRounding * size);
        continue;
      }
      ++within;
      ASSERT_LE(distances.distance[k], kBand);
      ASSERT_NEAR(distances.distance[k], expected, 1e-9 + kRounding * size);
      const Vector3d p_A = point_on_edge(one[0], one[1], distances.s[k]);
      const Vector3d p_B = point_on_edge(needles[k][0], needles[k][1], distances.t[k]);
      ASSERT_EQ(distances.distance[k], (p_B - p_A).norm());
    }
  }
  EXPECT_GT(within, 100);
}

TEST_P(FeatureBatchesOn, CornersAreOverTheFacesThatAreNearestToThem) {
  std::mt19937 rng(2);
  int within = 0;
  std::array<CornerFeet, FeatureLanes::kCapacity> feet;
  for (int trial = 0; trial < 20; ++trial) {
    const double far = trial % 2 == 0 ? 0.0 : 1e6;
    const double size = far + 2.0;
    const auto any_place = [&] { return Vector3d(Vector3d(far, -far, far) + any_vector(rng)); };
    CornerBatch corners;
    for (std::size_t count = 1 + rng() % FeatureLanes::kCapacity; count > 0; --count) {
      corners.add(any_place());
    }
    FaceBatch faces;
    for (std::size_t count = 1 + rng() % FaceBatch::kCapacity; count > 0; --count) {
      faces.add({any_place(), any_place(), any_place()});
    }
    prepare(faces);
    corner_feet(corners, faces, kBand, size, feet);
    for (std::size_t k = 0; k < corners.count; ++k) {
      ASSERT_EQ((feet[k].within | feet[k].above) >> faces.count(), 0u);
      const Triangle corner{corners[k], corners[k], corners[k]};
      for (std::size_t f = 0; f < faces.count(); ++f) {
        const Triangle T = faces[f];
        const double height = (T[1] - T[0]).cross(T[2] - T[0]).dot(corners[k] - T[0]);
        ASSERT_EQ((feet[k].above >> f & 1u) != 0, feet[k].height[f] > 0.0);
        ASSERT_NEAR(feet[k].height[f], height, 1e-14 * (1.0 + std::abs(height)));
        const ClosestFeatures closest = triangle_distance(corner, T);
        const bool is_over = closest.feature_B.type == TriangleFeature::Type::face;
        if ((feet[k].within >> f & 1u) == 0) {
          ASSERT_TRUE(!is_over || closest.distance >= kBand - kRounding * size);
          continue;
        }
        ++within;
        const ClosestFeatures over = corner_over_face(corner, 0, T, feet[k][f], false);
        ASSERT_NEAR(over.distance, exact_distance(corner, T), 1e-9 + kRounding * size);
      }
    }
  }
  EXPECT_GT(within, 100);
}

INSTANTIATE_TEST_SUITE_P(, FeatureBatchesOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

}  // namespace
}  // namespace firstcontact::feature_batches
