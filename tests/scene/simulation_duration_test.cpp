#include <firstcontact/scene/simulation_duration.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/simulation.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

Pose pose_after(const BodyMotion& motion, double seconds, double duration) {
  return normalised_motion(motion, duration).pose(seconds / duration);
}

void expect_same_pose(const Pose& a, const Pose& b) {
  EXPECT_LT((a.position - b.position).norm(), 1e-12);
  EXPECT_LT(a.rotation.normalized().angularDistance(b.rotation.normalized()), 1e-7);
}

/// Every rigid motion, over 2 s.
Scene scripted_scene() {
  const Pose from{{1, 2, 3}, Eigen::Quaterniond(1, 0.2, -0.1, 0.4)};
  const Pose to{{-1, 0, 4}, Eigen::Quaterniond(1, -0.3, 0.5, 0)};
  Scene scene;
  scene.duration = 2.0;
  scene.simulation = Simulation{.contact_distance = {}, .pairs = {}};
  for (const BodyMotion& motion : std::vector<BodyMotion>{
           FixedMotion{from}, ConstantVelocityMotion{from, {1, -2, 0.5}, {0.3, 4, -7}},
           ScrewMotion{from, {0, 1, 0}, {1, 1, 0}, 9.0, -0.4},
           TwoPoseMotion{from, to, Between::constant_velocity},
           TwoPoseMotion{from, to, Between::screw},
           WaypointMotion{{0.5, 1.0, 1.5}, {from, to, from}, Between::screw}}) {
    scene.bodies.push_back({.name = "body " + std::to_string(scene.bodies.size()),
                            .shape = {.source = SphereShape{1.0}},
                            .motion = motion});
  }
  return scene;
}

TEST(SimulationDuration, KeepsWhatScriptedBodiesDoUntilTheEnd) {
  const Scene given = scripted_scene();
  for (const double duration : {0.1, 1.0, 2.0, 2.5, 70.0}) {
    Scene scene = given;
    set_simulation_duration(scene, duration);
    EXPECT_EQ(scene.simulation->duration, duration);
    EXPECT_EQ(scene.duration, std::max(duration, 2.0));
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      for (const double seconds : {0.0, 0.25, 0.9, 1.3, 2.0}) {
        SCOPED_TRACE(std::to_string(k) + " at " + std::to_string(seconds));
        expect_same_pose(pose_after(scene.bodies[k].motion, seconds, scene.duration),
                         pose_after(given.bodies[k].motion, seconds, 2.0));
      }
    }
  }
}

TEST(SimulationDuration, LetsRatesGoOnAndOthersRest) {
  Scene scene = scripted_scene();
  const Scene given = scene;
  set_simulation_duration(scene, 5.0);
  const auto& from = std::get<FixedMotion>(given.bodies[0].motion).pose;
  const Pose moved = pose_after(scene.bodies[1].motion, 5.0, 5.0);
  EXPECT_LT((moved.position - (from.position + 2.5 * Vector3d(1, -2, 0.5))).norm(), 1e-12);
  EXPECT_NEAR(std::get<ScrewMotion>(scene.bodies[2].motion).angle, 22.5, 1e-12);
  EXPECT_NEAR(std::get<ScrewMotion>(scene.bodies[2].motion).translation, -1.0, 1e-12);
  for (const std::size_t rests : {0u, 3u, 4u, 5u}) {
    SCOPED_TRACE(rests);
    expect_same_pose(pose_after(scene.bodies[rests].motion, 5.0, 5.0),
                     pose_after(given.bodies[rests].motion, 2.0, 2.0));
  }
}

// The base of a robot that follows its trajectory is scripted as bodies are.
TEST(SimulationDuration, KeepsTheRatesOfRobotsToo) {
  const test::ArmFolder folder;
  Scene scene = parse_scene(R"({"firstcontact": 1, "bodies": [)" + test::body("a") + R"(],
      "robots": [{"name": "arm", "urdf": "arm.urdf", "trajectory": "move.csv",
                  "base_motion": {"type": "constant_velocity", "translation": [8, 0, 0]}}],
      "simulation": {"duration": 4}})",
                            folder.path() / "s.json");
  set_simulation_duration(scene, 6.0);
  EXPECT_NEAR(pose_after(scene.robots[0].base, 4.0, 6.0).position.x(), 8.0, 1e-12);
  EXPECT_NEAR(pose_after(scene.robots[0].base, 6.0, 6.0).position.x(), 12.0, 1e-12);
}

TEST(SimulationDuration, RefusesWhatIsNoTimeAndLeavesTheSceneAsItIs) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scene scene = scripted_scene();
  for (const double wrong : {0.0, -1.0, nan}) {
    EXPECT_THROW(set_simulation_duration(scene, wrong), std::invalid_argument) << wrong;
  }
  scene.bodies.push_back({.name = "flag",
                          .shape = {.source = Mesh{{{0, 0, 0}}, {{0, 0, 0}}}},
                          .motion = VertexMotion{{{1, 0, 0}}}});
  EXPECT_THROW(set_simulation_duration(scene, 3.0), std::invalid_argument);
  EXPECT_EQ(scene.duration, 2.0);
  EXPECT_EQ(scene.simulation->duration, 1.0);
  EXPECT_EQ(std::get<ScrewMotion>(scene.bodies[2].motion).angle, 9.0);
  set_simulation_duration(scene, 2.0);  // It deforms as long as the scene lasts.
  EXPECT_EQ(scene.simulation->duration, 2.0);
  scene.simulation.reset();
  EXPECT_THROW(set_simulation_duration(scene, 1.0), std::invalid_argument);
}

TEST(SimulationStepCount, TakesNoStepMoreForRounding) {
  Simulation simulation{.contact_distance = {}, .pairs = {}};
  for (const double step : {1.0 / 240.0, 0.01, 1.0 / 3.0, 1e-3, 0.7e-5}) {
    simulation.step = step;
    for (std::size_t count = 1; count <= 3000; ++count) {
      simulation.duration = static_cast<double>(count) * step;
      ASSERT_EQ(simulation_step_count(simulation), count) << step;
      simulation.duration = (static_cast<double>(count) + 1e-6) * step;
      ASSERT_EQ(simulation_step_count(simulation), count + 1) << step;
    }
  }
}

TEST(SimulationStepCount, RefusesMoreThanAHundredMillion) {
  Simulation simulation{.duration = 1.0, .step = 1e-8, .contact_distance = {}, .pairs = {}};
  EXPECT_EQ(simulation_step_count(simulation), 100'000'000u);
  simulation.step = 0.5e-8;
  EXPECT_EQ(
      test::message_of<std::invalid_argument>([&] { (void)simulation_step_count(simulation); }),
      "simulation: expected at most 1e+08 steps, got 1 s in steps of 5e-09 s");
}

}  // namespace
}  // namespace firstcontact
