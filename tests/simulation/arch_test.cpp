// Arches of 25 stones and more.

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "simulation/drift.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector2d;

/// The corners of a stone of half a ring of radius 1 m around y, with half a gap less at its
/// joints.
std::string stone(int k, int stones, double thick) {
  std::string corners;
  for (const int end : {0, 1}) {
    const double angle = std::numbers::pi * (k + end) / stones;
    const Vector2d along(-std::sin(angle), std::cos(angle));
    for (const double radius : {1.0 - 0.5 * thick, 1.0 + 0.5 * thick}) {
      const Vector2d p = radius * Vector2d(std::cos(angle), std::sin(angle)) +
                         (end == 0 ? 0.5 : -0.5) * kGap * along;
      for (const double y : {-0.05, 0.05}) {
        corners += (corners.empty() ? "" : ", ") + numbers({p.x(), y, p.y()});
      }
    }
  }
  return R"({"convex_hull": {"vertices": [)" + corners + "]}}";
}

/// @param thick  [m]
Simulator arch(double thick, int stones = 25) {
  std::string bodies = body("floor", box("[9, 9, 1]"), "[0, 0, -0.5]");
  for (int k = 0; k < stones; ++k) {
    bodies += "," + body("stone " + std::to_string(k), stone(k, stones, thick),
                         numbers({0.0, 0.0, 0.5 * kGap}), R"(, "dynamics": {"density": 2500})");
  }
  return simulator(bodies, settings(0.01, 0.9, kGap));
}

// Half a ring carries itself where it is thicker than 0.1075 of its radius, however rough its
// joints are (M. Milankovitch, "Theorie der Druckkurven", 1907); else it folds at five joints.
TEST(Arch, StandsWhereItIsThickEnough) {
  Simulator s = arch(0.11);
  expect_rest(drift(s, 1.0));
}

// However many stones it has.
TEST(Arch, OfManyStonesStandsAsFewDo) {
  for (const int stones : {29, 35, 51, 101}) {
    Simulator s = arch(0.15, stones);
    const Drift found = drift(s, 0.5);
    expect_rest(found);
    EXPECT_TRUE(found.all_sleep) << stones;
    Simulator thin = arch(0.1, stones);
    EXPECT_GE(drift(thin, 0.15).moved, 1e-3) << stones;
  }
}

// More stones than sweeps over the contacts could ever make agree.
TEST(Arch, OfManyStonesFoldsWithoutLosingTime) {
  Simulator s = arch(0.06, 52);
  EXPECT_EQ(drift(s, 0.03).time_lost, 0.0);
}

TEST(Arch, FoldsWhereItIsTooThin) {
  Simulator s = arch(0.1);
  EXPECT_GE(drift(s, 0.15).moved, 1e-3);
}

}  // namespace
}  // namespace firstcontact::test
