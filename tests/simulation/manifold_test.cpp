#include <firstcontact/simulation_model/detail/manifold.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/query/close_features.h>
#include <firstcontact/scene/links_as_bodies.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

#include "simulation/random_body.h"

namespace firstcontact::detail {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSize = 1.0;  // [m]

ManifoldPoint touch(const BodyPair& bodies, std::uint32_t vertex, double x, double impulse = 0.0) {
  return {.bodies = bodies,
          .feature_A = {FeatureType::face, 0, 0},
          .feature_B = {FeatureType::vertex, vertex, 0},
          .surface = {0, vertex},
          .point = {x, 0.0, 0.0},
          .impulse = {0.0, 0.0, impulse}};
}

/// Normal impulses of the touches of a pair after those before.
std::vector<double> carried(std::vector<ManifoldPoint> before, std::vector<ManifoldPoint> now) {
  std::ranges::sort(before, comes_before);
  Manifold manifold{.bodies = {1, 2}, .touches = std::move(now)};
  carry_impulses(before, kSize, manifold);
  std::vector<double> impulses;
  for (const ManifoldPoint& touch : manifold.touches) {
    impulses.push_back(touch.impulse.z());
  }
  return impulses;
}

TEST(CarryImpulses, GoToTheSameFeaturesWhereverTheyAre) {
  EXPECT_EQ(carried({touch({1, 2}, 7, 0.0, 3.0), touch({1, 2}, 8, 0.5, 4.0)},
                    {touch({1, 2}, 8, 0.0), touch({1, 2}, 7, 0.5)}),
            (std::vector{4.0, 3.0}));
}

TEST(CarryImpulses, GoToTheNearestTouchWhereFeaturesChange) {
  EXPECT_EQ(carried({touch({1, 2}, 7, 0.001, 3.0)},
                    {touch({1, 2}, 1, 0.004), touch({1, 2}, 2, 0.0), touch({1, 2}, 3, 1.0)}),
            (std::vector{0.0, 3.0, 0.0}));
}

TEST(CarryImpulses, AddUpWhereTwoBecomeOne) {
  EXPECT_EQ(
      carried({touch({1, 2}, 7, 0.0, 3.0), touch({1, 2}, 8, 0.001, 4.0)}, {touch({1, 2}, 7, 0.0)}),
      (std::vector{7.0}));
}

TEST(CarryImpulses, EndWithTheirTouch) {
  EXPECT_EQ(carried({touch({1, 2}, 7, 0.0, 3.0)}, {touch({1, 2}, 1, 0.02)}), (std::vector{0.0}));
  EXPECT_TRUE(carried({touch({1, 2}, 7, 0.0, 3.0)}, {}).empty());
}

// Many touches are found by features and by place, as in a list that is searched in order.
TEST(CarryImpulses, GoToTheSameOfManyAsInAList) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> uniform;
  const auto some = [&](std::uint32_t features, double impulse) {
    ManifoldPoint one = touch({1, 2}, static_cast<std::uint32_t>(rng()) % features, 0.0, impulse);
    one.point = {0.1 * uniform(rng), 0.1 * uniform(rng), 0.1 * uniform(rng)};
    return one;
  };
  std::vector<ManifoldPoint> before;
  std::vector<ManifoldPoint> now;
  for (int k = 0; k < 500; ++k) {
    before.push_back(some(1000, 1.0 + k));
    now.push_back(some(1000, 0.0));
  }
  std::ranges::sort(before, comes_before);
  std::vector<double> expected(now.size(), 0.0);
  int by_place = 0;
  int lost = 0;
  for (const ManifoldPoint& old : before) {
    auto next =
        std::ranges::find_if(now, [&](const ManifoldPoint& t) { return same_features(t, old); });
    if (next == now.end()) {
      next = std::ranges::min_element(
          now, {}, [&](const ManifoldPoint& t) { return (t.point - old.point).norm(); });
      const bool is_close = (next->point - old.point).norm() <= 0.01 * kSize;
      ++(is_close ? by_place : lost);
      if (!is_close) {
        continue;
      }
    }
    expected[static_cast<std::size_t>(next - now.begin())] += old.impulse.z();
  }
  ASSERT_GE(by_place, 20);
  ASSERT_GE(lost, 20);
  EXPECT_EQ(carried(before, now), expected);
}

TEST(CarryImpulses, StayWithTheirPair) {
  EXPECT_EQ(
      carried({touch({0, 2}, 7, 0.0, 3.0), touch({1, 3}, 7, 0.0, 4.0)}, {touch({1, 2}, 7, 0.0)}),
      (std::vector{0.0}));
}

// --- Manifolds -----------------------------------------------------------------------------------

constexpr double kGap = 1e-4;  // [m]

/// Two cubes of 1 m and a cylinder.
class ManifoldOfCubes : public testing::Test {
 protected:
  [[nodiscard]] const Shape& shape(std::size_t body) const { return model_.bodies[body].shape; }

  [[nodiscard]] Manifold manifold(const BodyPair& bodies, const Pose& X_WA, const Pose& X_WB) {
    return finder_.find(bodies, PlacedShape(shape(bodies[0]), X_WA),
                        PlacedShape(shape(bodies[1]), X_WB), 0.0);
  }

