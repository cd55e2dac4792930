#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/record/write_run.h>

#include "simulation/simulated_run.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::body;
using test::box;
using test::kFloor;
using test::run;
using test::simulator;
using test::verify;

constexpr double kSteeringStep = 0.01;  // [s]
const std::string kSteeredCube =
    body("cube", box("[0.2, 0.2, 0.2]"), "[0, 0, 1]", R"(, "dynamics": {"mass": 2})");
const std::string kFloating = R"("step": 0.01, "gravity": [0, 0, 0])";

TEST(SteeredSimulation, ForcesActForOneStep) {
  Simulator s = simulator(kSteeredCube, kFloating);
  s.apply_force(0, {4.0, 0.0, 0.0});
  s.apply_force(0, {0.0, 2.0, 0.0}, {0.0, 0.0, 0.1});
  run(s, 1);
  // I = m a^2 / 6
  const double spin = 0.1 * kSteeringStep / (2.0 * 0.04 / 6.0);
  EXPECT_LE((s.states()[0].v_WC - Vector3d(0.02, 0.01, 0.0)).norm(), 1e-15);
  EXPECT_LE((s.states()[0].w_WB - Vector3d(0.0, 0.0, spin)).norm(), 1e-12);
  run(s, 3);
  EXPECT_LE((s.states()[0].v_WC - Vector3d(0.02, 0.01, 0.0)).norm(), 1e-15);
}

TEST(SteeredSimulation, ForceAtAPointTurnsTheBody) {
  Simulator s = simulator(kSteeredCube, kFloating);
  s.apply_force(0, {0.0, 0.0, 3.0}, Vector3d::Zero(), Vector3d(0.1, 0.0, 7.0));
  run(s, 1);
  EXPECT_NEAR(s.states()[0].w_WB.y(), -0.3 * kSteeringStep / (2.0 * 0.04 / 6.0), 1e-12);
  EXPECT_NEAR(s.states()[0].v_WC.z(), 1.5 * kSteeringStep, 1e-15);
}

/// A cube that has come to rest on the floor.
Simulator resting_cube() {
  Simulator s = simulator(
      kFloor + "," +
          body("cube", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.1005]", R"(, "dynamics": {"mass": 2})"),
      R"("step": 0.01, "friction": 0.5)");
  EXPECT_TRUE(run(s, 60).back().bodies[0].rests);
  return s;
}

// Less than friction holds does nothing; more wakes the cube, and it comes to rest again.
TEST(SteeredSimulation, ForceWakesWhatRests) {
  Simulator s = resting_cube();
  s.apply_force(1, {5.0, 0.0, 0.0});
  EXPECT_FALSE(s.step()->bodies[0].rests);
  EXPECT_LE(s.states()[1].v_WC.norm(), 1e-6);
  s.apply_force(1, {100.0, 0.0, 0.0});
  run(s, 1);
  EXPECT_NEAR(s.states()[1].v_WC.x(), (50.0 - 0.5 * 9.81) * kSteeringStep, 1e-4);
  EXPECT_TRUE(run(s, 60).back().bodies[0].rests);
}

// A run goes on bit for bit after any of its steps, where it is given the same commands.
TEST(SteeredSimulation, GoesOnAlikeAfterAnyStep) {
  const auto command = [](Simulator& s, std::size_t k) {
    if (k % 7 < 3) {
      s.apply_force(1, {12.0, 0.0, 0.0}, {0.0, 0.0, 0.2});
    }
    s.set_surface(1, {.friction = k < 20 ? 0.5 : 0.1, .restitution = {}});
    s.set_gravity({0.0, k < 30 ? 0.0 : 1.0, -9.81});
  };
  Simulator whole = resting_cube();
  const std::size_t first = whole.step_count();
  std::vector<RunStep> steps;
  for (std::size_t k = 0; k < 40; ++k) {
    command(whole, k);
    steps.push_back(whole.step().value());
  }
  for (const std::size_t from : {5U, 21U, 33U}) {
    Simulator other = resting_cube();
    other.resume(steps[from]);
    for (std::size_t k = from + 1; k < 40; ++k) {
      command(other, k);
      ASSERT_EQ(write_run_step(other.step().value()), write_run_step(steps[k])) << from << " " << k;
    }
  }
  EXPECT_EQ(steps.back().index, first + 40);
}

TEST(SteeredSimulation, RunOfAForcedCubeIsProven) {
  Simulator s = simulator(
      kFloor + "," +
          body("cube", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.3]", R"(, "dynamics": {"mass": 2})"),
      R"("step": 0.01)");
  std::vector<RunStep> steps;
  for (int k = 0; k < 50; ++k) {
    s.apply_force(1, {0.0, 0.0, -500.0}, {3.0, 0.0, 0.0});
    steps.push_back(s.step().value());
  }
  const RunVerification found = verify(s.header(), steps);
  EXPECT_EQ(found.verdict, ProofVerdict::proven) << found.problem;
}

TEST(SteeredSimulation, GravityAndSurfacesChange) {
  Simulator s = resting_cube();
  s.set_gravity({0.0, 0.0, 9.81});
  run(s, 10);
  EXPECT_NEAR(s.states()[1].v_WC.z(), 0.981, 1e-12);
  Simulator slides = resting_cube();
  slides.set_pair_surface({1, 0}, {.friction = 0.0, .restitution = {}});
  slides.set_gravity({1.0, 0.0, -9.81});
  run(slides, 20);
  EXPECT_NEAR(slides.states()[1].v_WC.x(), 0.2, 1e-6);
  slides.set_pair_surface({0, 1}, {.friction = 0.5, .restitution = {}});
  EXPECT_LE(run(slides, 30).back().bodies[0].linear_velocity.norm(), 1e-6);
}

