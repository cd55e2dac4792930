// Bodies at rest: when they come to rest, what keeps them there, and what ends it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/record/run_step.h>
#include <firstcontact/record/write_run.h>

#include "simulation/simulated_run.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

const std::string kSettings = settings(0.01, 0.5, 1e-4);

std::string block(const std::string& name, double z, const std::string& dynamics = "{}") {
  return body(name, box("[0.2, 0.2, 0.2]"), numbers({0.0, 0.0, z}), R"(, "dynamics": )" + dynamics);
}

const RunBody& find(const RunStep& step, std::size_t body) {
  return *std::ranges::find(step.bodies, body, &RunBody::body);
}

/// The step after which the body rests; the count of steps if it never does.
std::size_t first_rest(const std::vector<RunStep>& steps, std::size_t body) {
  const auto found =
      std::ranges::find_if(steps, [&](const RunStep& step) { return find(step, body).rests; });
  return static_cast<std::size_t>(found - steps.begin());
}

TEST(Rest, EndsTheMotionOfWhatContactsHold) {
  Simulator s = simulator(kFloor + "," + block("a", 0.1002) + "," + block("b", 0.3004), kSettings);
  const std::vector<RunStep> steps = run(s, 100);
  const std::size_t rests = first_rest(steps, 1);
  ASSERT_LE(rests, 50);
  for (std::size_t k = rests; k < steps.size(); ++k) {
    for (const std::size_t b : {1u, 2u}) {
      const RunBody& body = find(steps[k], b);
      ASSERT_TRUE(body.rests) << k;
      ASSERT_TRUE(body.linear_velocity.isZero(0.0) && body.angular_velocity.isZero(0.0)) << k;
      ASSERT_EQ(body.X_WB.position, find(steps[rests], b).X_WB.position) << k;
      ASSERT_EQ(body.X_WB.rotation.coeffs(), find(steps[rests], b).X_WB.rotation.coeffs()) << k;
    }
  }
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

// The contacts that carried the weight before still press: the floor bears both blocks.
TEST(Rest, KeepsItsContacts) {
  Simulator s = simulator(kFloor + "," + block("a", 0.1002, R"({"mass": 2})") + "," +
                              block("b", 0.3004, R"({"mass": 3})"),
                          kSettings);
  const std::vector<RunStep> steps = run(s, 100);
  ASSERT_TRUE(find(steps.back(), 1).rests);
  Vector3d from_floor = Vector3d::Zero();
  for (const RunContact& contact : steps.back().contacts) {
    from_floor += contact.bodies == BodyPair{0, 1} ? contact.impulse : Vector3d::Zero();
  }
  EXPECT_NEAR(from_floor.z(), 5.0 * 9.81 * 0.01, 1e-5);
  EXPECT_GT(steps.back().clearance, 0.0);
}

// Slower than gravity by far, but not at rest.
TEST(Rest, IsNotWhatSlidesOrFloats) {
  const std::string slope = body("floor", box("[9, 9, 1]"), "[0, 0, -0.5]");
  Simulator sliding = simulator(slope + "," + block("a", 0.1001),
                                settings(0.01, 0.49, 1e-4) + R"(, "gravity": [4.905, 0, -9.81])");
  EXPECT_EQ(first_rest(run(sliding, 50), 1), 50);
  EXPECT_GE(sliding.states()[1].v_WC.x(), 0.02);
  Simulator sticking = simulator(slope + "," + block("a", 0.1001),
                                 settings(0.01, 0.51, 1e-4) + R"(, "gravity": [4.905, 0, -9.81])");
  EXPECT_LT(first_rest(run(sticking, 50), 1), 50);
  Simulator floating = simulator(block("a", 0.0, R"({"linear_velocity": [1e-10, 0, 0]})"),
                                 kSettings + R"(, "gravity": [0, 0, 0])");
  EXPECT_EQ(first_rest(run(floating, 20), 0), 20);
  EXPECT_EQ(floating.states()[0].v_WC.x(), 1e-10);
}

// However weak gravity is, and however little it adds in a step.
TEST(Rest, IsNotWhatHardlyBeginsToMove) {
  const std::string crate =
      body("floor", box("[9, 9, 1]"), "[0, 0, -0.5]") + "," + block("a", 0.1001);
  Simulator weak = simulator(crate, settings(0.01, 0.0, 1e-4) + R"(, "gravity": [2e-7, 0, -1e-6])");
  EXPECT_EQ(first_rest(run(weak, 50), 1), 50);
  EXPECT_NEAR(weak.states()[1].v_WC.x(), 50 * 0.01 * 2e-7, 1e-12);
  Simulator brief =
      simulator(crate, settings(1e-7, 0.0, 1e-4) + R"(, "gravity": [0.03, 0, -9.81])");
  EXPECT_EQ(first_rest(run(brief, 20), 1), 20);
}

// It would begin to rest anew in each step, and lag behind.
TEST(Rest, IsNotWhatASlowBeltCarries) {
  const std::string belt =
      R"({"name": "belt", "shape": {"box": {"size": [9, 9, 1]}}, "motion": {"type": "waypoints",
      "times": [0, 1], "poses": [{"position": [0, 0, -0.5]}, {"position": [1e-7, 0, -0.5]}]}})";
  Simulator s = simulator(belt + "," + block("a", 0.1001), kSettings + R"(, "duration": 1)");
  EXPECT_EQ(first_rest(run(s, 100), 1), 100);
  EXPECT_NEAR(s.states()[1].v_WC.x(), 1e-7, 5e-9);
}

