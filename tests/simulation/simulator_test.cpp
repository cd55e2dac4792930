#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/record/write_run.h>

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
using test::settings;
using test::simulator;
using test::verify;

const std::string kFree = R"(, "dynamics": {})";

// --- Closed forms --------------------------------------------------------------------------------

// A force too great for doubles, in the second of the parts into which a script with kinks takes
// the step: a step is taken whole, or nothing has changed.
TEST(Simulator, AStepThatThrowsChangesNothing) {
  std::string times = "0";
  std::string poses = R"({"position": [-5, 0, 10]})";
  for (int k = 1; k < 100; ++k) {
    times += ", " + std::to_string(0.003 * k);
    poses += std::string(R"(, {"position": [)") + (k % 2 == 0 ? "-5" : "-4.95") + ", 0, 10]}";
  }
  const std::string far = R"({"name": "far", "shape": {"sphere": {"radius": 0.01}}, "motion":
      {"type": "waypoints", "times": [)" +
                          times + R"(], "poses": [)" + poses + "]}}";
  const std::string light = body("light", test::ball("0.1"), "[0, 0, 0]",
                                 R"(, "dynamics": {"mass": 1e-12, "linear_velocity": [1, 0, 0],
      "forces": [{"from": 0.016, "to": 1, "force": [1e58, 0, 0]}]})");
  Simulator s =
      simulator(far + "," + light, R"("step": 0.01, "duration": 0.1, "gravity": [0, 0, 0])");
  ASSERT_TRUE(s.step());
  const double time = s.time();
  const Eigen::Vector3d at = s.states()[1].X_WB.position;
  EXPECT_THROW(static_cast<void>(s.step()), std::invalid_argument);
  EXPECT_EQ(s.time(), time);
  EXPECT_EQ(s.step_count(), 1u);
  EXPECT_EQ(s.states()[1].X_WB.position, at);
}

TEST(Simulator, FreeFlightIsExact) {
  Simulator s = simulator(
      body("a", box("[1, 2, 3]"), "[0, 0, 0]", R"(, "dynamics": {"linear_velocity": [1, 2, 3]})"),
      R"("step": 0.01, "gravity": [0, 0, -10])");
  const RunStep last = run(s, 100).back();
  EXPECT_NEAR(last.bodies[0].X_WB.position.x(), 1.0, 1e-12);
  EXPECT_NEAR(last.bodies[0].X_WB.position.z(), 3.0 - 5.0, 1e-12);
  EXPECT_NEAR(last.bodies[0].linear_velocity.z(), -7.0, 1e-12);
}

TEST(Simulator, KeepsNothingApartWhereThereIsNoPair) {
  // Alone; and scripted bodies pass through each other.
  const std::string script = R"({"name": "b", "shape": {"sphere": {"radius": 0.1}},
      "motion": {"type": "constant_velocity", "from": {"position": [1, 0, 0]},
                 "translation": [-2, 0, 0]}})";
  const std::string fixed = body("a", ball("0.1"), "[0, 0, 0]");
  for (const std::string& bodies :
       {body("a", ball("0.1"), "[0, 0, 0]", kFree), fixed + ", " + script}) {
    Simulator s = simulator(bodies, R"("duration": 1, "step": 0.1)");
    for (const RunStep& step : run(s, 10)) {
      EXPECT_EQ(step.clearance, std::numeric_limits<double>::infinity());
      EXPECT_NE(write_run_step(step).find(R"("clearance":null)"), std::string::npos);
    }
  }
  Simulator pair = simulator(body("b", ball("0.1"), "[0, 0, 5]", kFree) + ", " + fixed,
                             R"("duration": 1, "step": 0.1)");
  EXPECT_LT(run(pair, 1).back().clearance, 1e-3);
}

