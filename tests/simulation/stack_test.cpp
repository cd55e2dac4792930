// Stacks and houses of cards: what friction and weight hold together stands.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/drift.h"

namespace firstcontact::test {
namespace {

// --- Blocks --------------------------------------------------------------------------------------

/// Blocks on top of each other, each that much farther along x than the one below.
Simulator stack(int count, double shift, double step = 0.01) {
  std::string bodies = kFloor;
  for (int k = 0; k < count; ++k) {
    bodies += "," + body("block " + std::to_string(k), box("[0.2, 0.2, 0.1]"),
                         numbers({k * shift, 0.0, 0.05 + kGap + k * (0.1 + kGap)}),
                         R"(, "dynamics": {})");
  }
  return simulator(bodies, settings(step, 0.5, kGap));
}

TEST(Stack, OfFiveBlocksStands) {
  Simulator s = stack(5, 0.0);
  expect_rest(drift(s, 2.0));
}

TEST(Stack, OfTenBlocksStands) {
  Simulator s = stack(10, 0.0);
  expect_rest(drift(s, 2.0));
}

// From 30 blocks on there are more than 120 contacts.
TEST(Stack, OfManyBlocksStandsAsFewDo) {
  for (const int count : {29, 31, 60, 100}) {
    for (const double step : {0.002, 0.01}) {
      Simulator s = stack(count, 0.0, step);
      const Drift found = drift(s, 1.0);
      expect_rest(found);
      EXPECT_TRUE(found.all_sleep) << count << " blocks, " << step << " s";
    }
  }
}

// Twelve cylinders have more than 1,000 contacts, on fewer than 20 bodies.
TEST(Stack, OfCylindersStandsAsOneOfBlocksDoes) {
  std::string bodies = kFloor;
  for (int k = 0; k < 12; ++k) {
    bodies += "," + body("cylinder " + std::to_string(k),
                         R"({"cylinder": {"radius": 0.1, "length": 0.2}})",
                         numbers({0.0, 0.0, 0.1 + kGap + k * (0.2 + kGap)}), R"(, "dynamics": {})");
  }
  Simulator s = simulator(bodies, settings(0.01, 0.5, kGap));
  expect_rest(drift(s, 0.5));
}

TEST(Stack, OfHeavyBlocksOnLightOnesStands) {
  for (const std::vector<double>& densities : std::vector<std::vector<double>>{
           {1.0, 1e7}, {1.0, 1e8}, {1.0, 1e2, 1e4, 1e6}, {1.0, 1e8, 1.0, 1e8}, {1e8, 1.0}}) {
    std::string bodies = kFloor;
    for (std::size_t k = 0; k < densities.size(); ++k) {
      bodies += "," + body("cube " + std::to_string(k), box("[0.2, 0.2, 0.2]"),
                           numbers({0.0, 0.0, 0.1 + kGap + static_cast<double>(k) * (0.2 + kGap)}),
                           R"(, "dynamics": {"density": )" + std::to_string(densities[k]) + "}");
    }
    Simulator s = simulator(bodies, settings(0.01, 0.5, kGap));
    expect_rest(drift(s, 1.0));
  }
}

// The four upper ones of five blocks overhang by 5/2 shifts at most: beyond half a block they tip.
TEST(Stack, TipsWhereItsWeightIsBesideItsBase) {
  Simulator leaning = stack(5, 0.0399);
  expect_rest(drift(leaning, 1.0));
  Simulator tipping = stack(5, 0.041);
  EXPECT_GE(drift(tipping, 0.3).moved, 1e-3);
}

// --- Cards ---------------------------------------------------------------------------------------

constexpr double kLong = 0.09;   // [m]
constexpr double kWide = 0.06;   // [m]
constexpr double kThick = 1e-3;  // [m]
constexpr double kLean = 25.0 * std::numbers::pi / 180.0;
const double kTentHeight = kGap + kLong * std::cos(kLean) + kThick * std::sin(kLean);  // [m]

/// Two cards that lean against each other above x, their feet at this height.
std::string tent(const std::string& name, double x, double foot) {
  const double aside = 0.5 * (kGap + kLong * std::sin(kLean) + kThick * std::cos(kLean));
  const double z = foot + kGap + 0.5 * (kLong * std::cos(kLean) + kThick * std::sin(kLean));
  std::string bodies;
  for (const int side : {-1, 1}) {
    bodies += R"(, {"name": ")" + name + (side < 0 ? " left" : " right") + R"(", "shape": )" +
              box(numbers({kThick, kWide, kLong})) + R"(, "pose": {"position": )" +
              numbers({x + side * aside, 0.0, z}) + R"(, "rpy": )" +
              numbers({0.0, -side * kLean, 0.0}) + R"(}, "dynamics": {"density": 700}})";
  }
  return bodies;
}

TEST(Cards, TentStands) {
  Simulator s = simulator(kFloor + tent("a", 0.0, 0.0), settings(0.005, 0.7, kGap));
  expect_rest(drift(s, 2.0));
}

// A card's weight acts halfway up: half of it, times the tangent, pushes each foot outwards.
TEST(Cards, TentFallsWithLessFrictionThanItLeans) {
  const double needed = 0.5 * std::tan(kLean);
  Simulator rough = simulator(kFloor + tent("a", 0.0, 0.0), settings(0.005, 1.05 * needed, kGap));
  expect_rest(drift(rough, 1.0));
  Simulator smooth = simulator(kFloor + tent("a", 0.0, 0.0), settings(0.005, 0.9 * needed, kGap));
  EXPECT_GE(drift(smooth, 0.4).moved, 1e-3);
}

/// A house of cards: each storey has a tent less than the one below, on ceilings of one card.
Simulator house(int storeys, double step) {
  const double apart = kLong * std::sin(kLean) + kThick + 1e-3;
  const std::string card = box(numbers({2.0 * apart - 1e-3, kWide, kThick}));
  std::string bodies = kFloor;
  double foot = 0.0;
  for (int tents = storeys; tents > 0; --tents) {
    const std::string storey = std::to_string(storeys - tents);
    for (int k = 0; k < tents; ++k) {
      bodies += tent("tent " + storey + " " + std::to_string(k), (2 * k - tents + 1) * apart, foot);
    }
    foot += kTentHeight + kGap + kThick;
    for (int k = 0; k + 1 < tents; ++k) {
      bodies += "," + body("ceiling " + storey + " " + std::to_string(k), card,
                           numbers({(2 * k - tents + 2) * apart, 0.0, foot - 0.5 * kThick}),
                           R"(, "dynamics": {"density": 700})");
    }
  }
  return simulator(bodies, settings(step, 0.7, kGap));
}

TEST(Cards, HousesStandAndSleepAtAnyStep) {
  for (const int storeys : {2, 3, 4}) {
    for (const double step : {0.001, 0.002, 0.005, 0.01}) {
      SCOPED_TRACE(std::to_string(storeys) + " storeys, " + std::to_string(step) + " s");
      Simulator s = house(storeys, step);
      const Drift found = drift(s, 1.0);
      expect_rest(found);
      EXPECT_TRUE(found.all_sleep);
    }
  }
}

}  // namespace
}  // namespace firstcontact::test