TEST(SteeredSimulation, RefusesWhatItCannotDo) {
  Simulator s = resting_cube();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(s.apply_force(0, Vector3d::UnitX()), std::invalid_argument);
  EXPECT_THROW(s.apply_force(2, Vector3d::UnitX()), std::invalid_argument);
  EXPECT_THROW(s.apply_force(1, {nan, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(s.apply_force(1, Vector3d::Zero(), Vector3d::Zero(), Vector3d(nan, 0.0, 0.0)),
               std::invalid_argument);
  EXPECT_THROW(s.set_gravity({nan, 0.0, 0.0}), std::invalid_argument);
  // Later nothing could tell which call was wrong.
  EXPECT_THROW(s.apply_force(1, {0.0, 0.0, 1e300}), std::invalid_argument);
  EXPECT_THROW(s.apply_force(1, Vector3d::Zero(), {0.0, 0.0, 1e300}), std::invalid_argument);
  EXPECT_THROW(s.set_gravity({0.0, 0.0, -1e300}), std::invalid_argument);
  EXPECT_THROW(s.set_surface(2, {}), std::invalid_argument);
  EXPECT_THROW(s.set_surface(1, {.friction = -1.0, .restitution = {}}), std::invalid_argument);
  EXPECT_THROW(s.set_surface(1, {.friction = {}, .restitution = 1.5}), std::invalid_argument);
  EXPECT_THROW(s.set_pair_surface({1, 1}, {}), std::invalid_argument);
  EXPECT_THROW(s.set_pair_surface(
                   {0, 1}, {.friction = {}, .restitution = {}, .velocity = Vector3d::UnitX()}),
               std::invalid_argument);
  EXPECT_THROW(s.set_motor(0, "hinge", {}), std::invalid_argument);
}

/// A rod of 1 kg that swings about y below the origin.
constexpr const char* kPendulum = R"(<robot name="p"><link name="base"/><link name="rod"><inertial>
<origin xyz="0 0 -0.25"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
</inertial><collision><origin xyz="0 0 -0.25"/><geometry><box size="0.02 0.02 0.5"/></geometry></collision></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>)";

Simulator pendulum() {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() /
      (std::string("firstcontact_steering_") +
       testing::UnitTest::GetInstance()->current_test_info()->name() + ".urdf");
  std::ofstream(path) << kPendulum;
  ShapeCache cache;
  Simulator s(load_scene(
      parse_scene(R"({"firstcontact": 1, "bodies": [], "robots": [{"name": "p", "urdf": ")" +
                      path.string() +
                      R"(", "dynamics": {"base": "fixed"}}], "simulation": {"step": 0.01}})",
                  "test.json"),
      cache));
  std::filesystem::remove(path);
  return s;
}

TEST(SteeredSimulation, MotorsAreSetWhileItRuns) {
  Simulator s = pendulum();
  EXPECT_FALSE(s.motor(0, "hinge").has_value());
  s.set_motor(0, "hinge", {.kind = JointMotor::Kind::velocity, .target = {{0.0, 0.5}}});
  run(s, 20);
  EXPECT_NEAR(s.robot_states()[0].velocities[0], 0.5, 1e-9);
  const double target = s.robot_states()[0].positions[0];
  s.set_motor(0, "hinge", {.kind = JointMotor::Kind::position, .target = {{0.0, target + 0.2}}});
  run(s, 20);
  EXPECT_NEAR(s.robot_states()[0].positions[0], target + 0.2, 1e-6);
  EXPECT_EQ(s.motor(0, "hinge")->target.front().number, target + 0.2);
  // A torque that carries the weight.
  const double torque = 9.81 * 0.25 * std::sin(s.robot_states()[0].positions[0]);
  s.set_motor(0, "hinge", {.kind = JointMotor::Kind::torque, .target = {{0.0, torque}}});
  const RunStep last = run(s, 10).back();
  EXPECT_NEAR(s.robot_states()[0].velocities[0], 0.0, 1e-4);
  EXPECT_NEAR(last.robots[0].efforts[0], torque, 1e-12);
}

TEST(SteeredSimulation, RefusesMotorsThatAreNone) {
  Simulator s = pendulum();
  const auto motor = [](std::vector<TimedNumber> target) {
    return JointMotor{.kind = JointMotor::Kind::velocity, .target = std::move(target)};
  };
  EXPECT_THROW(s.set_motor(1, "hinge", motor({{0.0, 1.0}})), std::invalid_argument);
  EXPECT_THROW(s.set_motor(0, "knee", motor({{0.0, 1.0}})), std::invalid_argument);
  EXPECT_THROW(s.set_motor(0, "hinge", motor({})), std::invalid_argument);
  EXPECT_THROW(s.set_motor(0, "hinge", motor({{0.0, 1.0}, {0.0, 2.0}})), std::invalid_argument);
  EXPECT_THROW(s.set_motor(0, "hinge", motor({{0.0, std::nan("")}})), std::invalid_argument);
  JointMotor stiff = motor({{0.0, 1.0}});
  stiff.stiffness = 3.0;
  EXPECT_THROW(s.set_motor(0, "hinge", stiff), std::invalid_argument);
  EXPECT_FALSE(s.motor(0, "hinge").has_value());
}

}  // namespace
}  // namespace firstcontact
