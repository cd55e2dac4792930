// Scripted bodies whose motion bends within a step.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/motion/detail/straight_parts.h>
#include <firstcontact/motion/motion.h>

#include "simulation/simulated_run.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::ball;
using test::body;
using test::box;

constexpr double kDistance = 1e-4;  // [m]  Contact distance.

std::string hammer(const std::string& motion) {
  return R"({"name": "hammer", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "motion": )" + motion +
         "}";
}

/// Goes 0.2 m down and comes back, both within the step from 0.02 s to 0.03 s.
const std::string kBlow = hammer(R"({"type": "waypoints", "times": [0.022, 0.025, 0.028], "poses": [
    {"position": [0, 0, 1]}, {"position": [0, 0, 0.8]}, {"position": [0, 0, 1]}]})");

std::string laws(const std::string& more = "") {
  return R"("step": 0.01, "duration": 0.1, "gravity": [0, 0, 0], "contact_distance": 1e-4)" + more;
}

// The blow ends where it began, so a straight piece of the step would leave the ball alone.
TEST(Script, BlowWithinAStepIsFelt) {
  Simulator simulator = test::simulator(
      kBlow + ", " + body("ball", ball("0.05"), "[0, 0, 0.85]", R"(, "dynamics": {"mass": 1})"),
      laws());
  const std::vector<RunStep> steps = test::run(simulator, 10);
  // An inelastic ball takes the speed of the hammer: 0.2 m in 3 ms.
  const double speed = 0.2 / 0.003;
  for (const RunBody& moved : steps[2].bodies) {
    if (moved.body == 1) {
      EXPECT_NEAR(moved.linear_velocity.z(), -speed, 1e-9 * speed);
    }
  }
  const RunVerification proof = test::verify(simulator.header(), steps);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_LE(proof.scripted_deviation, kDistance);
  EXPECT_EQ(proof.time_lost, 0.0);
}

TEST(Script, PartsOfAStepAreOneStep) {
  Simulator simulator = test::simulator(
      kBlow + ", " + body("ball", ball("0.05"), "[0, 0, 0.85]", R"(, "dynamics": {"mass": 1})"),
      laws());
  const std::vector<RunStep> steps = test::run(simulator, 4);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    EXPECT_EQ(steps[k].index, k + 1);
    EXPECT_NEAR(steps[k].time, 0.01 * static_cast<double>(k + 1), 1e-15);
    EXPECT_NEAR(steps[k].lasted, 0.01, 1e-16);
    for (const RunBody& moved : steps[k].bodies) {
      EXPECT_EQ(moved.pieces.back().to, steps[k].lasted);
    }
  }
  // Where nothing bends, a step is one piece.
  EXPECT_EQ(steps[0].bodies[0].pieces.size(), 1);
  EXPECT_EQ(steps[2].bodies[0].pieces.size(), 4);
  ASSERT_EQ(steps[2].impacts.size(), 1);
  // It meets the ball after 0.05 m of way, but for the contact distance.
  EXPECT_NEAR(steps[2].impacts[0].at, 0.002 + 0.003 * 0.05 / 0.2, 1e-5);
}

/// [N s]  What a step's contacts push body 1 up with.
double lift(const RunStep& step) {
  double sum = 0.0;
  for (const RunContact& contact : step.contacts) {
    sum += contact.bodies[0] == 1   ? -contact.impulse.z()
           : contact.bodies[1] == 1 ? contact.impulse.z()
                                    : 0.0;
  }
  return sum;
}

// A step of several parts lasts no longer than another one: what rests bears its weight once.
TEST(Script, WhatRestsBearsItsWeightInStepsOfManyParts) {
  const std::string fan = R"({"name": "fan", "shape": {"box": {"size": [0.4, 0.1, 0.1]}}, "motion":
      {"type": "screw", "from": {"position": [0, 5, 1]}, "axis_direction": [0, 0, 1],
       "angle": 62.8}})";
  const std::string bodies =
      test::kFloor + ", " +
      body("cube", box("[0.1, 0.1, 0.1]"), "[0, 0, 0.0501]", R"(, "dynamics": {"mass": 2})") +
      ", " + fan + ", " + kBlow;
  const std::string settings =
      R"("step": 0.01, "duration": 1, "gravity": [0, 0, -9.81], "contact_distance": 1e-4)";
  Simulator simulator = test::simulator(bodies, settings);
  const std::vector<RunStep> steps = test::run(simulator, 60);
  const double weight = 2.0 * 9.81 * 0.01;
  for (std::size_t k = 20; k < steps.size(); ++k) {
    EXPECT_NEAR(lift(steps[k]), weight, 1e-6 * weight) << k;
  }
  Simulator resumed = test::simulator(bodies, settings);
  resumed.resume(steps[39]);
  for (std::size_t k = 40; k < steps.size(); ++k) {
    EXPECT_EQ(lift(resumed.step().value()), lift(steps[k])) << k;
  }
}

