// Simulations that take long under sanitizers.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dynamics/simulated_run.h"

namespace firstcontact {
namespace {

using test::body;
using test::box;
using test::kFloor;
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
  EXPECT_EQ(verify(s.header(), steps).verdict, RunVerdict::proven);
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
  EXPECT_EQ(verify(s.header(), steps).verdict, RunVerdict::proven);
}

}  // namespace
}  // namespace firstcontact
