// Plans among things that move, judged by closed forms at many times, and by a second proof.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/planning/detail/planned_speeds.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/robot_check/touching_links.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>

#include "robot/planar_arm.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.2;  // [m]  Of the ball.

/// A ball in a channel along x, and a door across it that is open in the middle of 8 s.
std::string door_scene(double goal) {
  return R"({"firstcontact": 1,
    "bodies": [
      {"name": "ball", "shape": {"sphere": {"radius": 0.2}}},
      {"name": "door", "shape": {"box": {"size": [0.02, 3, 3]}},
       "motion": {"type": "waypoints", "times": [0, 3, 6, 8],
                  "poses": [{"position": [1, 0, 0]}, {"position": [1, 4, 0]}, {"position": [1, 0, 0]}, {"position": [1, 0, 0]}]}}],
    "plan": {"body": "ball", "goal": {"position": [)" +
         std::to_string(goal) + R"(, 0, 0]}, "speeds": {"linear": 1, "angular": 2},
             "box": [[-1, -0.01, -0.01], [3, 0.01, 0.01]], "time": 20}})";
}

ScenePlan plan_of(const std::string& text) {
  const Scene scene = parse_scene(text, "scene.json", 1, {});
  ShapeCache cache;
  return make_scene_plan(scene, *scene.plan, cache);
}

/// Where the door is.
double door_y(double time) {
  return time < 3.0 ? 4.0 * time / 3.0 : time < 6.0 ? 4.0 * (6.0 - time) / 3.0 : 0.0;
}

double distance_to_door(const Vector3d& ball, double time) {
  const Vector3d off = (ball - Vector3d(1.0, door_y(time), 0.0)).cwiseAbs();
  return (off - Vector3d(0.01, 1.5, 1.5)).cwiseMax(0.0).norm() - kRadius;
}

/// The place of the ball at a time.
Vector3d ball_at(const PlanResult& result, double time) {
  std::size_t k = 0;
  while (k + 2 < result.times.size() && result.times[k + 1] <= time) {
    ++k;
  }
  const double share = (time - result.times[k]) / (result.times[k + 1] - result.times[k]);
  const auto place = [&](std::size_t i) {
    return Vector3d(result.path[i][0], result.path[i][1], result.path[i][2]);
  };
  return place(k) + std::clamp(share, 0.0, 1.0) * (place(k + 1) - place(k));
}

TEST(PlanInTime, WaitsUntilTheDoorIsOpen) {
  const ScenePlan plan = plan_of(door_scene(2.0));
  ASSERT_TRUE(plan.plan.times.has_value());
  EXPECT_EQ(plan.plan.times->duration, 8.0);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_EQ(result.path.front(), plan.start);
  EXPECT_EQ(result.path.back(), plan.goals.front());
  EXPECT_EQ(result.times.front(), 0.0);
  EXPECT_EQ(result.times.back(), 8.0);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= 80'000; ++k) {
    const double time = k * 1e-4;
    least = std::min(least, distance_to_door(ball_at(result, time), time));
  }
  EXPECT_GT(least, 0.0);
  EXPECT_GE(least, *result.clearances.front() - 1e-9);  // Proven, so no more than is seen.
  for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
    const double dt = result.times[k + 1] - result.times[k];
    EXPECT_GT(dt, 0.0);
    EXPECT_LE(
        plan.plan.space.travel_time(result.path[k], result.path[k + 1], plan.plan.times->speeds),
        dt * (1.0 + 1e-9));
  }
}

TEST(PlanInTime, HasNoAnswerWhereTheDoorIsShutAgain) {
  ScenePlan plan = plan_of(door_scene(2.0));
  // The ball is at the door after 4.4 s, and needs another second; the door is open until 4.7 s.
  plan.start[0] = -0.9;
  plan.plan.times->speeds[0] = 0.38;
  plan.options.time = 0.3;
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict, PlanVerdict::none);
  plan.plan.times->speeds[0] = 0.36;  // Not even without the door.
  EXPECT_THROW((void)plan_path(plan.plan, plan.start, plan.goals, plan.options),
               std::invalid_argument);
}

