// Paths of several robots: proven from the file alone, and refuted where they are false.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/verify_path.h>

#include "scene/robot_text.h"

namespace firstcontact {
namespace {

/// Two arms that face each other, 2 m apart, and a third that stands aside.
PlannedPath path_of_arms(const test::ArmFolder& folder, const std::string& bodies = "") {
  const Scene scene = parse_scene(R"({"firstcontact": 1, "bodies": [)" + bodies + R"(], "robots": [
    {"name": "aside", "urdf": "arm.urdf", "base": {"position": [0, 9, 0]}},
    {"name": "left", "urdf": "arm.urdf", "state": {"elbow": -0.8}},
    {"name": "right", "urdf": "arm.urdf", "state": {"elbow": 0.8},
     "base": {"position": [2, 0, 0], "rpy": [0, 0, 3.14159265358979]}}],
    "plan": {"robots": ["right", "left"], "goal": {"left/elbow": 0.8, "right/elbow": -0.8}}})",
                                  folder.path() / "scene.json");
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(scene, scene.plan.value(), cache);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  EXPECT_EQ(result.verdict, PlanVerdict::proven);
  return planned_path(plan, plan.options, result);
}

TEST(SeveralRobotsPath, IsWrittenReadAndProven) {
  const test::ArmFolder folder;
  const PlannedPath path = path_of_arms(folder);
  EXPECT_EQ(path.robots, (std::vector<std::string>{"right", "left"}));
  EXPECT_EQ(path.joints, (std::vector<std::string>{"right/elbow", "left/elbow"}));
  const std::string text = write_planned_path(path);
  const PlannedPath read = parse_planned_path(text, folder.path() / "path.json");
  EXPECT_EQ(read.robots, path.robots);
  EXPECT_EQ(read.waypoints, path.waypoints);
  EXPECT_EQ(write_planned_path(read), text);
  const PathVerification proof = verify_path(read);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_EQ(proof.edges, path.waypoints.size() - 1);
  EXPECT_TRUE(proof.reaches_goal);
  // The four bars and tips of two arms form 4 pairs; each of the four links forms 2 more with the
  // third arm.
  EXPECT_EQ(proof.tested, 4u + 2u * 4u);
}

TEST(SeveralRobotsPath, IsRefutedWhereTheArmsMeet) {
  const test::ArmFolder folder;
  PlannedPath path = path_of_arms(folder);
  path.waypoints = {path.waypoints.front(), path.waypoints.back()};
  path.clearances = {0.0};
  path.clearance = 0.0;
  const PathVerification refuted = verify_path(path);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_EQ(refuted.problem_edge, 0u);
  // By either arm alone, with the other at rest.
  path.waypoints = {{0.8, -0.8}, {0.8, 0.0}, {0.0, 0.0}, {-0.8, 0.8}};
  path.clearances = {0.0, 0.0, 0.0};
  EXPECT_EQ(verify_path(path).problem_edge, 1u);
}

TEST(SeveralRobotsPath, IsBrokenWhereItContradictsItsScene) {
  const test::ArmFolder folder;
  const PlannedPath whole = path_of_arms(folder);
  const auto problem = [&](const std::function<void(PlannedPath&)>& change) {
    PlannedPath path = whole;
    change(path);
    const PathVerification proof = verify_path(path);
    EXPECT_EQ(proof.verdict, ProofVerdict::broken);
    return proof.problem;
  };
  EXPECT_EQ(problem([](PlannedPath& path) { path.robots[1] = "lift"; }),
            "The scene has no robot \"lift\".");
  EXPECT_EQ(problem([](PlannedPath& path) {
              path.robots = {"right", "left", "aside"};
            }),
            "The path moves no joint of robot \"aside\".");
  EXPECT_EQ(problem([](PlannedPath& path) { path.joints[0] = "left/elbow"; }),
            "The path does not begin where its scene has joint \"left/elbow\".");
  EXPECT_EQ(problem([](PlannedPath& path) {
              path.joints[0] = "left/elbow";
              for (std::vector<double>& waypoint : path.waypoints) {
                waypoint[0] = waypoint[1];
              }
              path.goals = {path.waypoints.back()};
            }),
            "The path has joint \"left/elbow\" twice.");
  EXPECT_EQ(problem([](PlannedPath& path) { path.waypoints[1][0] = -1.5; }),
            "A waypoint has joint \"elbow\" at -1.5, outside of its limits.");
}

