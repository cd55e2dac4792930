// Simulations that take long under sanitizers.

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using test::body;
using test::box;
using test::kFloor;
using test::numbers;
using test::run;
using test::simulator;
using test::verify;

double total_energy(const RunStep& step) { return step.kinetic_energy + step.potential_energy; }

TEST(Simulator, HeapComesToRestProvenApart) {
  std::string bodies = kFloor;
  for (int k = 0; k < 6; ++k) {
    const std::string x = std::to_string(0.07 * (k % 2));
    bodies += "," + body("b" + std::to_string(k), box("[0.2, 0.25, 0.15]"),
                         "[" + x + ", " + x + ", " + std::to_string(0.2 + 0.3 * k) + "]",
                         R"(, "dynamics": {"angular_velocity": [1, 2, 3]})");
  }
  Simulator s = simulator(bodies, R"("step": 0.01)");
  const auto steps = run(s, 300);
  double weight = 0.0;
  for (const double mass : s.header().masses) {
    weight += 9.81 * mass;
  }
  // Pairs that are pushed back to their distance of rest lift what lies on them, at most by it.
  const double lift = weight * s.header().scene.simulation->contact_distance.value();
  for (std::size_t k = 1; k < steps.size(); ++k) {
    ASSERT_EQ(steps[k].time_lost, 0.0) << k;
    ASSERT_GT(steps[k].clearance, 0.0) << k;
    ASSERT_LE(total_energy(steps[k]), total_energy(steps[k - 1]) + lift) << k;
  }
  EXPECT_LE(steps.back().kinetic_energy, 1e-2);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

// So many that the laws are met in part only, and plans are made anew around what changed: never
// more energy, no residual beyond what heaps may have, and nothing meets.
TEST(Simulator, FallingHeapOfManyLosesEnergyProvenApart) {
  std::string bodies = kFloor;
  for (int k = 0; k < 64; ++k) {
    const std::vector<double> place{0.27 * (k % 3) + 0.01 * (k % 5), 0.23 * (k / 3 % 3),
                                    0.15 + 0.26 * (k / 9)};
    bodies += "," + body("b" + std::to_string(k), box("[0.2, 0.2, 0.2]"), numbers(place),
                         R"(, "dynamics": {"angular_velocity": [)" + std::to_string(k % 4 - 1.5) +
                             ", 2, " + std::to_string(k % 7 - 3.0) + "]}");
  }
  Simulator s = simulator(bodies, R"("step": 0.01, "friction": 0.5)");
  const auto steps = run(s, 80);
  double weight = 0.0;
  for (const double mass : s.header().masses) {
    weight += 9.81 * mass;
  }
  const double lift = weight * s.header().scene.simulation->contact_distance.value();
  std::size_t most = 0;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    most = std::max(most, steps[k].contacts.size());
    EXPECT_EQ(steps[k].time_lost, 0.0) << k;
    EXPECT_LE(steps[k].residual, 0.3 * 9.81 * 0.01) << k;
    EXPECT_LE(total_energy(steps[k]), total_energy(steps[k - 1]) + lift) << k;
  }
  EXPECT_GT(most, 150u);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

// Half over each other in rows, sides flush, so that features change with every rounding: whatever
// they are, a pair touches in the corners of what lies over each other, and a wall of more
// than 300 contacts rests as exactly as heaps are solved.
TEST(Simulator, WallRestsOnTheCornersOfItsBricks) {
  constexpr int kRows = 7;
  constexpr int kColumns = 10;   // Columns of the lowest row; every row up has one less.
  constexpr double kGap = 5e-4;  // [m]
  std::string bodies = kFloor;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns - row; ++column) {
      const double x = 0.2 * 1.005 * (column + 0.5 * row);
      bodies +=
          "," + body("brick " + std::to_string(row) + "/" + std::to_string(column),
                     box("[0.2, 0.1, 0.1]"), numbers({x, 0.0, kGap + 0.05 + row * (0.1 + kGap)}),
                     R"(, "dynamics": {})");
    }
  }
  Simulator s = simulator(bodies, R"("step": 0.01, "friction": 0.5)");
  const auto steps = run(s, 50);
  for (std::size_t k = 30; k < steps.size(); ++k) {
    const RunStep& step = steps[k];
    EXPECT_LE(step.residual, 1e-3 * 9.81 * 0.01) << step.index;
    std::map<BodyPair, std::vector<Eigen::Vector3d>> touched;
    for (const RunContact& contact : step.contacts) {
      touched[contact.bodies].push_back(contact.point);
    }
    ASSERT_EQ(touched.size(), 10u + 2 * (9 + 8 + 7 + 6 + 5 + 4)) << step.index;
    for (const auto& [pair, points] : touched) {
      // Flush sides that are not quite parallel may cross: two more corners.
      ASSERT_GE(points.size(), 4u) << pair[0] << " " << pair[1] << " in " << step.index;
      ASSERT_LE(points.size(), 6u) << pair[0] << " " << pair[1] << " in " << step.index;
      Eigen::AlignedBox3d extent;
      for (const Eigen::Vector3d& point : points) {
        extent.extend(point);
      }
      EXPECT_NEAR(extent.sizes().x(), pair[0] == 0 ? 0.2 : 0.0995, 1e-3);
      EXPECT_NEAR(extent.sizes().y(), 0.1, 1e-3);
    }
  }
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

// Nothing can yield: time is lost, and nothing else.
TEST(Simulator, CrushedBodyStopsTime) {
  Simulator s = simulator(
      kFloor + "," + body("a", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.1001]", R"(, "dynamics": {})") +
          R"(,
      {"name": "press", "shape": {"box": {"size": [1, 1, 0.1]}},
       "motion": {"type": "waypoints", "times": [0, 1],
                  "poses": [{"position": [0, 0, 0.4]}, {"position": [0, 0, -0.1]}]}})",
      R"("step": 0.02, "duration": 1, "events": 50)");
  const auto steps = run(s, 20);
  double lost = 0.0;
  for (const RunStep& step : steps) {
    lost += step.time_lost;
    ASSERT_LE(step.kinetic_energy, 100.0);
  }
  EXPECT_GT(lost, 0.05);
  EXPECT_NEAR(steps.back().time, 0.4 - lost, 1e-12);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

}  // namespace
}  // namespace firstcontact