TEST(Simulator, TimedForcesActWhileTheyLast) {
  Simulator s = simulator(
      body(
          "a", ball("0.1"), "[0, 0, 0]",
          R"(, "dynamics": {"mass": 2, "forces": [{"from": 0.105, "to": 0.305, "force": [10, 0, 0]}]})"),
      R"("step": 0.01, "gravity": [0, 0, 0])");
  const RunStep last = run(s, 50).back();
  EXPECT_NEAR(last.bodies[0].linear_velocity.x(), 10.0 / 2.0 * 0.2, 1e-12);
}

/// The greatest change of energy of a torque-free body that flips about its intermediate axis.
double energy_drift(double step) {
  Simulator s = simulator(body("a", box("[0.1, 0.2, 0.4]"), "[0, 0, 0]",
                               R"(, "dynamics": {"angular_velocity": [0.01, 6, 0.01]})"),
                          R"("gravity": [0, 0, 0], "step": )" + std::to_string(step));
  const auto steps = run(s, static_cast<std::size_t>(std::lround(6.0 / step)));
  double drift = 0.0;
  bool flipped = false;
  for (const RunStep& at : steps) {
    drift = std::max(drift, std::abs(at.kinetic_energy / steps[0].kinetic_energy - 1.0));
    EXPECT_LE((at.angular_momentum - steps[0].angular_momentum).norm(),
              1e-10 * steps[0].angular_momentum.norm());
    // The body's y axis turns against the momentum.
    flipped = flipped || (at.bodies[0].X_WB.rotation * Vector3d::UnitY()).y() < -0.9;
  }
  EXPECT_TRUE(flipped);
  return drift;
}

TEST(Simulator, IntermediateAxisFlipsAndKeepsMomentumAndEnergy) {
  EXPECT_LE(energy_drift(0.01), 1e-11);
  EXPECT_LE(energy_drift(0.0025), 1e-11);
}

/// [-]  The most that a step adds to the energy of a body that tumbles down on a floor, by that of
/// a lift by the contact distance.
double greatest_gain(const std::string& size, const std::string& velocity,
                     const std::string& step) {
  Simulator s = simulator(body("floor", box("[9, 9, 0.2]"), "[0, 0, -0.1]") + "," +
                              body("a", box(size), "[0, 0, 0.8]",
                                   R"(, "dynamics": {"angular_velocity": )" + velocity + "}"),
                          R"("restitution": 1, "friction": 0.3, "step": )" + step);
  const auto steps = run(s, 200);
  const auto total = [](const RunStep& at) { return at.kinetic_energy + at.potential_energy; };
  double gain = 0.0;  // [J]
  std::size_t events = 0;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    gain = std::max(gain, total(steps[k]) - total(steps[k - 1]));
    events += steps[k].events;
  }
  EXPECT_GT(events, 0u);
  const double lift = 9.81 * s.header().masses[1] * *s.header().scene.simulation->contact_distance;
  return gain / lift;
}

// Impacts met bodies with the inertia of another orientation than their angular velocity was meant
// for, and what tumbles fast drew energy from it.
TEST(Simulator, TumblingBodiesGainNothingFromImpacts) {
  EXPECT_LE(greatest_gain("[0.3, 0.2, 0.1]", "[2, 3, 1]", "0.04"), 1.0);
  EXPECT_LE(greatest_gain("[0.5, 0.05, 0.05]", "[40, 30, 20]", "0.01"), 1.0);
  EXPECT_LE(greatest_gain("[0.5, 0.01, 0.01]", "[1, 100, 3]", "0.01"), 1.0);
}

