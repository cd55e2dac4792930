// Scripts that would crush what cannot yield: time is lost, or they wait.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/record/run_step.h>
#include <firstcontact/simulation/simulator.h>
#include <firstcontact/verification/verify_run.h>

#include "simulation/simulated_run.h"

namespace firstcontact {
namespace {

using test::ball;
using test::body;
using test::box;
using test::kFloor;
using test::numbers;
using test::run;

constexpr double kApart = 1e-4;   // [m]  Contact distance.
constexpr std::size_t kLeft = 2;  // Index of the left jaw of the press.

/// A jaw whose face is 0.05 m inside of its place: 0.25 m from the middle at first, nearest at 1 s,
/// and where it was at 2 s.
///
/// @param nearest  [m]  of its place to the middle
std::string jaw(const std::string& name, double side, double nearest) {
  const auto at = [&](double x) {
    return R"({"position": )" + numbers({side * x, 0.0, 0.21}) + "}";
  };
  return R"({"name": ")" + name + R"(", "shape": )" + box("[0.1, 0.4, 0.4]") +
         R"(, "motion": {"type": "waypoints", "times": [0, 1, 2], "poses": [)" + at(0.3) + ", " +
         at(nearest) + ", " + at(0.3) + "]}}";
}

/// A cube of 0.2 m between jaws, and a ball that falls far away.
///
/// @param too_deep  [m]  so much farther than the cube allows a jaw would go
Simulator press(const std::string& more, double too_deep = 0.05) {
  return test::simulator(
      kFloor + ", " +
          body("cube", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.1001]", R"(, "dynamics": {"mass": 8})") +
          ", " + jaw("left", -1.0, 0.15 - too_deep) + ", " + jaw("right", 1.0, 0.15 - too_deep) +
          ", " + body("ball", ball("0.1"), "[3, 0, 100]", R"(, "dynamics": {"mass": 1})"),
      R"("duration": 2, )" + test::settings(0.01, 0.5, kApart) + more);
}

const RunBody& moved(const RunStep& step, std::size_t body) {
  return *std::ranges::find(step.bodies, body, &RunBody::body);
}

TEST(Waiting, APressWaitsAndOpensWhenItsScriptDoes) {
  Simulator s = press(R"(, "jams": "wait")");
  const std::vector<RunStep> steps = run(s, 200);
  for (const RunStep& step : steps) {
    EXPECT_EQ(step.time_lost, 0.0) << step.index;
    EXPECT_LE(step.events, 1u) << step.index;
    // Free fall goes on: what jams here stops nothing there.
    EXPECT_NEAR(moved(step, 4).X_WB.position.z(), 100.0 - 0.5 * 9.81 * step.time * step.time, 1e-9);
    // A jaw is where its script was so much earlier, or will be at the same place.
    const RunBody& left = moved(step, kLeft);
    const double t = step.time - left.behind;
    EXPECT_NEAR(left.X_WB.position.x(), t < 1.0 ? -0.3 + 0.2 * t : -0.1 - 0.2 * (t - 1.0), kApart)
        << step.index;
  }
  EXPECT_NEAR(moved(steps[99], kLeft).behind, 0.25, 0.02);  // It touched at 0.75 s.
  EXPECT_NEAR(moved(steps[99], kLeft).X_WB.position.x(), -0.15, 3.0 * kApart);
  EXPECT_LE(moved(steps[199], kLeft).behind, 0.01 + 1e-9);  // A step, as it looks back so far.
  const RunVerification proof = test::verify(s.header(), steps);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_NEAR(proof.greatest_behind, 0.5, 0.04);
}

// Steps are taken in two parts, of which the cube rests in both.
TEST(Waiting, WhatRestsInAPressBearsNoMoreThanItDid) {
  const std::string plate = R"({"name": "plate", "shape": {"box": {"size": [0.3, 0.3, 0.1]}},
      "motion": {"type": "waypoints", "times": [0, 1, 2], "poses": [{"position": [0, 0, 0.45]},
      {"position": [0, 0, 0.15]}, {"position": [0, 0, 0.45]}]}})";
  Simulator s = test::simulator(
      kFloor + ", " +
          body("cube", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.1001]", R"(, "dynamics": {"mass": 8})") +
          ", " + plate,
      R"("duration": 2, "jams": "wait", )" + test::settings(0.01, 0.5, kApart));
  const std::vector<RunStep> steps = run(s, 200);
  for (std::size_t k = 50; k < steps.size(); ++k) {
    for (const RunContact& contact : steps[k].contacts) {
      EXPECT_LE(contact.impulse.norm(), 2.0 * 8.0 * 9.81 * 0.01) << k;
    }
  }
}

// The script turns back within the step in which the jaws stop, or in one of the next.
TEST(Waiting, APressThatClosesALittleTooFarOpens) {
  for (const double too_deep : {1e-4, 3e-4, 1e-3, 2e-3, 5e-3}) {
    Simulator s = press(R"(, "jams": "wait")", too_deep);
    const std::vector<RunStep> steps = run(s, 200);
    EXPECT_LE(moved(steps.back(), kLeft).X_WB.position.x(), -0.29) << too_deep;
    EXPECT_LE(moved(steps.back(), kLeft).behind, 0.01) << too_deep;
    const RunVerification proof = test::verify(s.header(), steps);
    EXPECT_EQ(proof.verdict, ProofVerdict::proven) << too_deep << ' ' << proof.problem;
  }
}

