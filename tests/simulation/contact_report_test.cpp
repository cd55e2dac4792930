// The contacts and impacts that a step reports are all that contacts did in it.

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/record/run.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation/simulator.h>

#include "simulation/simulated_run.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::ball;
using test::body;
using test::box;
using test::kFloor;
using test::numbers;
using test::run;

constexpr double kStep = 0.01;  // [s]
constexpr double kMass = 2.0;   // [kg]
const Vector3d kGravity(0.0, 0.0, -9.81);

/// Cubes and balls above each other, turned, some of which bounce.
std::string falling_bodies() {
  std::string bodies;
  for (int k = 0; k < 10; ++k) {
    const double side = 0.12 + 0.01 * k;
    const std::string shape = k % 3 == 2 ? ball("0.08") : box(numbers({side, 0.15, 0.2}));
    const std::string bounce = k % 2 == 0 ? "0.5" : "0";
    bodies += R"(, {"name": "b)" + std::to_string(k) + R"(", "shape": )" + shape +
              R"(, "pose": {"position": )" +
              numbers({0.05 * (k % 3) - 0.05, 0.04 * (k % 4) - 0.06, 0.4 + 0.32 * k}) +
              R"(, "rpy": )" + numbers({0.3 * k, 0.2 * k, 0.1}) +
              R"(}, "dynamics": {"mass": 2, "restitution": )" + bounce + "}}";
  }
  return bodies;
}

/// Goes round far away, so that steps are taken in parts.
const std::string kFan = R"(, {"name": "fan", "shape": {"box": {"size": [0.4, 0.1, 0.1]}}, "motion":
    {"type": "screw", "from": {"position": [0, 9, 9]}, "axis_direction": [0, 0, 1], "angle": 6}})";

/// Turns right above the floor.
const std::string kPaddle = R"(, {"name": "paddle", "shape": {"box": {"size": [1.4, 0.04, 0.1]}},
    "motion": {"type": "screw", "from": {"position": [0, 0, 0.06]}, "axis_direction": [0, 0, 1],
               "angle": 6}})";

/// [-]  Computes the greatest unexplained change of a free body's momentum.
///
/// Neither gravity nor the impulses that the steps report account for it. The unit is weight times
/// step.
double greatest_gap(const std::vector<RunStep>& steps, std::size_t first, std::size_t end) {
  std::map<std::size_t, Vector3d> before;
  double greatest = 0.0;
  for (const RunStep& step : steps) {
    std::map<std::size_t, Vector3d> impulses;
    const auto add = [&](const BodyPair& bodies, const Vector3d& impulse) {
      impulses.try_emplace(bodies[0], Vector3d::Zero()).first->second -= impulse;
      impulses.try_emplace(bodies[1], Vector3d::Zero()).first->second += impulse;
    };
    for (const RunContact& contact : step.contacts) {
      add(contact.bodies, contact.impulse);
    }
    for (const RunImpact& impact : step.impacts) {
      EXPECT_TRUE(impact.at >= 0.0 && impact.at <= step.lasted);
      add(impact.bodies, impact.impulse);
    }
    for (const RunBody& moved : step.bodies) {
      if (moved.body < first || moved.body >= end) {
        continue;
      }
      const Vector3d was = before.contains(moved.body) ? before[moved.body] : Vector3d::Zero();
      const Vector3d change = kMass * (moved.linear_velocity - was - step.lasted * kGravity);
      impulses.try_emplace(moved.body, Vector3d::Zero());
      const double unsaid = (change - impulses[moved.body]).norm();
      greatest = std::max(greatest, unsaid / (kMass * kGravity.norm() * kStep));
      before[moved.body] = moved.linear_velocity;
    }
  }
  return greatest;
}

std::vector<RunStep> steps_of(const std::string& bodies) {
  Simulator simulator = test::simulator(bodies, test::settings(kStep, 0.4, 1e-4));
  std::vector<RunStep> steps = run(simulator, 100);
  EXPECT_TRUE(std::ranges::all_of(steps, [](const RunStep& s) { return s.time_lost == 0.0; }));
  return steps;
}

bool has_impacts(const RunStep& step) { return !step.impacts.empty(); }

TEST(ContactReport, AddsUpToTheChangeOfMomentum) {
  const std::vector<RunStep> steps = steps_of(kFloor + falling_bodies());
  EXPECT_GT(std::ranges::count_if(steps, has_impacts), 5);
  EXPECT_LE(greatest_gap(steps, 1, 11), 1e-5);
}