TEST(Script, RunThatIsResumedGoesOnAlike) {
  const std::string bodies =
      kBlow + ", " + body("ball", ball("0.05"), "[0, 0, 0.85]", R"(, "dynamics": {"mass": 1})");
  Simulator whole = test::simulator(bodies, laws());
  const std::vector<RunStep> steps = test::run(whole, 6);
  Simulator resumed = test::simulator(bodies, laws());
  resumed.resume(steps[2]);
  const RunStep next = resumed.step().value();
  ASSERT_EQ(next.bodies.size(), steps[3].bodies.size());
  for (std::size_t b = 0; b < next.bodies.size(); ++b) {
    EXPECT_EQ(next.bodies[b].X_WB.position, steps[3].bodies[b].X_WB.position);
    EXPECT_EQ(next.bodies[b].linear_velocity, steps[3].bodies[b].linear_velocity);
  }
}

// A quarter turn a step on a circle of 1 m: the chord is 0.29 m inside of it.
TEST(Script, CirclesAreFollowed) {
  const std::string arm = hammer(
      R"({"type": "screw", "from": {"position": [1, 0, 0]}, "axis_point": [0, 0, 0],
          "axis_direction": [0, 0, 1], "angle": 15.707963267948966, "translation": 0})");
  // Between the chord and the arc of the first step.
  Simulator simulator = test::simulator(
      arm + ", " +
          body("ball", ball("0.01"), "[0.68, 0.68, 0]", R"(, "dynamics": {"mass": 0.001})"),
      laws());
  const std::vector<RunStep> steps = test::run(simulator, 2);
  EXPECT_FALSE(steps[0].impacts.empty());
  const RunVerification proof = test::verify(simulator.header(), steps);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_LE(proof.scripted_deviation, kDistance);
}

// Crushed halfway through a step that bends, the press waits where it was, and goes on from there.
TEST(Script, CrushedStepsAreProvenToo) {
  const std::string press = hammer(
      R"({"type": "screw", "from": {"position": [0, 0, 0.2]}, "axis_point": [1, 0, 0.2],
          "axis_direction": [0, 1, 0], "angle": -0.8, "translation": 0})");
  Simulator simulator = test::simulator(
      test::kFloor + ", " + press + ", " +
          body("block", box("[0.1, 0.1, 0.1]"), "[0, 0, 0.06]", R"(, "dynamics": {"mass": 1})"),
      laws());
  const std::vector<RunStep> steps = test::run(simulator, 10);
  const RunVerification proof = test::verify(simulator.header(), steps);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_LE(proof.scripted_deviation, kDistance);
  EXPECT_GT(proof.time_lost, 0.0);
}

TEST(Script, TooWildForItsStepIsRefused) {
  const std::string wild = hammer(
      R"({"type": "screw", "from": {"position": [1, 0, 0]}, "axis_point": [0, 0, 0],
          "axis_direction": [0, 0, 1], "angle": 1e8, "translation": 0})");
  Simulator simulator = test::simulator(
      wild + ", " + body("ball", ball("0.01"), "[0, 0, 0]", R"(, "dynamics": {"mass": 1})"),
      laws());
  EXPECT_THROW((void)simulator.step(), std::invalid_argument);
}