TEST(Rest, EndsWhereAForceBegins) {
  Simulator s = simulator(
      kFloor + "," +
          block("a", 0.1001, R"({"mass": 1, "forces": [{"from": 0.8, "force": [20, 0, 0]}]})"),
      kSettings);
  const std::vector<RunStep> steps = run(s, 100);
  EXPECT_TRUE(find(steps[78], 1).rests);
  EXPECT_FALSE(find(steps[80], 1).rests);
  EXPECT_NEAR(s.states()[1].v_WC.x(), 0.2 * (20.0 - 0.5 * 9.81), 0.01);
}

TEST(Rest, EndsWhereAScriptPushes) {
  const std::string pusher =
      R"({"name": "pusher", "shape": {"sphere": {"radius": 0.05}}, "motion": {"type": "waypoints",
      "times": [0, 1], "poses": [{"position": [-1, 0, 0.1]}, {"position": [1, 0, 0.1]}]}})";
  Simulator s =
      simulator(kFloor + "," + block("a", 0.1001) + "," + pusher, kSettings + R"(, "duration": 1)");
  const std::vector<RunStep> steps = run(s, 90);
  EXPECT_TRUE(find(steps[39], 1).rests);
  EXPECT_GE(s.states()[1].X_WB.position.x(), 0.75 - 0.01);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

TEST(Rest, EndsWhereSomethingFallsOnIt) {
  const std::string beam = body("beam", box("[1, 0.2, 0.05]"), numbers({0.0, 0.0, 0.2253}),
                                R"(, "dynamics": {"mass": 1})");
  const std::string stone = body("stone", box("[0.1, 0.1, 0.1]"), numbers({0.4, 0.0, 2.0}),
                                 R"(, "dynamics": {"mass": 20})");
  Simulator s = simulator(kFloor + "," + block("a", 0.1001) + "," + beam + "," + stone, kSettings);
  const std::vector<RunStep> steps = run(s, 80);
  const std::size_t rests = first_rest(steps, 2);
  ASSERT_LE(rests, 40);
  EXPECT_EQ(find(steps[rests], 2).X_WB.position, find(steps[50], 2).X_WB.position);
  EXPECT_GE(s.states()[2].X_WB.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.1);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

// The block that was carried falls.
TEST(Rest, EndsWhereABodyIsTakenAway) {
  Simulator s = simulator(kFloor + "," + block("a", 0.1001) + "," + block("b", 0.3002), kSettings);
  ASSERT_LT(first_rest(run(s, 100), 2), 100);
  RigidState away = s.states()[1];
  away.X_WB.position.x() = 2.0;
  s.set_state(1, away);
  run(s, 10);
  EXPECT_LE(s.states()[2].X_WB.position.z(), 0.3002 - 0.04);
}

// Bit for bit, with margins that round, and from every step around the begin of rest.
TEST(Rest, GoesOnInResumedRuns) {
  const std::string bodies = kFloor + "," + block("a", 0.1002 + 0.003) + "," +
                             block("b", 0.3004 + 0.003) + "," +
                             body("c", ball("0.1"), "[1, 0, 0.5]", R"(, "dynamics": {})");
  const auto start = [&] {
    ShapeCache cache;
    return Simulator(load_scene(
        parse_scene(R"({"firstcontact": 1, "bodies": [)" + bodies +
                        R"(], "pairs": {"margin": [["floor", "a", 0.003]]}, "simulation": {)" +
                        kSettings + "}}",
                    "test.json"),
        cache));
  };
  Simulator s = start();
  const std::vector<RunStep> steps = run(s, 80);
  const std::size_t rests = first_rest(steps, 1);
  ASSERT_LE(rests, 60);
  for (std::size_t at = rests > 3 ? rests - 3 : 1; at < rests + 3; ++at) {
    Simulator resumed = start();
    resumed.resume(steps[at - 1]);
    for (std::size_t k = at; k < steps.size(); ++k) {
      ASSERT_EQ(write_run_step(resumed.step().value()), write_run_step(steps[k])) << at << " " << k;
    }
  }
}

}  // namespace
}  // namespace firstcontact::test