TEST(Simulator, ElasticBallsExchangeTheirVelocities) {
  Simulator s = simulator(
      body("a", ball("0.1"), "[0, 0, 0]", R"(, "dynamics": {"linear_velocity": [1, 0, 0]})") + "," +
          body("b", ball("0.1"), "[0.5, 0, 0]", R"(, "dynamics": {"linear_velocity": [-2, 0, 0]})"),
      R"("step": 0.01, "gravity": [0, 0, 0], "restitution": 1)");
  const auto steps = run(s, 30);
  EXPECT_NEAR(steps.back().bodies[0].linear_velocity.x(), -2.0, 1e-10);
  EXPECT_NEAR(steps.back().bodies[1].linear_velocity.x(), 1.0, 1e-10);
  EXPECT_LE((steps.back().linear_momentum - steps[0].linear_momentum).norm(), 1e-10);
  EXPECT_LE((steps.back().angular_momentum - steps[0].angular_momentum).norm(), 1e-10);
  EXPECT_NEAR(steps.back().kinetic_energy, steps[0].kinetic_energy, 1e-10);
  // They meet after 0.3 m at 3 m/s, in the middle of their gap.
  std::vector<RunImpact> impacts;
  for (const RunStep& step : steps) {
    for (RunImpact impact : step.impacts) {
      impact.at += step.time - step.lasted;
      impacts.push_back(impact);
    }
  }
  ASSERT_EQ(impacts.size(), 1u);
  EXPECT_NEAR(impacts[0].at, 0.1, 1e-3);
  EXPECT_EQ(impacts[0].bodies, (BodyPair{0, 1}));
  EXPECT_NEAR(impacts[0].point.x(), 0.2, 1e-3);
  EXPECT_NEAR(impacts[0].impulse.x(), 3.0 * s.header().masses[1], 1e-9);
}

TEST(Simulator, InelasticBallsGoOnTogether) {
  Simulator s = simulator(
      body("a", ball("0.1"), "[0, 0, 0]", R"(, "dynamics": {"linear_velocity": [1, 0, 0]})") + "," +
          body("b", ball("0.1"), "[0.5, 0, 0]", kFree),
      R"("step": 0.01, "gravity": [0, 0, 0], "restitution": 0)");
  const auto steps = run(s, 60);
  EXPECT_NEAR(steps.back().bodies[0].linear_velocity.x(), 0.5, 1e-8);
  EXPECT_NEAR(steps.back().bodies[1].linear_velocity.x(), 0.5, 1e-8);
  EXPECT_LE((steps.back().linear_momentum - steps[0].linear_momentum).norm(), 1e-10);
}

// Gaps of 0.1 mm: the impacts come one after the other, and only the last ball leaves.
TEST(Simulator, NewtonsCradleHandsTheImpactOn) {
  std::string balls =
      body("b0", ball("0.05"), "[-0.2, 0, 0]", R"(, "dynamics": {"linear_velocity": [1, 0, 0]})");
  for (int k = 1; k < 5; ++k) {
    balls += "," + body("b" + std::to_string(k), ball("0.05"),
                        "[" + std::to_string(0.1001 * (k - 1)) + ", 0, 0]", kFree);
  }
  Simulator s = simulator(balls, R"("step": 0.01, "gravity": [0, 0, 0], "restitution": 1)");
  const RunStep last = run(s, 30).back();
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(last.bodies[k].linear_velocity.x(), 0.0, 1e-9) << k;
  }
  EXPECT_NEAR(last.bodies[4].linear_velocity.x(), 1.0, 1e-9);
}

// A rod falls flat on a ball under its end: v' = v - J / m, w = J r / I with J = m v / (1 + m r^2 /
// I).
TEST(Simulator, RodTurnsAboutWhatStruckIt) {
  Simulator s =
      simulator(body("rod", box("[1, 0.02, 0.02]"), "[0, 0, 0.2]",
                     R"(, "dynamics": {"linear_velocity": [0, 0, -1]})") +
                    "," + body("ball", ball("0.05"), "[0.45, 0, 0]"),
                R"("step": 0.001, "gravity": [0, 0, 0], "restitution": 0, "friction": 0)");
  std::vector<RunStep> steps = run(s, 150);
  const double inertia = (1.0 + 0.02 * 0.02) / 12.0;  // Over the mass.
  const double J = 1.0 / (1.0 + 0.45 * 0.45 / inertia);
  EXPECT_NEAR(steps.back().bodies[0].linear_velocity.z(), -1.0 + J, 2e-3);
  EXPECT_NEAR(steps.back().bodies[0].angular_velocity.y(), -J * 0.45 / inertia, 1e-2);
}

