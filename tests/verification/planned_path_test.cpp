// A path of the planner is proven again from its file; a shortcut through an obstacle never is.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/verification/provable_file.h>
#include <firstcontact/verification/verify_path.h>

#include "scene/robot_text.h"

namespace firstcontact {
namespace {

/// A path as its file has it.
PlannedPath planned_file(const std::string& text, std::uint64_t seed,
                         const std::filesystem::path& source = "scene.json") {
  const Scene scene = parse_scene(text, source);
  ShapeCache cache;
  ScenePlan plan = make_scene_plan(scene, scene.plan.value(), cache);
  plan.options.seed = seed;
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  EXPECT_EQ(result.verdict, PlanVerdict::proven);
  const std::string file = write_planned_path(planned_path(plan, plan.options, result));
  EXPECT_EQ(provable_file(file), ProvableFile::path);
  return parse_planned_path(file, "path.json");
}

/// The path straight from its start to its end.
PlannedPath shortcut(PlannedPath path) {
  path.waypoints = {path.waypoints.front(), path.waypoints.back()};
  path.clearances = {0.0};
  path.clearance = 0.0;
  return path;
}

void expect_proven(const PlannedPath& path) {
  const PathVerification proven = verify_path(path);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_EQ(proven.edges, path.waypoints.size() - 1);
  EXPECT_TRUE(proven.reaches_goal);
  EXPECT_GE(path.waypoints.size(), 3u);
  EXPECT_EQ(verify_path(shortcut(path)).verdict, ProofVerdict::refuted);
}

TEST(PlannedPathProof, ProvesABodyPastAThinWall) {
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "wall", "shape": {"box": {"size": [0.00001, 1, 1]}}},
    {"name": "peg", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-0.5, 0, 0]}}],
    "plan": {"body": "peg", "goal": {"position": [0.5, 0.1, 0.25]}, "margin": 0.01, "time": 20}})";
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    expect_proven(planned_file(scene, seed));
  }
}

TEST(PlannedPathProof, ProvesARobotThatCarriesABall) {
  const test::ArmFolder folder;
  folder.write("two.urdf", R"(<robot name="two"><link name="base"/>
    <link name="upper"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.05 0.05"/></geometry></collision></link>
    <link name="lower"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.05 0.05"/></geometry></collision></link>
    <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
    <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
      <limit lower="-2.6" upper="2.6" velocity="1" effort="1"/></joint></robot>)");
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "post", "shape": {"box": {"size": [0.1, 0.1, 1]}}, "pose": {"position": [0.75, 0, 0]}},
    {"name": "ball", "shape": {"sphere": {"radius": 0.06}}}],
    "robots": [{"name": "arm", "urdf": "two.urdf", "state": {"shoulder": -0.8, "elbow": 0},
      "attached": [{"body": "ball", "link": "lower", "pose": {"position": [0.55, 0, 0]}}]}],
    "plan": {"robot": "arm", "goal": {"shoulder": 0.8, "elbow": 0}, "time": 20}})";
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    expect_proven(planned_file(scene, seed, folder.path() / "scene.json"));
  }
  // A held body moves with its link, whatever its own motion is.
  const std::string ball = R"("name": "ball", )";
  std::string moving = scene;
  moving.insert(moving.find(ball),
                R"("motion": {"type": "constant_velocity", "translation": [1, 0, 0]}, )");
  const PlannedPath path = planned_file(moving, 1, folder.path() / "scene.json");
  EXPECT_FALSE(std::holds_alternative<FixedMotion>(path.scene.bodies[1].motion));
  expect_proven(path);
  PlannedPath let_go = path;
  let_go.scene.robots[0].attached.clear();
  EXPECT_NE(verify_path(let_go).problem.find("The body \"ball\" moves by itself."),
            std::string::npos);
}