TEST(SeveralRobotsPath, HasNamesThatItsFileCannotConfuse) {
  const test::ArmFolder folder;
  const std::string text = write_planned_path(path_of_arms(folder));
  const auto problem = [&](const std::string& from, const std::string& to) -> std::string {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    try {
      (void)parse_planned_path(changed, folder.path() / "path.json");
    } catch (const ParseError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(problem(R"(["right","left"])", R"(["right","right"])").find("twice"),
            std::string::npos);
  EXPECT_NE(problem(R"(["right","left"])", R"(["right"])").find("at least two robots"),
            std::string::npos);
  EXPECT_NE(problem(R"(["right","left"])", R"(["right","none"])").find("that the scene has"),
            std::string::npos);
  EXPECT_NE(problem(R"("right/elbow")", R"("elbow")").find("ROBOT/NAME"), std::string::npos);
  EXPECT_NE(problem(R"("right/elbow")", R"("right/wrist")").find("name of a joint"),
            std::string::npos);
}

// A gate shuts the way of both arms at first: the two wait, each for the other and for the gate.
TEST(SeveralRobotsPath, IsProvenInTime) {
  const test::ArmFolder folder;
  PlannedPath path =
      path_of_arms(folder, R"({"name": "gate", "shape": {"box": {"size": [0.1, 0.1, 0.5]}},
        "motion": {"type": "waypoints", "times": [0, 2, 3, 8],
          "poses": [{"position": [1, 0, 0]}, {"position": [1, 0, 0]}, {"position": [1, 0, 3]}, {"position": [1, 0, 3]}]}})");
  ASSERT_FALSE(path.times.empty());
  const PathVerification proof = verify_path(path);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  // At its speed of 1 rad/s the first arm would be at the gate long before it opens.
  PlannedPath early = path;
  early.waypoints = {{0.8, -0.8}, {0.8, 0.8}, {-0.8, 0.8}, {-0.8, 0.8}};
  early.times = {0.0, 1.6, 3.2, 8.0};
  early.clearances.assign(3, 0.0);
  early.clearance = 0.0;
  EXPECT_EQ(verify_path(early).problem_edge, 0u);
}

/// A part passes a gate that has to open before it, and is closed at the end.
PlannedPath path_through_gate(const test::ArmFolder& folder) {
  folder.write("gate.urdf", R"(<robot name="gate"><link name="rail"/>
    <link name="gate"><collision><geometry><box size="0.1 0.5 0.5"/></geometry></collision></link>
    <joint name="slide" type="prismatic"><parent link="rail"/><child link="gate"/>
      <origin xyz="0.1 0 0"/><axis xyz="0 1 0"/><limit lower="0" upper="1" velocity="1" effort="1"/></joint></robot>)");
  const Scene scene = parse_scene(R"({"firstcontact": 1, "bodies": [
    {"name": "left", "shape": {"box": {"size": [0.00001, 1.8, 4]}}, "pose": {"position": [0, -1.1, 0]}},
    {"name": "right", "shape": {"box": {"size": [0.00001, 1.8, 4]}}, "pose": {"position": [0, 1.1, 0]}},
    {"name": "below", "shape": {"box": {"size": [0.00001, 0.41, 1.8]}}, "pose": {"position": [0, 0, -1.1]}},
    {"name": "above", "shape": {"box": {"size": [0.00001, 0.41, 1.8]}}, "pose": {"position": [0, 0, 1.1]}},
    {"name": "part", "shape": {"box": {"size": [0.2, 0.1, 0.1]}}, "pose": {"position": [-0.5, 0, 0]}}],
    "robots": [{"name": "gate", "urdf": "gate.urdf"}],
    "plan": {"robot": "gate", "body": "part", "time": 30,
      "goal": {"gate/slide": 0, "part": {"position": [0.5, 0.05, 0], "rpy": [0, 0, 1]}},
      "box": [[-0.8, -0.8, -0.8], [0.8, 0.8, 0.8]]}})",
                                  folder.path() / "scene.json");
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(scene, scene.plan.value(), cache);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  EXPECT_EQ(result.verdict, PlanVerdict::proven);
  return parse_planned_path(write_planned_path(planned_path(plan, plan.options, result)),
                            folder.path() / "path.json");
}

