// Bodies that nothing outside holds: their angular momentum, whatever ties and contacts do.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "island/tie_laws.h"
#include "simulation/simulated_run.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::body;
using test::box;
using test::energy_of;
using test::number_text;
using test::run;
using test::simulator;
using test::tie_settings;

const std::string kBrick = box("[0.2, 0.1, 0.06]");

std::string moving(const std::string& v, const std::string& w, const std::string& more = "") {
  return R"(, "dynamics": {"linear_velocity": )" + v + R"(, "angular_velocity": )" + w + more + "}";
}

/// Two bricks 0.25 m apart that turn about each other at a rate [rad/s], and tumble a little.
std::string pair_at(double rate) {
  return body("a", kBrick, "[0, 0, 0]",
              moving("[0, 0, 0]", "[0.3, 1, " + number_text(rate) + "]")) +
         "," +
         body("b", kBrick, "[0.25, 0, 0]",
              moving("[0, " + number_text(0.25 * rate) + ", 0.1]",
                     "[1, 0.3, " + number_text(rate) + "]"));
}

void expect_kept(const std::vector<RunStep>& steps, const std::string& what) {
  const Vector3d first = steps.front().angular_momentum;
  for (const RunStep& step : steps) {
    ASSERT_LE((step.angular_momentum - first).norm(), 1e-12 * first.norm()) << what;
    ASSERT_EQ(step.time_lost, 0.0) << what;
  }
}

TEST(LooseIsland, TiesKeepTheAngularMomentum) {
  const std::string ends = R"("bodies": ["a", "b"], "points": [[0.125, 0, 0], [-0.125, 0, 0]])";
  const std::string corners =
      R"("bodies": ["a", "b"], "points": [[0.1, 0, 0.03], [-0.1, 0.05, 0]])";
  for (const std::string& tie :
       {R"({"type": "pin", )" + ends + "}", R"({"type": "hinge", "axis": [0, 0, 1], )" + ends + "}",
        R"({"type": "weld", )" + ends + "}",
        R"({"type": "cable", "length": 0.12, )" + corners + "}",
        R"({"type": "spring", "stiffness": 300, )" + corners + "}",
        R"({"type": "spring", "stiffness": 300, "damping": 3000, )" + corners + "}"}) {
    for (const double rate : {3.0, 30.0, 100.0}) {
      Simulator s = simulator(pair_at(rate), tie_settings(0.01, tie, false));
      expect_kept(run(s, 100), tie + " at " + number_text(rate));
    }
  }
}

// Before, the weld lost 6e-4 of it, and with it as much of the angular momentum.
TEST(LooseIsland, JointsOfFastBodiesKeepTheEnergy) {
  for (const std::string type : {"hinge", "weld"}) {
    const std::string axis = type == "hinge" ? R"("axis": [0, 0, 1], )" : "";
    Simulator s = simulator(
        pair_at(30.0), tie_settings(0.01,
                                    R"({"type": ")" + type + R"(", )" + axis +
                                        R"("bodies": ["a", "b"], "points": [[0.125, 0, 0], null]})",
                                    false));
    const std::vector<RunStep> steps = run(s, 100);
    EXPECT_NEAR(energy_of(steps.back()), energy_of(steps.front()), 3e-6 * energy_of(steps.front()))
        << type;
  }
}

TEST(LooseIsland, CollisionsKeepTheAngularMomentum) {
  const std::string bricks =
      body("a", kBrick, "[0, 0, 0]", moving("[0, 0, 0]", "[1, 2, 3]")) + "," +
      body("b", kBrick, "[0.5, 0.05, 0.02]", moving("[-5, 0, 0]", "[2, -1, 4]")) + "," +
      body("c", kBrick, "[0.1, -0.4, 0]", moving("[0, 4, 0]", "[0, 5, 1]"));
  for (const std::string laws :
       {R"("restitution": 0, "friction": 0)", R"("restitution": 0, "friction": 0.8)",
        R"("restitution": 0.6, "friction": 0.3)"}) {
    Simulator s = simulator(bricks, R"("step": 0.01, "gravity": [0, 0, 0], )" + laws);
    const std::vector<RunStep> steps = run(s, 30);
    expect_kept(steps, laws);
    EXPECT_LE(steps.back().kinetic_energy, 0.9 * steps.front().kinetic_energy) << laws;
  }
}

TEST(LooseIsland, ATorqueChangesTheAngularMomentum) {
  const std::string torque = R"(, "forces": [{"from": 0, "to": 10, "torque": [0.2, -0.1, 0.3]}])";
  const std::string bodies =
      body("a", kBrick, "[0, 0, 0]", moving("[0, 0, 0]", "[0, 1, 5]", torque)) + "," +
      body("b", kBrick, "[0.25, 0, 0]", moving("[0, 1.25, 0]", "[0, 1, 5]"));
  Simulator s = simulator(
      bodies, tie_settings(
                  0.01, R"({"type": "pin", "bodies": ["a", "b"], "points": [[0.125, 0, 0], null]})",
                  false));
  const std::vector<RunStep> steps = run(s, 100);
  const Vector3d change = steps.back().angular_momentum - steps.front().angular_momentum;
  EXPECT_LE((change - 0.99 * Vector3d(0.2, -0.1, 0.3)).norm(), 1e-12);
}

}  // namespace
}  // namespace firstcontact