/// Down a slope of tan = 1/2 after a second; the slope is a floor under tilted gravity.
double slid(double friction) {
  const double g = 9.81;
  const double c = 2.0 / std::sqrt(5.0);
  Simulator s =
      simulator(kFloor + "," + body("a", box("[0.5, 0.5, 0.5]"), "[0, 0, 0.25005]", kFree),
                R"("step": 0.01, "friction": )" + std::to_string(friction) + R"(, "gravity": [)" +
                    std::to_string(0.5 * c * g) + ", 0, " + std::to_string(-c * g) + "]");
  return run(s, 100).back().bodies[0].X_WB.position.x();
}

TEST(Simulator, SticksOnASlopeUpToTheFrictionAngle) {
  EXPECT_NEAR(slid(0.501), 0.0, 1e-4);
  const double c = 2.0 / std::sqrt(5.0);
  EXPECT_NEAR(slid(0.4), 0.5 * 9.81 * (0.5 - 0.4) * c, 1e-3);
}

TEST(Simulator, BouncesToTheHeightThatRestitutionLeaves) {
  Simulator s = simulator(kFloor + "," + body("a", ball("0.1"), "[0, 0, 1.1]", kFree),
                          R"("step": 0.005, "restitution": 0.8)");
  double highest = 0.0;
  double momentum = 0.0;
  bool bounced = false;
  for (const RunStep& step : run(s, 200)) {
    bounced = bounced || step.bodies[0].linear_velocity.z() > 0.0;
    highest = bounced ? std::max(highest, step.bodies[0].X_WB.position.z()) : highest;
    // Impacts and gravity are all that changes its momentum.
    double impulse = -9.81 * s.header().masses[1] * step.lasted;
    for (const RunImpact& impact : step.impacts) {
      impulse += impact.impulse.z();
    }
    EXPECT_NEAR(step.linear_momentum.z() - momentum, impulse, 1e-9) << step.index;
    momentum = step.linear_momentum.z();
  }
  EXPECT_NEAR(highest, 0.1 + 0.64, 2e-3);
}

// However few events a step may have: what bounces at its begin goes on from there.
TEST(Simulator, BouncesWithOneEventInAStep) {
  Simulator s = simulator(kFloor + "," + body("a", ball("0.1"), "[0, 0, 0.4]", kFree),
                          R"("step": 0.01, "restitution": 0.8, "events": 1)");
  double lost = 0.0;
  double highest = 0.0;
  bool bounced = false;
  for (const RunStep& step : run(s, 100)) {
    lost += step.time_lost;
    bounced = bounced || step.bodies[0].linear_velocity.z() > 0.0;
    highest = bounced ? std::max(highest, step.bodies[0].X_WB.position.z()) : highest;
  }
  EXPECT_LE(lost, 0.02);
  EXPECT_NEAR(highest, 0.1 + 0.64 * 0.3, 5e-3);
}

// --- Nothing interpenetrates
// -----------------------------------------------------------------------

TEST(Simulator, NothingTunnelsThroughAThinPlate) {
  for (const double speed : {20.0, 200.0, 2000.0}) {
    for (const double spin : {0.0, 1000.0}) {
      Simulator s =
          simulator(body("plate", box("[0.0001, 1, 1]"), "[0, 0, 0]") + "," +
                        body("shot", box("[0.01, 0.01, 0.01]"), "[-0.1, 0.013, 0.007]",
                             R"(, "dynamics": {"linear_velocity": [)" + std::to_string(speed) +
                                 R"(, 0, 0], "angular_velocity": [0, )" + std::to_string(spin) +
                                 ", " + std::to_string(0.3 * spin) + "]}"),
                    R"("step": 0.016666666666666666, "gravity": [0, 0, 0])");
      const auto steps = run(s, 3);
      EXPECT_LT(steps.back().bodies[0].X_WB.position.x(), 0.0) << speed << " " << spin;
      EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven) << speed << " " << spin;
    }
  }
}