/// [m]  The greatest distance of the corners of a cube from where straight pieces have them.
double sampled_bend(const detail::ScriptedMotion& script, const Motion& straight, double from,
                    double to) {
  double greatest = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    const double s = k / 1000.0;
    const Pose a = script.motion.pose(from + s * (to - from));
    const Pose b = straight.pose(s);
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d p = script.reach / std::sqrt(3.0) *
                         Vector3d((corner & 1) - 0.5, (corner & 2) / 2 - 0.5, corner / 4 - 0.5) *
                         2.0;
      greatest =
          std::max(greatest, (a.position + a.rotation * p - b.position - b.rotation * p).norm());
    }
  }
  return greatest;
}

TEST(Script, BendIsBounded) {
  test::Random random(3);
  constexpr int kCases = test::rounds(300, 60);
  int tight = 0;
  for (int n = 0; n < kCases; ++n) {
    std::vector<double> times;
    std::vector<Pose> poses;
    for (int k = 0; k < 5; ++k) {
      times.push_back(0.25 * k);
      poses.push_back({random.vector(0.0, 1.0), random.rotation()});
    }
    const detail::ScriptedMotion script{
        Motion::waypoints(times, poses, n % 2 == 0 ? Between::screw : Between::constant_velocity),
        random.uniform(0.1, 1.0)};
    const double from = random.uniform(0.0, 0.9);
    const double to = from + random.uniform(0.001, n % 3 == 0 ? 0.01 : 0.1);
    const Pose begin = script.motion.pose(from);
    const Eigen::AngleAxisd turn(script.motion.pose(to).rotation * begin.rotation.conjugate());
    const Motion straight = Motion::constant_velocity(
        begin, script.motion.pose(to).position - begin.position, turn.angle() * turn.axis());
    const double bend = sampled_bend(script, straight, from, to);
    const double bound = detail::bend_bound(script, from, to);
    EXPECT_LE(bend, bound + 1e-12) << n;
    tight += bound <= 1.3 * bend + 1e-12 ? 1 : 0;
  }
  EXPECT_GE(tight, kCases / 2);
}

/// [rad]  Between where a turn leads and where the motion is.
double missed_by(const Eigen::Vector3d& turn, const Eigen::Quaterniond& from,
                 const Eigen::Quaterniond& there) {
  const double angle = turn.norm();
  const Eigen::Quaterniond turned =
      angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * from : from;
  return turned.angularDistance(there);
}

// A body that rounding has moved beside its motion is led back without losing a turn.
TEST(Script, ATurnKeepsItsWholeTurns) {
  test::Random random(8);
  for (int n = 0; n < 500; ++n) {
    const double turns = n % 5 == 0 ? random.uniform(0.0, 0.4) : random.uniform(0.6, 40.0);
    const Eigen::Vector3d whole =
        2.0 * std::numbers::pi * turns * random.vector(0.0, 1.0).normalized();
    const Motion motion =
        Motion::constant_velocity({{0, 0, 0}, random.rotation()}, Eigen::Vector3d::Zero(), whole);
    const double beside = std::pow(10.0, random.uniform(-14.0, -4.0));
    const Eigen::Quaterniond from =
        Eigen::Quaterniond(Eigen::AngleAxisd(n % 2 == 0 ? beside : -beside, whole.normalized())) *
        motion.pose(0.0).rotation;
    const Eigen::Vector3d turn = detail::rotation_along(motion, 0.0, 1.0, from);
    EXPECT_NEAR(turn.norm(), whole.norm(), 2.0 * beside + 1e-9) << turns;
    EXPECT_LT(missed_by(turn, from, motion.pose(1.0).rotation), 1e-12 * (1.0 + turns)) << turns;
  }
}

// Half a break away by rounding is at the break.
TEST(Script, ATurnUpToABreakIsOfOnePiece) {
  const Pose start;
  const Eigen::Quaterniond third(Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitZ()));
  const std::vector<double> times{0.0, 0.3, 0.6};
  const std::vector<Pose> poses{start, {{0, 0, 0}, third}, {{0, 0, 0}, third * third}};
  const Motion motion = Motion::waypoints(times, poses);
  const double after = std::nextafter(0.3, 1.0);
  EXPECT_NEAR(detail::rotation_between(motion, 0.0, after).norm(), 3.0, 1e-12);
  EXPECT_NEAR(detail::rotation_between(motion, std::nextafter(0.3, 0.0), 0.6).norm(), 3.0, 1e-12);
}

}  // namespace
}  // namespace firstcontact
