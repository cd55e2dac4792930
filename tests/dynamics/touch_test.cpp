#include <firstcontact/dynamics/detail/touch.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 1.0;  // [m]

Touch touch(const BodyPair& bodies, std::uint32_t vertex, double x, double impulse = 0.0) {
  return {.bodies = bodies,
          .feature_A = {FeatureType::face, 0, 0},
          .feature_B = {FeatureType::vertex, vertex, 0},
          .point = {x, 0.0, 0.0},
          .impulse = {0.0, 0.0, impulse}};
}

/// Normal impulses of the touches of a pair after those before.
std::vector<double> carried(std::vector<Touch> before, std::vector<Touch> now) {
  std::ranges::sort(before, comes_before);
  Manifold manifold{.bodies = {1, 2}, .touches = std::move(now)};
  carry_impulses(before, kSize, manifold);
  std::vector<double> impulses;
  for (const Touch& touch : manifold.touches) {
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

// Of many touches they are found by features and by place, as in a list looked through in order.
TEST(CarryImpulses, GoToTheSameOfManyAsInAList) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> uniform;
  const auto some = [&](std::uint32_t features, double impulse) {
    Touch one = touch({1, 2}, static_cast<std::uint32_t>(rng()) % features, 0.0, impulse);
    one.point = {0.1 * uniform(rng), 0.1 * uniform(rng), 0.1 * uniform(rng)};
    return one;
  };
  std::vector<Touch> before;
  std::vector<Touch> now;
  for (int k = 0; k < 500; ++k) {
    before.push_back(some(1000, 1.0 + k));
    now.push_back(some(1000, 0.0));
  }
  std::ranges::sort(before, comes_before);
  std::vector<double> expected(now.size(), 0.0);
  int by_place = 0;
  int lost = 0;
  for (const Touch& old : before) {
    auto next = std::ranges::find_if(now, [&](const Touch& t) { return same_features(t, old); });
    if (next == now.end()) {
      next = std::ranges::min_element(now, {},
                                      [&](const Touch& t) { return (t.point - old.point).norm(); });
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

}  // namespace
}  // namespace firstcontact::detail