// Two that never come near each other do not share their impacts.
TEST(Simulator, IslandsAdvanceApart) {
  const std::string falling = body("a", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.3]", kFree);
  Simulator alone = simulator(kFloor + "," + falling, R"("step": 0.01)");
  Simulator both = simulator(kFloor + "," + falling + "," +
                                 body("b", box("[0.2, 0.2, 0.2]"), "[2, 0, 0.31]",
                                      R"(, "dynamics": {"angular_velocity": [4, 5, 6]})"),
                             R"("step": 0.01)");
  const auto first = run(alone, 60);
  const auto second = run(both, 60);
  for (std::size_t k = 0; k < first.size(); ++k) {
    ASSERT_EQ(first[k].bodies[0].X_WB.position, second[k].bodies[0].X_WB.position) << k;
    ASSERT_EQ(first[k].bodies[0].angular_velocity, second[k].bodies[0].angular_velocity) << k;
  }
}

TEST(Simulator, ScriptedBodiesPushOthers) {
  Simulator s = simulator(body("a", ball("0.1"), "[0, 0, 0]", kFree) + R"(,
      {"name": "pusher", "shape": {"sphere": {"radius": 0.1}},
       "motion": {"type": "waypoints", "times": [0, 1],
                  "poses": [{"position": [-0.5, 0, 0]}, {"position": [0.5, 0, 0]}]}})",
                          R"("step": 0.01, "duration": 1, "gravity": [0, 0, 0])");
  const auto steps = run(s, 100);
  EXPECT_GT(steps.back().bodies[0].X_WB.position.x(), 0.7);
  EXPECT_NEAR(steps.back().bodies[0].linear_velocity.x(), 1.0, 1e-6);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

void expect_no_lost_time(const std::string& scene, int steps) {
  ShapeCache cache;
  Simulator s(load_scene(
      read_scene(std::string(FIRSTCONTACT_SOURCE_DIR "/tests/data/regressions/") + scene), cache));
  double lost = 0.0;
  const auto found = run(s, steps);
  for (const RunStep& step : found) {
    lost += step.time_lost;
  }
  EXPECT_EQ(lost, 0.0);
  EXPECT_EQ(verify(s.header(), found).verdict, ProofVerdict::proven);
}

// A soup spins so fast that its corners dip below what is linear in the rest of a step: each impact
// halved what was left, until no time passed any more.
TEST(Simulator, FastSpinDoesNotJam) { expect_no_lost_time("spinning_soup_jams.json", 90); }

// Two links of a chain were pushed apart where they were too near, and by that against each other
// where they had been beyond the band, however often that contact was found.
TEST(Simulator, PushesApartDoNotJamOnAnotherSide) {
  expect_no_lost_time("chain_pushed_into_its_other_side.json", 10);
}