TEST(PlanInTime, IsTheSameForASeed) {
  const ScenePlan plan = plan_of(door_scene(2.0));
  const auto answer = [&](int threads) {
    PlanOptions options = plan.options;
    options.threads = threads;
    return plan_path(plan.plan, plan.start, plan.goals, options);
  };
  EXPECT_EQ(answer(1).path, answer(2).path);
  EXPECT_EQ(answer(1).times, answer(1).times);
}

// Every edge of both trees keeps clear of the door at all of its times.
TEST(PlanInTime, KeepsTreesWithFreeEdges) {
  const ScenePlan plan = plan_of(door_scene(2.0));
  PlanOptions options = plan.options;
  const PlanResult without = plan_path(plan.plan, plan.start, plan.goals, options);
  options.keep_trees = true;
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, options);
  EXPECT_TRUE(without.trees.empty());
  EXPECT_EQ(without.path, result.path);
  EXPECT_EQ(without.times, result.times);
  ASSERT_EQ(result.trees.size(), 2u);
  EXPECT_EQ(result.trees[0].places.size() + result.trees[1].places.size(), result.statistics.nodes);
  for (const SearchTree& tree : result.trees) {
    ASSERT_EQ(tree.times.size(), tree.places.size());
    ASSERT_FALSE(tree.edges.empty());
    for (const auto& [parent, child] : tree.edges) {
      const bool is_forward = tree.kind == SearchTreeKind::from_start;
      EXPECT_EQ(is_forward, tree.times[parent] < tree.times[child]);
      const auto at = [&](std::size_t node, double share) {
        const Configuration& q = tree.places[node];
        return Vector3d(share * Vector3d(q[0], q[1], q[2]));
      };
      for (int k = 0; k <= 20; ++k) {
        const double share = k / 20.0;
        const double time = (1.0 - share) * tree.times[parent] + share * tree.times[child];
        EXPECT_GT(distance_to_door(at(parent, 1.0 - share) + at(child, share), time), 0.0);
      }
    }
  }
}