TEST(RobotAndBodyPath, IsProvenFromItsFile) {
  const test::ArmFolder folder;
  const PlannedPath path = path_through_gate(folder);
  const PathVerification proof = verify_path(path);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_EQ(proof.edges, path.waypoints.size() - 1);
  EXPECT_TRUE(proof.reaches_goal);
  EXPECT_EQ(proof.tested, 4u + 4u + 1u);  // Each with the wall, and with each other.
  // Straight on the gate is shut.
  PlannedPath straight = path;
  straight.waypoints = {path.waypoints.front(), path.waypoints.back()};
  straight.clearances = {0.0};
  straight.clearance = 0.0;
  EXPECT_EQ(verify_path(straight).verdict, ProofVerdict::refuted);
  // An approximate path measures the distance of both as the planner does.
  PlannedPath early = path;
  early.is_proven = false;
  early.goal.reset();
  early.waypoints.pop_back();
  early.clearances.pop_back();
  early.clearance.reset();
  for (const auto& clearance : early.clearances) {
    early.clearance = std::min(early.clearance.value_or(*clearance), *clearance);
  }
  ShapeCache cache;
  const Scene scene = path.scene;
  PlanQuestion question{.robots = {0}, .body = 4, .goals = {{{"gate/slide", 0.0}}}};
  const ScenePlan plan = make_scene_plan(scene, question, cache);
  early.distance_to_goal = plan.plan.space.distance(early.waypoints.back(), path.goals.front());
  const PathVerification of_early = verify_path(early);
  EXPECT_EQ(of_early.verdict, ProofVerdict::proven) << of_early.problem;
}

TEST(RobotAndBodyPath, IsBrokenWhereItContradictsItself) {
  const test::ArmFolder folder;
  const PlannedPath path = path_through_gate(folder);
  ASSERT_EQ(path.joints.at(4), "part/rot_w");
  const auto problem_of = [&](const auto& change) {
    PlannedPath changed = path;
    change(changed);
    const PathVerification result = verify_path(changed);
    EXPECT_EQ(result.verdict, ProofVerdict::broken);
    return result.problem;
  };
  const auto drop_last = [](PlannedPath& changed) {
    changed.joints.pop_back();
    changed.turnings.pop_back();
    for (auto* rows : {&changed.waypoints, &changed.goals}) {
      for (std::vector<double>& row : *rows) {
        row.pop_back();
      }
    }
  };
  EXPECT_NE(problem_of(drop_last).find("a part of the pose"), std::string::npos);
  EXPECT_NE(
      problem_of([](PlannedPath& changed) { changed.waypoints[1][4] *= 1.5; }).find("length 1"),
      std::string::npos);
  EXPECT_NE(problem_of([](PlannedPath& changed) {
              changed.waypoints.front()[1] -= 0.01;
            }).find("does not begin where its scene has body"),
            std::string::npos);
  EXPECT_NE(problem_of([](PlannedPath& changed) {
              changed.joints[1] = "part/x";
            }).find("no number of a pose"),
            std::string::npos);
}

}  // namespace
}  // namespace firstcontact