// A rod turns about its middle. What leads it away from a block beside that leads its end ten times
// as far, against a block that it did not touch before.
TEST(Simulator, PushesApartHeedBodiesThatCameAfterThem) {
  Simulator s =
      simulator(body("rod", box("[2, 0.1, 0.1]"), "[0, 0, 0]",
                     R"(, "dynamics": {"locked_translation": [true, true, true]})") +
                    "," + body("near", box("[0.02, 0.2, 0.1]"), "[0.1, 0, 0.1001]", "") + "," +
                    body("far", box("[0.02, 0.2, 0.1]"), "[-0.95, 0, 0.1025]", ""),
                R"("step": 0.01, "duration": 1, "gravity": [0, 0, 0], "contact_distance": 1e-3)");
  double lost = 0.0;
  const auto steps = run(s, 20);
  for (const RunStep& step : steps) {
    lost += step.time_lost;
  }
  EXPECT_EQ(lost, 0.0);
  // It turned until its end was where it rests, or nearly so.
  const double turned = 2.0 * std::asin(steps.back().bodies[0].X_WB.rotation.vec().norm());
  EXPECT_GT(turned, 1.0e-3);
  EXPECT_LT(turned, 2.0e-3);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

// --- The record --------------------------------------------------------------------------------

TEST(Simulator, GoesOnBitForBit) {
  const std::string bodies = kFloor + "," +
                             body("a", box("[0.2, 0.3, 0.2]"), "[0, 0, 0.3]",
                                  R"(, "dynamics": {"angular_velocity": [4, 5, 6]})") +
                             "," + body("b", box("[0.2, 0.2, 0.2]"), "[0.05, 0, 0.8]", kFree);
  Simulator whole = simulator(bodies, R"("step": 0.01)");
  const auto steps = run(whole, 80);
  for (const std::size_t at : {0u, 30u, 45u, 70u}) {
    Simulator resumed = simulator(bodies, R"("step": 0.01)");
    if (at > 0) {
      resumed.resume(steps[at - 1]);
    }
    for (std::size_t k = at; k < steps.size(); ++k) {
      ASSERT_EQ(write_run_step(resumed.step().value()), write_run_step(steps[k])) << at << " " << k;
    }
  }
}

TEST(Simulator, StoppedStepChangesNothing) {
  Simulator s = simulator(kFloor + "," + body("a", ball("0.1"), "[0, 0, 1]", kFree), "");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(s.step(stop.get_token()).has_value());
  EXPECT_EQ(s.step_count(), 0u);
  EXPECT_EQ(s.step().value().index, 1u);
}

/// Also while its bodies, which all lean on each other, are on their way.
TEST(Simulator, StepIsStoppedWithinAnIsland) {
  std::string bodies = kFloor;
  for (int k = 0; k < 40; ++k) {
    bodies += "," + body("b" + std::to_string(k), box("[0.2, 0.2, 0.2]"),
                         "[0.01, 0, " + std::to_string(0.101 + 0.201 * k) + "]", kFree);
  }
  Simulator s = simulator(bodies, R"("step": 0.05)");
  bool stopped = false;
  // On a busy machine a step may be done before it is stopped.
  for (std::size_t steps = 0; steps < 20 && !stopped; ++steps) {
    std::stop_source stop;
    const std::jthread later([&] { stop.request_stop(); });
    stopped = !s.step(stop.get_token()).has_value();
    ASSERT_EQ(s.step_count(), stopped ? steps : steps + 1);
  }
  EXPECT_TRUE(stopped);
}

TEST(Simulator, TakesStatesFromOutside) {
  Simulator s = simulator(kFloor + "," + body("a", ball("0.1"), "[0, 0, 1]", kFree), "");
  RigidState state;
  state.X_WB.position = {0.0, 0.0, 2.0};
  state.v_WC = {1.0, 0.0, 0.0};
  s.set_state(1, state);
  EXPECT_GT(s.step().value().bodies[0].X_WB.position.x(), 0.0);
  EXPECT_THROW(s.set_state(0, state), std::invalid_argument);
  state.X_WB.position.z() = 0.05;
  EXPECT_THROW(s.set_state(1, state), std::invalid_argument);
  state.X_WB.position.z() = std::nan("");
  EXPECT_THROW(s.set_state(1, state), std::invalid_argument);
  state.X_WB.position.z() = 1.0;
  for (const double w : {0.0, 1e-200, 1e200}) {  // Squares of the last two are no doubles.
    state.X_WB.rotation = Eigen::Quaterniond(w, 0.0, 0.0, 0.0);
    EXPECT_THROW(s.set_state(1, state), std::invalid_argument);
  }
  EXPECT_GT(s.states()[1].X_WB.position.z(), 1.9);
}

/// Returns the message about a scene that cannot be simulated.
std::string refusal(const std::string& bodies, const std::string& settings = "") {
  try {
    (void)simulator(bodies, settings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Simulator, SaysWhatIsWrongWithAScene) {
  EXPECT_NE(refusal(kFloor + "," + body("a", ball("0.1"), "[0, 0, 0.05]", kFree))
                .find("\"floor\" and \"a\" meet at the start"),
            std::string::npos);
  EXPECT_NE(
      refusal(body("flag", R"({"vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]]})",
                   "[0, 0, 0]", kFree))
          .find("body \"flag\""),
      std::string::npos);
}

