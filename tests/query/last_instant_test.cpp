// The end of a step belongs to it.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <firstcontact/motion/constant_rate_pair.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/detail/contact_search.h>
#include <firstcontact/query/first_contact.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// n by n squares over [-1, 1]^2, the middle at a height; all numbers exact where n is a power
/// of 2.
Shape tent(int n, double height) {
  Mesh mesh;
  const auto place = [n](int i) { return 2.0 * i / n - 1.0; };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double aside = std::max(std::abs(place(i)), std::abs(place(j)));
      mesh.vertices.emplace_back(place(i), place(j), height * (1.0 - aside));
    }
  }
  const auto index = [n](int i, int j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return Shape(std::move(mesh));
}

/// Falls by 1 m, to end with its tip `gap` above z = 0.
Motion fall(double gap) {
  return Motion::constant_velocity({.position = {0.0, 0.0, 2.0 + gap}}, {0.0, 0.0, -1.0});
}

detail::PieceResult search_last_instant(double gap) {
  const Shape floor = tent(16, 0.0);
  const Shape tip = tent(16, -1.0);
  const Motion rest = Motion::fixed();
  const Motion falling = fall(gap);
  ConstantRatePair motion(rest, falling, floor.hierarchy().centre, tip.hierarchy().centre, 1e-6);
  motion.enter(1.0);
  const detail::MovingPair pair(floor.hierarchy(), tip.hierarchy(), motion);
  const WorkBudget budget;
  const detail::SearchLimits limits{.tolerance = 1e-6, .band = 1e-6, .budget = budget};
  Workspace workspace;
  WorkCount work;
  return detail::search_piece(pair, 1.0, 1.0, limits, workspace.data(), work);
}

// A window of no width is searched too: pairs that no time is proven for are kept.
TEST(LastInstant, OfASearchIsSearched) {
  const detail::PieceResult touching = search_last_instant(0.0);
  EXPECT_TRUE(touching.contact);
  EXPECT_EQ(touching.t, 1.0);
  const detail::PieceResult apart = search_last_instant(1e-3);
  EXPECT_TRUE(apart.finished);
  EXPECT_FALSE(apart.contact);
}

TEST(LastInstant, OfAStepHoldsTheContactsThatAreReachedThere) {
  const Shape floor = tent(16, 0.0);
  const Shape tip = tent(16, -1.0);
  const Motion rest = Motion::fixed();
  Workspace workspace;
  for (int k = 0; k <= 40; k += test::rounds(1, 4)) {
    const FirstContactOptions options{.tolerance = std::exp2(-k)};
    const FirstContactResult touching =
        first_contact({floor, rest}, {tip, fall(0.0)}, workspace, options);
    EXPECT_EQ(touching.verdict, Verdict::contact) << k;
    EXPECT_LE(touching.t, 1.0) << k;
    EXPECT_GE(touching.t, 1.0 - 1.001 * touching.tolerance_used) << k;
    const FirstContactResult apart =
        first_contact({floor, rest}, {tip, fall(2.0 * options.tolerance)}, workspace, options);
    EXPECT_EQ(apart.verdict, Verdict::free) << k;
  }
}

}  // namespace
}  // namespace firstcontact
