// Several robots that are planned at once: one space of the coordinates of all of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/edges/inverse_kinematics.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>

#include "planning/plan_cases.h"
#include "scene/robot_text.h"

namespace firstcontact::test {
namespace {

constexpr double kCube = 0.2;  // [m]  Of the cubes of gantries.

/// Two gantries of the same slides: cubes that move without turning.
PlanScene two_gantries(RobotScene scene = RobotScene()) {
  const RobotMotion rest = at_rest(gantry());
  const std::vector<std::string> joints = {"x", "y", "z"};
  const std::vector<std::string> names = {"a", "b"};
  const std::vector<ConfigurationSpace> spaces(
      2, ConfigurationSpace::of_joints(rest.model(), joints, detail::given_motions(rest)));
  std::vector<std::size_t> robots;
  for (const std::string& name : names) {
    robots.push_back(scene.add_robot(name, rest));
  }
  return {.scene = std::move(scene),
          .robots = robots,
          .space = ConfigurationSpace::joined(names, spaces)};
}

/// The first time at which a point on a straight way is within `half` of the origin in all axes.
std::optional<double> time_in_cube(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                   double half) {
  double begin = 0.0;
  double end = 1.0;
  for (int k = 0; k < 3; ++k) {
    const double way = to[k] - from[k];
    if (way == 0.0) {
      if (std::abs(from[k]) > half) {
        return std::nullopt;
      }
      continue;
    }
    const auto [first, last] = std::minmax({(-half - from[k]) / way, (half - from[k]) / way});
    begin = std::max(begin, first);
    end = std::min(end, last);
  }
  return begin <= end ? std::optional(begin) : std::nullopt;
}

/// Returns the pose of robot b in the axes of robot a.
Eigen::Vector3d relative(const Configuration& q) { return {q[3] - q[0], q[4] - q[1], q[5] - q[2]}; }

TEST(SeveralRobots, AreOneSpace) {
  const PlanScene plan = two_gantries();
  const ConfigurationSpace& space = plan.space;
  EXPECT_EQ(space.size(), 6u);
  EXPECT_EQ(space.mover_count(), 2u);
  EXPECT_EQ(space.coordinates()[1].name, "a/y");
  EXPECT_EQ(space.coordinates()[3].name, "b/x");
  EXPECT_EQ(space.coordinates()[3].mover, 1u);
  const Configuration from = {1, 0, 0, -1, 0, 0};
  const Configuration to = {1, 0, 0, 2, 4, 0};
  EXPECT_EQ(space.distance(from, to), 5.0);
  EXPECT_EQ(space.interpolate(from, to, 0.5), (Configuration{1, 0, 0, 0.5, 2, 0}));
  EXPECT_NE(space.defect({0, 0, 0, 0, 2.5, 0}).value_or("").find("\"b/y\""), std::string::npos);
  RobotScene scene = plan.scene;
  plan.set_motions(scene, from, to);
  EXPECT_EQ(scene.pose(3, 0.5).position, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(scene.pose(7, 0.5).position, Eigen::Vector3d(0.5, 2, 0));
}

TEST(SeveralRobots, RefuseWhatIsNoMover) {
  const RobotMotion rest = at_rest(gantry());
  const std::vector<std::string> joints = {"x"};
  const std::vector<ConfigurationSpace> one = {
      ConfigurationSpace::of_joints(rest.model(), joints, detail::given_motions(rest))};
  const std::vector<std::string> two_names = {"a", "b"};
  EXPECT_THROW((void)ConfigurationSpace::joined(two_names, one), std::invalid_argument);
  EXPECT_THROW((void)ConfigurationSpace::joined({}, {}), std::invalid_argument);
  const std::vector<ConfigurationSpace> screw = {ConfigurationSpace::of_body(
      "box", make_box({1, 1, 1}), {-1, -1, -1}, {1, 1, 1}, BodyEdges::screw)};
  const std::vector<std::string> name = {"a"};
  EXPECT_THROW((void)ConfigurationSpace::joined(name, screw), std::invalid_argument);
  const std::vector<ConfigurationSpace> both = {ConfigurationSpace::joined(name, one), one.front()};
  EXPECT_NO_THROW((void)ConfigurationSpace::joined(two_names, both));
  const std::vector<ConfigurationSpace> nested = {ConfigurationSpace::joined(two_names, both),
                                                  one.front()};
  EXPECT_THROW((void)ConfigurationSpace::joined(two_names, nested), std::invalid_argument);
  PlanScene twice = two_gantries();
  twice.robots = {0, 0};
  EXPECT_THROW(EdgeChecker{twice}, std::invalid_argument);
  PlanScene few = two_gantries();
  few.robots = {0};
  EXPECT_THROW(EdgeChecker{few}, std::invalid_argument);
}

// Two cubes that do not turn touch when the one's centre enters a cube around the other's.
TEST(SeveralRobots, TouchWhenTheClosedFormSays) {
  const EdgeChecker checker(two_gantries());
  const double reach = kCube + checker.options().extra_clearance;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-0.6, 0.6);
  int blocked = 0;
  for (int k = 0; k < 400; ++k) {
    Configuration from(6);
    Configuration to(6);
    std::ranges::generate(from, [&] { return place(random); });
    std::ranges::generate(to, [&] { return place(random); });
    const std::optional<double> within =
        time_in_cube(relative(from), relative(to), reach + checker.options().tolerance);
    const std::optional<double> touch = time_in_cube(relative(from), relative(to), kCube);
    const EdgeAnswer answer = checker.check(from, to);
    if (touch) {
      ++blocked;
      EXPECT_EQ(answer.verdict, EdgeVerdict::blocked) << k;
      EXPECT_LE(answer.fraction, *touch) << k;
      EXPECT_EQ(checker.scene().name(answer.pair.value()[0]), "a/tool");
      EXPECT_EQ(checker.scene().name(answer.pair.value()[1]), "b/tool");
    } else if (!within) {
      // Boxes that miss each other at their corners keep a round distance: it is farther.
      EXPECT_EQ(answer.verdict, EdgeVerdict::free) << k;
    }
    EXPECT_EQ(checker.check_quickly(from, to).verdict == EdgeVerdict::free,
              answer.verdict == EdgeVerdict::free)
        << k;
  }
  EXPECT_GT(blocked, 40);
}

TEST(SeveralRobots, ARobotIsBlockedByAnotherThatStandsStill) {
  const EdgeChecker checker(two_gantries());
  EXPECT_EQ(checker.check({-1, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 0, 0}).verdict, EdgeVerdict::blocked);
  EXPECT_EQ(checker.check({0, 0, 0, -1, 0, 0}, {0, 0, 0, 1, 0, 0}).verdict, EdgeVerdict::blocked);
  // Both go by the same way at the same time: they never meet.
  EXPECT_EQ(checker.check({-1, 0, 0, -0.5, 0, 0}, {1, 0, 0, 1.5, 0, 0}).verdict, EdgeVerdict::free);
}

/// Two cubes change sides of a wall through one window, in which one of them has room.
TEST(SeveralRobots, ChangeSidesThroughOneWindow) {
  const PlanScene plan = two_gantries(thin_wall(0.18));
  const Configuration start = {-0.5, 0, 0, 0.5, 0, 0};
  const Configuration goal = {0.5, 0, 0, -0.5, 0, 0};
  for (const Planner planner : {Planner::rrt_connect, Planner::lazy_prm_star}) {
    const PlanOptions options{.planner = planner, .seed = 2, .time = 60.0};
    const PlanResult result = plan_path(plan, start, {goal}, options);
    ASSERT_EQ(result.verdict, PlanVerdict::proven);
    EXPECT_EQ(result.path.front(), start);
    EXPECT_EQ(result.path.back(), goal);
    // A closed form of its own: neither cube meets the other, nor a side of the window.
    for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
      EXPECT_FALSE(time_in_cube(relative(result.path[k]), relative(result.path[k + 1]), kCube));
    }
  }
}

TEST(SeveralRobots, ReachAPoseWithOneOfThem) {
  const PlanScene plan = two_gantries();
  const LinkPoseGoal goal{
      .link = 3, .mover = 1, .X_WT = {{0.3, -0.4, 0.5}, Eigen::Quaterniond::Identity()}};
  const Configuration start = {0.1, 0.2, 0.3, 0, 0, 0};
  const std::vector<ReachedPose> places = reach_pose(plan.space, goal, start);
  ASSERT_FALSE(places.empty());
  for (const ReachedPose& place : places) {
    ASSERT_TRUE(reaches(place, goal));
    EXPECT_EQ(Configuration(place.q.begin(), place.q.begin() + 3), (Configuration{0.1, 0.2, 0.3}));
    EXPECT_NEAR(place.q[4], -0.4, 1e-6);
  }
  LinkPoseGoal unknown = goal;
  unknown.mover = 2;
  EXPECT_THROW((void)reach_pose(plan.space, unknown, start), std::invalid_argument);
}

TEST(SeveralRobots, ContactsLeadThroughAWindow) {
  const PlanScene plan = two_gantries(thin_wall(0.25));
  const PlanOptions options{.contacts = ContactUse::both, .seed = 1, .time = 60.0};
  const PlanResult result =
      plan_path(plan, {-0.5, 0.4, 0, 0.5, 0.4, 0}, {{0.5, -0.4, 0, -0.5, -0.4, 0}}, options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
}

/// Two arms of ArmFolder that face each other, 2 m apart: both at 0 they are in each other.
std::string facing_arms(const std::string& plan) {
  return R"({"firstcontact": 1, "robots": [
    {"name": "left", "urdf": "arm.urdf", "srdf": "arm.srdf", "state": {"elbow": -0.8}},
    {"name": "right", "urdf": "arm.urdf", "srdf": "arm.srdf", "state": {"elbow": 0.8},
     "base": {"position": [2, 0, 0], "rpy": [0, 0, 3.14159265358979]}}],
    "plan": )" +
         plan + "}";
}