// A body as large as the contact distance is thrown, and what rounding hides cannot be proven.
TEST(Simulator, SaysWhichContactDistancesItTakes) {
  const std::string bodies = kFloor + "," + body("a", ball("0.1"), "[0, 0, 0.5]", kFree);
  const auto settings = [](const char* distance) {
    return std::string(R"("contact_distance": )") + distance;
  };
  EXPECT_EQ(refusal(bodies, settings("1e3")),
            "simulation.contact_distance: 1000 m is larger than a body: \"a\", the smallest free "
            "body, has a radius of 0.1 m; without this key it is 0.0001 m");
  for (const char* distance : {"1e-20", "1e-13"}) {
    EXPECT_NE(refusal(bodies, settings(distance)).find("too small to be proven beside coordinates"),
              std::string::npos);
  }
  const auto warnings = [&](const char* distance) {
    return simulator(bodies, settings(distance)).loaded().warnings;
  };
  ASSERT_EQ(warnings("0.02").size(), 1U);
  EXPECT_EQ(warnings("0.02").front(),
            "simulation.contact_distance: 0.02 m is a large gap between bodies that touch: \"a\", "
            "the smallest free body, has a radius of 0.1 m; without this key it is 0.0001 m");
  ASSERT_EQ(warnings("5e-9").size(), 1U);
  EXPECT_NE(warnings("5e-9").front().find("so small that steps may take long"), std::string::npos);
  EXPECT_TRUE(warnings("0.01").empty());
  EXPECT_TRUE(warnings("1e-6").empty());
}

// Dropped bodies come to rest between the contact distance and one and a half of it.
TEST(Simulator, RestsNearTheContactDistance) {
  constexpr double kContactDistance = 1e-4;
  Simulator simulator = test::simulator(
      kFloor + "," + body("a", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.105]", R"(, "dynamics": {})"),
      R"("step": 0.01, "contact_distance": 1e-4, "friction": 0.5)");
  const std::vector<RunStep> steps = test::run(simulator, 30);
  const RunStep& last = steps.back();
  ASSERT_FALSE(last.contacts.empty());
  EXPECT_LE(last.bodies[0].linear_velocity.norm(), 1e-6);
  for (const RunContact& contact : last.contacts) {
    EXPECT_GE(contact.distance, kContactDistance * (1.0 - 1e-9));
    EXPECT_LE(contact.distance, 1.5 * kContactDistance * (1.0 + 1e-9));
  }
}

// However many they are: what a script gives is no error of the solver.
TEST(Simulator, ScriptThrowsARowOfBoxesAtTwiceItsSpeed) {
  for (const int count : {4, 7, 12}) {
    std::string bodies =
        R"({"name": "paddle", "shape": {"box": {"size": [0.2, 9, 9]}}, "surface": {"restitution": 1},
        "motion": {"type": "waypoints", "times": [0, 1],
                   "poses": [{"position": [-0.5, 0, 0]}, {"position": [9.5, 0, 0]}]}})";
    for (int k = 0; k < count; ++k) {
      bodies +=
          "," + body("box " + std::to_string(k), box("[0.3, 0.3, 0.3]"),
                     numbers({0.3011 * k, 0.02 * ((k * 7) % 5 - 2), 0.03 * ((k * 5) % 4)}),
                     R"(, "dynamics": {"density": )" + std::to_string(500 * (1 + k % 3)) + "}");
    }
    Simulator s = simulator(bodies, settings(0.005, 0.3, 1e-3) + R"(, "duration": 1)");
    run(s, 20);
    for (int k = 1; k <= count; ++k) {
      EXPECT_NEAR(s.states()[static_cast<std::size_t>(k)].v_WC.x(), 20.0, 0.2) << count << " " << k;
    }
  }
}

}  // namespace
}  // namespace firstcontact
