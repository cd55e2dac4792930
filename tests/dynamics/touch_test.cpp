#include <firstcontact/dynamics/detail/touch.h>

#include <algorithm>
#include <cstdint>
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

TEST(CarryImpulses, StayWithTheirPair) {
  EXPECT_EQ(
      carried({touch({0, 2}, 7, 0.0, 3.0), touch({1, 3}, 7, 0.0, 4.0)}, {touch({1, 2}, 7, 0.0)}),
      (std::vector{0.0}));
}

}  // namespace
}  // namespace firstcontact::detail