// A ram presses a cube against a gate, which slides up after half a second. The ram waits, the gate
// must not: it crushes nothing.
TEST(Waiting, WhatMovesAlongAContactGoesOn) {
  const auto scripted = [](const std::string& name, const std::string& size,
                           const std::string& way) {
    return R"({"name": ")" + name + R"(", "shape": )" + box(size) +
           R"(, "motion": {"type": "waypoints", "times": [0, 0.5, 1], "poses": [)" + way + "]}}";
  };
  Simulator s = test::simulator(
      kFloor + ", " +
          body("cube", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.1001]", R"(, "dynamics": {"mass": 8})") +
          ", " +
          scripted("ram", "[0.1, 0.1, 0.1]",
                   R"({"position": [-0.2, 0, 0.1]}, {"position": [-0.1, 0, 0.1]},
                      {"position": [0, 0, 0.1]})") +
          ", " +
          scripted("gate", "[0.1, 0.4, 0.4]",
                   R"({"position": [0.17, 0, 0.21]}, {"position": [0.17, 0, 0.21]},
                      {"position": [0.17, 0, 1.21]})"),
      R"("duration": 1.5, "jams": "wait", )" + test::settings(0.01, 0.2, kApart));
  const std::vector<RunStep> steps = run(s, 150);
  EXPECT_LE(moved(steps.back(), 3).behind, 0.02);
  EXPECT_NEAR(moved(steps.back(), 3).X_WB.position.z(), 1.21, 1e-6);
  EXPECT_GT(moved(steps[60], 2).behind, 0.05);
  EXPECT_EQ(moved(steps.back(), 2).behind, 0.0);  // Its script has stood at its end for long.
  EXPECT_NEAR(moved(steps.back(), 2).X_WB.position.x(), 0.0,
              1e-6);  // The cube went out of its way.
  EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven);
}

TEST(Waiting, WithoutItTimeIsLostAtLittleWork) {
  Simulator s = press("");
  const std::vector<RunStep> steps = run(s, 120);
  EXPECT_NEAR(steps.back().time, 0.75, 0.01);
  for (std::size_t k = 80; k < steps.size(); ++k) {  // Once it is jammed.
    EXPECT_NEAR(steps[k].time_lost, 0.01, 1e-6);
    EXPECT_LE(steps[k].events, 1u);
  }
  EXPECT_EQ(moved(steps.back(), kLeft).behind, 0.0);
  EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven);
}

TEST(Waiting, ARunThatWaitsIsResumedBitForBit) {
  for (const char* jams : {"", R"(, "jams": "wait")"}) {
    Simulator s = press(jams);
    const std::vector<RunStep> steps = run(s, 90);
    for (const std::size_t last : {60, 76, 78, 85}) {
      Simulator resumed = press(jams);
      resumed.resume(steps[last]);
      const RunStep next = resumed.step().value();
      EXPECT_EQ(next.time, steps[last + 1].time);
      EXPECT_EQ(next.events, steps[last + 1].events);
      for (std::size_t b = 0; b < next.bodies.size(); ++b) {
        EXPECT_EQ(next.bodies[b].behind, steps[last + 1].bodies[b].behind);
        EXPECT_EQ(next.bodies[b].X_WB.position, steps[last + 1].bodies[b].X_WB.position);
        EXPECT_EQ(next.bodies[b].linear_velocity, steps[last + 1].bodies[b].linear_velocity);
      }
    }
  }
}

// A beam turns until a block is wedged between it and a wall. When that is gone it goes on.
TEST(Waiting, WhatTurnsGoesOnWhereItStoodStill) {
  const std::string beam = R"({"name": "beam", "shape": )" + box("[1, 0.1, 0.1]") +
                           R"(, "motion": {"type": "screw", "from": {"position": [0, 0, 0]},
      "axis_point": [0, 0, 0], "axis_direction": [0, 0, 1], "angle": 3.141592653589793,
      "translation": 0}})";
  Simulator s = test::simulator(
      body("wall", box("[0.6, 0.1, 0.4]"), "[0.45, 0.4, 0]") + ", " + beam + ", " +
          body("block", box("[0.1, 0.1, 0.1]"), "[0.35, 0.25, 0]", R"(, "dynamics": {"mass": 1})"),
      R"("duration": 2, "jams": "wait", "gravity": [0, 0, 0], )" +
          test::settings(0.01, 1.0, kApart));
  constexpr std::size_t kBeam = 1;
  std::vector<RunStep> steps = run(s, 60);
  const double behind = moved(steps.back(), kBeam).behind;
  ASSERT_GT(behind, 0.05);
  EXPECT_EQ(moved(steps.back(), kBeam).angular_velocity.norm(), 0.0);
  EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven);
  s.set_state(2, {.X_WB = {{5.0, 5.0, 0.0}, Eigen::Quaterniond::Identity()}});
  steps = run(s, 10);
  for (const RunStep& step : steps) {
    EXPECT_NEAR(moved(step, kBeam).behind, behind, 1e-12) << step.index;
    EXPECT_NEAR(moved(step, kBeam).angular_velocity.z(), 0.5 * std::numbers::pi, 1e-9);
  }
}

}  // namespace
}  // namespace firstcontact