/// A cart that has to go around a wall, while something far away moves.
std::string wall_scene(double duration, int seed) {
  return R"({"firstcontact": 1,
    "bodies": [
      {"name": "cart", "shape": {"box": {"size": [0.3, 0.3, 0.3]}}},
      {"name": "wall", "shape": {"box": {"size": [0.1, 2, 2]}}, "pose": {"position": [1, 0, 0]}},
      {"name": "far", "shape": {"box": {"size": [0.1, 0.1, 0.1]}},
       "motion": {"type": "waypoints", "times": [0, )" +
         std::to_string(duration) +
         R"(], "poses": [{"position": [50, 0, 0]}, {"position": [51, 0, 0]}]}}],
    "plan": {"body": "cart", "goal": {"position": [2, 0, 0]}, "speeds": {"linear": 1, "angular": 1},
             "box": [[-1, -2.5, -2.5], [3, 2.5, 2.5]], "time": 20, "seed": )" +
         std::to_string(seed) + "}}";
}

/// [s]  The time from which a motion rests at its goal.
double arrival_of(const PlanResult& result) {
  std::size_t last = result.path.size() - 1;
  while (last > 0 && result.path[last - 1] == result.path.back()) {
    --last;
  }
  return result.times[last];
}

// Around the wall it is 3.06 m at 1 m/s; shortcuts at random come near that.
TEST(PlanInTime, ArrivesAsEarlyInALongSceneAsInAShortOne) {
  for (const double duration : {20.0, 1000.0}) {
    for (int seed = 1; seed <= 5; ++seed) {
      const ScenePlan plan = plan_of(wall_scene(duration, seed));
      const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
      ASSERT_EQ(result.verdict, PlanVerdict::proven);
      EXPECT_GT(arrival_of(result), 3.05);
      EXPECT_LT(arrival_of(result), 5.0) << duration << " s, seed " << seed;
      EXPECT_EQ(result.times.back(), duration);
      ASSERT_TRUE(result.statistics.first_cost.has_value());
      EXPECT_LE(result.cost, *result.statistics.first_cost);
    }
  }
}

TEST(PlanInTime, LeavesTheMotionAsItWasFoundWithoutShortcuts) {
  ScenePlan plan = plan_of(wall_scene(100.0, 5));
  const PlanResult shortened = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  plan.options.shortcuts = 0;
  const PlanResult found = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(found.verdict, PlanVerdict::proven);
  EXPECT_EQ(found.cost, found.statistics.first_cost);
  EXPECT_EQ(shortened.statistics.first_cost, found.statistics.first_cost);
  EXPECT_LT(shortened.cost, found.cost);
  EXPECT_LT(arrival_of(shortened), arrival_of(found));
}

// The ball gets through the door once that is 1.7 m aside, after 1.275 s, and no sooner.
TEST(PlanInTime, ArrivesAsSoonAsTheDoorLetsItThrough) {
  const ScenePlan plan = plan_of(door_scene(2.0));
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_GT(arrival_of(result), 2.0);
  EXPECT_LT(arrival_of(result), 3.0);
}

/// A finger that closes at up to 1 m/s, one that follows it twice as fast, and one behind that.
RobotModel geared_gripper() {
  RobotDescription robot{.name = "gripper", .links = {{"base"}, {"a"}, {"b"}, {"c"}}, .joints = {}};
  const auto joint = [](const char* name, const char* parent, const char* child, double speed) {
    Joint made{.name = name, .type = JointType::prismatic, .parent = parent, .child = child};
    made.limits = {.lower = -1.0, .upper = 1.0, .velocity = speed};
    return made;
  };
  robot.joints = {joint("lead", "base", "a", 1.0), joint("twice", "base", "b", 0.5),
                  joint("again", "base", "c", 0.9)};
  robot.joints[1].mimic = {.joint = "lead", .multiplier = -2.0};
  robot.joints[2].mimic = {.joint = "twice", .multiplier = 3.0};
  return RobotModel(robot);
}

// The lead may run at a sixth of 0.9 m/s, and at a half of 0.5 m/s.
TEST(PlanInTime, KeepsTheSpeedsOfJointsThatMimic) {
  const RobotMotion rest = at_rest(geared_gripper());
  const std::vector<std::string> names{"lead"};
  const ConfigurationSpace space =
      ConfigurationSpace::of_joints(rest.model(), names, {{"lead", ramp(0.0, 0.0)}});
  for (const double given : {0.0, 5.0, 0.1}) {
    PlanQuestion question{.robots = {0}};
    if (given > 0.0) {
      question.speeds["lead"] = given;
    }
    const std::vector<double> speeds = detail::planned_speeds(question, space, "robot \"r\"");
    ASSERT_EQ(speeds.size(), 1u);
    EXPECT_LE(6.0 * speeds[0], 0.9);
    EXPECT_NEAR(speeds[0], given == 0.1 ? 0.1 : 0.15, 1e-12);
  }
}

TEST(PlanInTime, NeedsAGoalThatIsFreeAtTheEnd) {
  const auto message = [](const std::string& text) {
    try {
      const ScenePlan plan = plan_of(text);
      (void)plan_path(plan.plan, plan.start, plan.goals, plan.options);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  // The ball reaches 0.11 m beyond the near side of the door, which is shut at the end.
  const std::string blocked = message(door_scene(0.9));
  EXPECT_NE(blocked.find(
                "the goal, at the end of the time, is not free: \"ball\" and \"door\" "
                "touch, up to 0.11 m deep; the nearest free configuration that was found is at "),
            std::string::npos)
      << blocked;
  const double offered = std::stod(blocked.substr(blocked.find(" is at ") + 7));
  EXPECT_LT(offered, 0.79);
  EXPECT_GT(offered, 0.78);
  std::string without = door_scene(2.0);
  without.erase(without.find(R"("speeds")"),
                std::string(R"("speeds": {"linear": 1, "angular": 2}, )").size());
  EXPECT_NE(message(without).find("\"speeds\""), std::string::npos);
}

// A surface alone has room inside, but there is no way in.
TEST(PlanInTime, RefusesAGoalInsideASolid) {
  const auto answer = [](const std::string& solid) {
    const std::string text = R"({"firstcontact": 1, "options": {"duration": 2}, "bodies": [
      {"name": "room", "shape": {"vertices": [[-1, -1, -1], [3, -1, -1], [-1, 3, -1], [-1, -1, 3]],
       "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], "solid": )" +
                             solid + R"(}},
      {"name": "cart", "shape": {"sphere": {"radius": 0.1}}, "motion": {"type": "waypoints",
       "times": [0, 2], "poses": [{"position": [5, 5, 5]}, {"position": [5, 5, 6]}]}},
      {"name": "ball", "shape": {"sphere": {"radius": 0.05}}, "pose": {"position": [-2, 0, 0]}}],
      "plan": {"body": "ball", "goal": {"position": [-0.5, -0.5, -0.5]}, "time": 0.2,
               "speeds": {"linear": 5, "angular": 2}}})";
    try {
      const ScenePlan plan = plan_of(text);
      const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
      return std::string(result.verdict == PlanVerdict::none ? "none" : "a path");
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(answer("false"), "none");
  EXPECT_NE(answer("true").find("the goal, at the end of the time, is not free: \"room\" and"),
            std::string::npos)
      << answer("true");
}

TEST(PlanInTime, WritesAPathWithTimes) {
  const ScenePlan plan = plan_of(door_scene(2.0));
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  const PlannedPath path = planned_path(plan, plan.options, result);
  const std::string text = write_planned_path(path);
  const PlannedPath read = parse_planned_path(text, "path.json");
  EXPECT_EQ(read.times, result.times);
  EXPECT_EQ(read.scene.duration, 8.0);
  EXPECT_EQ(write_planned_path(read), text);
}

/// An arm of one bar that waits, among another one that sweeps a quarter turn.
/// A box that may move in a plane: where it is at a time, and half its size.
struct BoxInPlane {
  Vector3d middle;
  double yaw = 0.0;  // [rad]
  Vector3d half;

  [[nodiscard]] double distance(const Vector3d& p) const {
    const Vector3d in = Eigen::AngleAxisd(-yaw, Vector3d::UnitZ()) * (p - middle);
    return (in.cwiseAbs() - half).cwiseMax(0.0).norm();
  }
};

/// [m]  The least distance of points of the moved box from others, each 5 ms; points 25 mm apart.
template <class OthersAt>
double least_in_time(const PlanResult& result, const Vector3d& half, const OthersAt& others) {
  std::vector<Vector3d> points;
  for (double x = -half.x(); x <= half.x() + 1e-9; x += 0.025) {
    for (double y = -half.y(); y <= half.y() + 1e-9; y += 0.025) {
      for (const double z : {-half.z(), 0.0, half.z()}) {
        points.emplace_back(x, y, z);
      }
    }
  }
  double least = std::numeric_limits<double>::infinity();
  std::size_t k = 0;
  for (double time = 0.0; time <= result.times.back(); time += 0.005) {
    while (k + 2 < result.times.size() && result.times[k + 1] <= time) {
      ++k;
    }
    const double share = (time - result.times[k]) / (result.times[k + 1] - result.times[k]);
    const Configuration& a = result.path[k];
    const Configuration& b = result.path[k + 1];
    const Vector3d from(a[0], a[1], a[2]);
    const Vector3d p = from + share * (Vector3d(b[0], b[1], b[2]) - from);
    const Eigen::Quaterniond R = Eigen::Quaterniond(a[3], a[4], a[5], a[6])
                                     .slerp(share, Eigen::Quaterniond(b[3], b[4], b[5], b[6]));
    for (const BoxInPlane& box : others(time)) {
      for (const Vector3d& point : points) {
        least = std::min(least, box.distance(p + R * point));
      }
    }
  }
  return least;
}

ScenePlan demo_plan(const std::string& name) {
  const Scene scene = read_scene(std::string(FIRSTCONTACT_SOURCE_DIR) + "/demo/plans/" + name);
  ShapeCache cache;
  return make_scene_plan(scene, *scene.plan, cache);
}

// Six boxes pass the belt at 0.5 m/s, and leave 0.5 m between them.
TEST(PlanInTime, CrossesAConveyorBetweenItsBoxes) {
  const ScenePlan plan = demo_plan("conveyor.json");
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(5, 1)); ++seed) {
    PlanOptions options = plan.options;
    options.seed = seed;
    const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, options);
    ASSERT_EQ(result.verdict, PlanVerdict::proven) << seed;
    EXPECT_GT(least_in_time(result, Vector3d::Constant(0.15),
                            [](double time) {
                              std::vector<BoxInPlane> boxes;
                              for (int k = 0; k < 6; ++k) {
                                boxes.push_back({.middle = {0.6, 1.2 - 0.8 * k + 0.5 * time, 0.0},
                                                 .half = Vector3d::Constant(0.15)});
                              }
                              return boxes;
                            }),
              0.0)
        << seed;
  }
}

// Two wings turn once in 10 s. A cart has to walk along between them.
TEST(PlanInTime, GoesThroughARevolvingDoor) {
  const ScenePlan plan = demo_plan("revolving_door.json");
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(rounds(5, 1)); ++seed) {
    PlanOptions options = plan.options;
    options.seed = seed;
    const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, options);
    ASSERT_EQ(result.verdict, PlanVerdict::proven) << seed;
    EXPECT_GT(least_in_time(result, {0.2, 0.2, 0.5},
                            [](double time) {
                              const double yaw = 0.2 * std::numbers::pi * time;
                              const Vector3d o = Vector3d::Zero();
                              return std::vector<BoxInPlane>{
                                  {.middle = o, .yaw = yaw, .half = {1.0, 0.02, 1.0}},
                                  {.middle = o, .yaw = yaw, .half = {0.02, 1.0, 1.0}},
                                  {.middle = {0.0, -2.05, 0.0}, .half = {0.05, 1.0, 1.0}},
                                  {.middle = {0.0, 2.05, 0.0}, .half = {0.05, 1.0, 1.0}}};
                            }),
              0.0)
        << seed;
  }
}

TEST(PlanInTime, LetsAnArmPassAnotherOne) {
  RobotScene scene;
  const RobotMotion at_rest = planar_motion({ramp(0.0, 0.0)});
  const std::size_t mover = scene.add_robot("mover", at_rest);
  scene.add_robot(
      "other", planar_motion({ramp(-2.8, -0.4)}, Motion::fixed({{1.5, 0.0, 0.0}, {1, 0, 0, 0}})));
  const std::vector<std::string> names{"j0"};
  PlanScene plan{
      .scene = scene,
      .robots = {mover},
      .space = ConfigurationSpace::of_joints(at_rest.model(), names, {{"j0", ramp(0.0, 0.0)}})};
  plan.times = PlanTimes{4.0, {1.0}};
  const Configuration start{1.2};
  const Configuration goal{-1.2};
  const PlanResult result = plan_path(plan, start, {goal}, {.time = 20.0});
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  for (int k = 0; k <= 4000; ++k) {
    const double time = k * 1e-3;
    std::size_t i = 0;
    while (i + 2 < result.times.size() && result.times[i + 1] <= time) {
      ++i;
    }
    const double share =
        std::clamp((time - result.times[i]) / (result.times[i + 1] - result.times[i]), 0.0, 1.0);
    const double way =
        std::remainder(result.path[i + 1][0] - result.path[i][0], 2.0 * std::numbers::pi);
    const double q = result.path[i][0] + share * way;
    const double other = -2.8 + 2.4 * time / 4.0;
    const Eigen::Vector2d base(1.5, 0.0);
    EXPECT_GT(segments_distance({0, 0}, {std::cos(q), std::sin(q)}, base,
                                base + Eigen::Vector2d(std::cos(other), std::sin(other))),
              2.0 * kBarRadius)
        << time;
  }
}

}  // namespace
}  // namespace firstcontact::test