// A ball that falls dead is at rest from a part of the step on: what it bore in this step is no
// measure of what it bears.
TEST(ContactReport, AddsUpWhereABallFallsDead) {
  const std::string falls =
      body("ball", ball("0.05"), "[1, 1, 0.2]", R"(, "dynamics": {"mass": 2})");
  const std::vector<RunStep> steps = steps_of(kFloor + ", " + falls + kFan);
  EXPECT_LE(greatest_gap(steps, 1, 2), 1e-5);
  EXPECT_TRUE(std::ranges::find(steps.back().bodies, std::size_t{1}, &RunBody::body)->rests);
}

// Steps are taken in parts, and some pairs part in the middle of a step.
TEST(ContactReport, AddsUpWhereScriptsBend) {
  EXPECT_LE(greatest_gap(steps_of(kFloor + falling_bodies() + kFan), 1, 11), 1e-5);
  EXPECT_LE(greatest_gap(steps_of(kFloor + falling_bodies() + kFan + kPaddle), 1, 11), 1e-5);
}

// A contact between bodies that turn is written as it acted, not as its normal is by then.
TEST(ContactReport, AddsUpWhereContactsTurn) {
  const std::string tumbles = body("a", box("[0.2, 0.2, 0.2]"), "[0, 0, 0]",
                                   R"(, "dynamics": {"mass": 2, "linear_velocity": [1, 0, 0],
                             "angular_velocity": [0.1, 0.4, 3]})");
  const std::string hit =
      body("b", box("[0.2, 0.2, 0.2]"), "[0.35, 0.05, 0.02]", R"(, "dynamics": {"mass": 2})");
  Simulator simulator = test::simulator(tumbles + ", " + hit, test::settings(kStep, 0.0, 1e-4));
  EXPECT_LE(greatest_gap(run(simulator, 50), 1, 2), 1e-5);
  const std::string belt = body("belt", box("[9, 9, 1]"), "[0, 0, -0.5]",
                                R"(, "surface": {"velocity": [2, 0, 0], "friction": 0.3})");
  const std::string rolls =
      body("ball", ball("0.1"), "[0, 0, 0.1001]", R"(, "dynamics": {"mass": 2})");
  Simulator on_belt = test::simulator(belt + ", " + rolls, test::settings(kStep, 0.3, 1e-4));
  EXPECT_LE(greatest_gap(run(on_belt, 20), 1, 2), 1e-5);
}

/// [m]  Computes the greatest arm by which the impulses that steps report would have to act
/// elsewhere to account for the turning of the only free body.
double greatest_missing_arm(const RunHeader& header, const std::vector<RunStep>& steps) {
  double greatest = 0.0;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const RunStep& step = steps[k];
    Vector3d missing = step.angular_momentum - steps[k - 1].angular_momentum;
    double pressed = 0.0;
    const auto take = [&](const BodyPair& bodies, const Vector3d& point, const Vector3d& impulse) {
      missing -= (bodies[0] == 0 ? -1.0 : 1.0) * point.cross(impulse);
      pressed += impulse.norm();
    };
    for (const RunContact& contact : step.contacts) {
      take(contact.bodies, contact.point, contact.impulse);
    }
    for (const RunImpact& impact : step.impacts) {
      take(impact.bodies, impact.point, impact.impulse);
    }
    const Vector3d centre =
        0.5 * (steps[k - 1].bodies[0].X_WB.position + step.bodies[0].X_WB.position);
    missing -= centre.cross(header.masses[0] * step.lasted * kGravity);
    if (pressed > 0.1) {
      greatest = std::max(greatest, missing.norm() / pressed);
    }
  }
  return greatest;
}

// Both ends of a capsule strike a cylinder in one step. The impulse at the first end was reported
// at the second one, 0.14 m away. A step later the plan foresees where the lines cross halfway; the
// impulse acts there, 0.049 m from where the contact then is.
TEST(ContactReport, ExplainsTheTurnOfACapsuleOnBothEnds) {
  ShapeCache cache;
  Simulator simulator(load_scene(
      read_scene(FIRSTCONTACT_SOURCE_DIR "/tests/data/regressions/capsule_gains_on_cylinder.json"),
      cache));
  EXPECT_LE(greatest_missing_arm(simulator.header(), run(simulator, 160)), 0.05);
}

}  // namespace
}  // namespace firstcontact