ScenePlan plan_of(const std::string& text, const ArmFolder& folder) {
  const Scene scene = parse_scene(text, folder.path() / "scene.json");
  ShapeCache cache;
  return make_scene_plan(scene, scene.plan.value(), cache);
}

TEST(SeveralRobots, AreAskedForInScenes) {
  const ArmFolder folder;
  const ScenePlan plan = plan_of(
      facing_arms(
          R"({"robots": ["left", "right"], "goal": {"left/elbow": 0.8, "right/elbow": -0.8}})"),
      folder);
  EXPECT_EQ(plan.start, (Configuration{-0.8, 0.8}));
  EXPECT_EQ(plan.goals.front(), (Configuration{0.8, -0.8}));
  EXPECT_EQ(plan.plan.space.coordinates()[1].name, "right/elbow");
  const EdgeChecker checker(plan.plan);
  EXPECT_EQ(checker.check(plan.start, plan.goals.front()).verdict, EdgeVerdict::blocked);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_GT(result.path.size(), 2u);
}

TEST(SeveralRobots, TakeStatesBoundsAndPosesByTheirNames) {
  const ArmFolder folder;
  const ScenePlan plan =
      plan_of(facing_arms(R"({"robots": ["right", "left"], "start": {"left/elbow": -0.7},
        "bounds": {"left/elbow": [-0.75, 0.9]}, "joints": ["left/elbow", "right/elbow"],
        "goals": [["left/half", {"right/elbow": -0.5}]]})"),
              folder);
  EXPECT_EQ(plan.start, (Configuration{0.8, -0.7}));  // In the order of the robots.
  EXPECT_EQ(plan.goals.front(), (Configuration{-0.5, 0.5}));
  EXPECT_EQ(plan.plan.space.coordinates()[1].lower, -0.75);
  // The elbow at 0.6, and what it does to the tip.
  const double c = 1.05 * std::cos(0.6);
  const double s = 1.05 * std::sin(0.6);
  const ScenePlan reached =
      plan_of(facing_arms(R"({"robots": ["left", "right"], "joints": ["left/elbow", "right/elbow"],
        "goal": {"link": "left/tip", "pose": {"position": [)" +
                          std::to_string(c) + ", " + std::to_string(s) +
                          R"(, 0]}, "position_tolerance": 1e-3, "rotation_tolerance": 4}})"),
              folder);
  ASSERT_EQ(reached.goals.size(), 1u);
  EXPECT_NEAR(reached.goals.front()[0], 0.6, 1e-3);
  EXPECT_EQ(reached.goals.front()[1], 0.8);
}

TEST(SeveralRobots, NameWhatIsWrong) {
  const ArmFolder folder;
  const auto problem = [&](const std::string& plan) -> std::string {
    try {
      (void)plan_of(facing_arms(plan), folder);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  const auto says = [&](const std::string& plan, const std::string& words) {
    EXPECT_NE(problem(plan).find(words), std::string::npos) << plan << ": " << problem(plan);
  };
  says(R"({"goal": {"elbow": 0}})", "\"robots\"");
  says(R"({"robots": [], "goal": {"left/elbow": 0}})", "at least two robots");
  says(R"({"robots": ["left", "left"], "goal": {"left/elbow": 0}})", "a second time");
  says(R"({"robots": ["left", "rihgt"], "goal": {"left/elbow": 0}})", "did you mean \"right\"");
  says(R"({"robots": ["left"], "robot": "right", "goal": {"left/elbow": 0}})", "got both");
  says(R"({"robots": ["left"], "goal": {"left/elbow": 0}})", "a single one is \"robot\"");
  says(R"({"robots": ["left", "right"], "goal": {"elbow": 0}})", "ROBOT/NAME");
  says(R"({"robots": ["left", "right"], "goal": {"left/wrist": 0}})", "wrist");
  says(R"({"robots": ["left", "right"], "goal": ["left/quarter"]})", "quarter");
  says(R"({"robots": ["left", "right"], "goal": {"left/elbow": 0.5}})",
       "robot \"right\": no goal names a joint");
  says(R"({"robots": ["left", "right"], "goal": {"link": "right/thumb", "pose": {}}})", "thumb");
}

}  // namespace
}  // namespace firstcontact::test