// A hull that floats, with an arm, through a window of 0.5 m in a wall of 10 um.
TEST(PlannedPathProof, ProvesAFloatingBase) {
  const test::ArmFolder folder;
  folder.write("drone.urdf", R"(<robot name="drone"><link name="world"/>
    <link name="hull"><collision><geometry><box size="0.6 0.06 0.06"/></geometry></collision></link>
    <link name="arm"><collision><origin xyz="0.15 0 0"/><geometry><box size="0.3 0.04 0.04"/></geometry></collision></link>
    <joint name="base" type="floating"><parent link="world"/><child link="hull"/><origin xyz="0 0 0.2" rpy="0.1 0.2 0.3"/></joint>
    <joint name="elbow" type="revolute"><parent link="hull"/><child link="arm"/><origin xyz="0.33 0 0"/>
      <axis xyz="0 0 1"/><limit lower="-1.5" upper="1.5" velocity="1" effort="1"/></joint></robot>)");
  const std::string scene = R"({"firstcontact": 1, "bodies": [
    {"name": "left", "shape": {"box": {"size": [0.00001, 1.75, 4]}}, "pose": {"position": [0, -1.125, 0]}},
    {"name": "right", "shape": {"box": {"size": [0.00001, 1.75, 4]}}, "pose": {"position": [0, 1.125, 0]}},
    {"name": "below", "shape": {"box": {"size": [0.00001, 0.51, 1.75]}}, "pose": {"position": [0, 0, -1.125]}},
    {"name": "above", "shape": {"box": {"size": [0.00001, 0.51, 1.75]}}, "pose": {"position": [0, 0, 1.125]}},
    {"name": "ball", "shape": {"sphere": {"radius": 0.03}}}],
    "robots": [{"name": "d", "urdf": "drone.urdf", "state": {"base": {"position": [-1, 0, 0], "rpy": [0, 0, 1.6]}},
      "attached": [{"body": "ball", "link": "arm", "pose": {"position": [0.34, 0, 0]}}]}],
    "plan": {"goal": {"base": {"position": [1, 0.1, 0]}, "elbow": 0.5}, "time": 60,
      "bounds": {"base/trans_x": [-1.5, 1.5], "base/trans_y": [-1, 1], "base/trans_z": [-1, 1]}}})";
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    expect_proven(planned_file(scene, seed, folder.path() / "scene.json"));
  }
  const PlannedPath path = planned_file(scene, 1, folder.path() / "scene.json");
  ASSERT_EQ(path.joints[4], "base/rot_w");
  PlannedPath longer = path;
  for (std::vector<double>& waypoint : longer.waypoints) {
    waypoint[4] *= 1.5;
  }
  EXPECT_EQ(verify_path(longer).verdict, ProofVerdict::broken);
  PlannedPath in_part = path;
  in_part.joints.pop_back();
  in_part.turnings.pop_back();
  for (auto* rows : {&in_part.waypoints, &in_part.goals}) {
    for (std::vector<double>& row : *rows) {
      row.pop_back();
    }
  }
  EXPECT_NE(verify_path(in_part).problem.find("a part of the quaternion"), std::string::npos);
  PlannedPath elsewhere = path;
  elsewhere.waypoints.front()[1] -= 0.01;
  EXPECT_EQ(verify_path(elsewhere).verdict, ProofVerdict::broken);
  // An approximate path measures its distance as the planner does.
  PlannedPath ends_early = path;
  ends_early.is_proven = false;
  ends_early.goal.reset();
  ends_early.waypoints.pop_back();
  ends_early.clearances.pop_back();
  ends_early.clearance = *std::ranges::min_element(ends_early.clearances);
  ShapeCache cache;
  const Scene asked = parse_scene(scene, folder.path() / "scene.json");
  const ScenePlan plan = make_scene_plan(asked, asked.plan.value(), cache);
  ends_early.distance_to_goal =
      plan.plan.space.distance(ends_early.waypoints.back(), path.goals.front());
  const PathVerification early = verify_path(ends_early);
  EXPECT_EQ(early.verdict, ProofVerdict::proven) << early.problem;
}

}  // namespace
}  // namespace firstcontact