 private:
  ShapeCache cache_;
  LoadedScene loaded_ = load_scene(parse_scene(R"({"firstcontact": 1, "bodies": [
      {"name": "A", "shape": {"box": {"size": [1, 1, 1]}}, "dynamics": {}},
      {"name": "B", "shape": {"box": {"size": [1, 1, 1]}}, "dynamics": {}},
      {"name": "C", "shape": {"cylinder": {"radius": 0.5, "length": 1}}, "dynamics": {}}],
      "simulation": {"contact_distance": 1e-4}})",
                                               "test.json"),
                                   cache_);
  LinksAsBodies linked_ = links_as_bodies(loaded_);
  Workspace workspace_;

 protected:
  SimulationModel model_{loaded_, linked_};
  ManifoldFinder finder_{model_, workspace_};
};

/// Turned about their common normal, shifted, anywhere.
TEST_F(ManifoldOfCubes, HasTheCornersWhereFacesOverlap) {
  std::mt19937 rng(3);
  for (const double far : {0.0, 1e6}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Quaterniond all = test::random_rotation(rng);
      const Vector3d shift(0.3, trial % 2 == 0 ? 0.2 : 0.0, 1.0 + kGap);  // Edges may be in line.
      const Pose X_WA{Vector3d::Constant(far), all};
      const Pose X_WB{X_WA.position + all * shift, all};
      const Manifold found = manifold({0, 1}, X_WA, X_WB);
      const double rounding = far == 0.0 ? 1e-12 : 1e-9;
      ASSERT_NEAR(found.gap, kGap, rounding);
      ASSERT_EQ(found.touches.size(), 4u) << trial;
      for (const ManifoldPoint& touch : found.touches) {
        const Vector3d p_A = all.conjugate() * (touch.point - X_WA.position);
        const bool is_left = p_A.x() < 0.2;
        EXPECT_NEAR(p_A.x(), is_left ? -0.2 : 0.5, 10.0 * rounding);
        EXPECT_NEAR(p_A.y(), p_A.y() < 0.2 ? shift.y() - 0.5 : 0.5, 10.0 * rounding);
        EXPECT_NEAR(p_A.z(), 0.5 + 0.5 * kGap, 10.0 * rounding);
        EXPECT_GE(touch.normal.dot(all * Vector3d::UnitZ()), 1.0 - 1e-9);
        EXPECT_NEAR(touch.gap, kGap, rounding);
      }
    }
  }
}

TEST_F(ManifoldOfCubes, IsOnePointWhereEdgesCross) {
  const double half = std::sqrt(0.5);
  const Quaterniond up(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vector3d::UnitX()));
  const Quaterniond across(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vector3d::UnitY()));
  const Manifold found =
      manifold({0, 1}, {.rotation = up}, {{0.1, 0.2, 2.0 * half + kGap}, across});
  ASSERT_EQ(found.touches.size(), 1u);
  EXPECT_EQ(found.touches[0].feature_A.type, FeatureType::edge);
  EXPECT_EQ(found.touches[0].feature_B.type, FeatureType::edge);
  EXPECT_LE((found.touches[0].point - Vector3d(0.1, 0.0, half + 0.5 * kGap)).norm(), 1e-12);
  EXPECT_NEAR(found.gap, kGap, 1e-12);
}

TEST_F(ManifoldOfCubes, IsEmptyBeyondTheBand) {
  const double band = model_.distances.band;
  const auto above = [&](double gap) {
    return manifold({0, 1}, {}, {.position = {0.0, 0.0, 1.0 + gap}});
  };
  EXPECT_EQ(above(band * (1.0 - 1e-6)).touches.size(), 4u);
  EXPECT_TRUE(above(band * (1.0 + 1e-6)).touches.empty());
  EXPECT_EQ(above(band * (1.0 + 1e-6)).gap, std::numeric_limits<double>::infinity());
}

// Contacts that were found of other pairs before change nothing.
TEST_F(ManifoldOfCubes, IsThatOfTheContactsOfItsPairAlone) {
  std::mt19937 rng(4);
  std::size_t touches = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const BodyPair bodies{0, trial % 3 == 0 ? 2U : 1U};
    const Quaterniond all = test::random_rotation(rng);
    const Pose X_WA{test::random_vector(rng, 2.0), all};
    const Vector3d way(0.3, -0.1, 1.0 + 1.5 * kGap);
    const Quaterniond about(Eigen::AngleAxisd(0.1 * trial, Vector3d::UnitZ()));
    const Pose X_WB{X_WA.position + all * way, all * about};
    const Manifold found = manifold(bodies, X_WA, X_WB);
    const Motion A = Motion::fixed(X_WA);
    const Motion B = Motion::fixed(X_WB);
    Workspace workspace;
    std::vector<Contact> contacts;
    close_features({shape(bodies[0]), A}, {shape(bodies[1]), B}, 0.0, model_.distances.band,
                   workspace, contacts);
    const std::vector<ManifoldPoint> expected =
        touches_among(model_, bodies, {X_WA, X_WB}, 0.0, contacts);
    ASSERT_EQ(found.touches.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      ASSERT_TRUE(same_features(found.touches[k], expected[k]));
      ASSERT_EQ(found.touches[k].point, expected[k].point);
      ASSERT_EQ(found.touches[k].normal, expected[k].normal);
      ASSERT_EQ(found.touches[k].gap, expected[k].gap);
    }
    touches += expected.size();
  }
  EXPECT_GE(touches, 900u);
}

}  // namespace
}  // namespace firstcontact::detail
