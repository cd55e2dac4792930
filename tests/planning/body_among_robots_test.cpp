// A rigid body is planned among robots: these rest, or move on their trajectories, with what they
// hold.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include <Eigen/Core>

#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

constexpr double kBall = 0.05;     // [m]  Radius of the body.
constexpr double kMargin = 0.001;  // [m]
constexpr double kPadding = 0.02;  // [m]  Of the tool.

/// A ball, and a gantry whose tool is a box of 0.2 m between its start and its goal.
class BodyAmongRobots : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("body_among_robots_" + std::to_string(getpid()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "gantry.urdf") << R"(<robot name="gantry">
      <link name="base"/>
      <link name="tool"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
      <joint name="z" type="prismatic"><parent link="base"/><child link="tool"/>
        <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    </robot>)";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// @param robot  members of the robot besides its name and its file
  /// @param more   further members of the plan of the ball
  [[nodiscard]] ScenePlan plan(const std::string& robot, const std::string& more,
                               const std::string& start = "[-0.5, 0, 0]") const {
    const Scene scene = parse_scene(R"({"firstcontact": 1, "bodies": [
        {"name": "load", "shape": {"box": {"size": [0.2, 0.2, 0.2]}}, "pose": {"position": [0, 0, 9]}},
        {"name": "ball", "shape": {"sphere": {"radius": 0.05}}, "pose": {"position": )" +
                                        start + R"(}}],
        "robots": [{"name": "g", "urdf": "gantry.urdf", "padding": {"tool": 0.02}, )" +
                                        robot + R"(}],
        "plan": {"body": "ball", "goal": {"position": [0.5, 0, 0]}, "margin": 0.001, )" +
                                        more + "}}",
                                    folder_ / "scene.json", 1, {});
    ShapeCache cache;
    return make_scene_plan(scene, *scene.plan, cache);
  }

  [[nodiscard]] static PlanResult solve(const ScenePlan& plan) {
    return plan_path(plan.plan, plan.start, plan.goals, plan.options);
  }

  std::filesystem::path folder_;
};

double distance_to_box(const Vector3d& ball, const Vector3d& middle) {
  return ((ball - middle).cwiseAbs() - Vector3d::Constant(0.1)).cwiseMax(0.0).norm() - kBall;
}

/// Samples the path densely. Without times each edge takes a second.
double least_gap(const PlanResult& result,
                 const std::function<double(const Vector3d& ball, double time)>& gap) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
    const Vector3d from(result.path[k].data());
    const Vector3d to(result.path[k + 1].data());
    const double begin = result.times.empty() ? static_cast<double>(k) : result.times[k];
    const double end = result.times.empty() ? begin + 1.0 : result.times[k + 1];
    for (int i = 0; i <= 20'000; ++i) {
      const double share = i / 20'000.0;
      least = std::min(least, gap(from + share * (to - from), begin + share * (end - begin)));
    }
  }
  return least;
}

// Without a box, the body has room around links, with their paddings.
TEST_F(BodyAmongRobots, HasRoomAroundRobots) {
  const ScenePlan beside = plan(R"("state": {"z": 2})", R"("seed": 1)");
  EXPECT_GT(beside.plan.space.high().z(), 9.0);
  std::ofstream(folder_ / "gantry.urdf") << R"(<robot name="gantry"><link name="tool">
      <collision><geometry><box size="0.2 30 30"/></geometry></collision></link></robot>)";
  const ScenePlan around = plan(R"("state": {})", R"("seed": 1)");
  EXPECT_GT(around.plan.space.high().y(), 15.0 + 2.0 * kBall + kMargin + kPadding);
  EXPECT_EQ(solve(around).verdict, PlanVerdict::proven);
}

TEST_F(BodyAmongRobots, PassesARobotAtRest) {
  const ScenePlan asked = plan(R"("state": {"z": 0})", R"("seed": 1)");
  const PlanResult result = solve(asked);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_GT(result.path.size(), 2u);
  const double least = least_gap(
      result, [](const Vector3d& ball, double) { return distance_to_box(ball, Vector3d::Zero()); });
  EXPECT_GT(least, kMargin + kPadding);
  EXPECT_GE(least, **std::ranges::min_element(result.clearances));
  ASSERT_FALSE(result.statistics.blocked.empty());
  const PlannedPath path = planned_path(asked, asked.options, result);
  EXPECT_EQ(path.body, "ball");
  EXPECT_EQ(path.statistics.blocked.front().pair, (std::array<std::string, 2>{"ball", "g/tool"}));
  EXPECT_EQ(parse_planned_path(write_planned_path(path), "path.json").waypoints, result.path);
  // Where the tool is above, the way is straight.
  EXPECT_EQ(solve(plan(R"("state": {"z": 1})", R"("seed": 1)")).path.size(), 2u);
}

TEST_F(BodyAmongRobots, PassesWhatARobotHolds) {
  // The tool is above, but its load is in the way.
  const std::string holds = R"("state": {"z": 0.5}, "attached": [{"body": "load", "link": "tool",
      "pose": {"position": [0, 0, -0.5]}}])";
  const PlanResult result = solve(plan(holds, R"("seed": 1)"));
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  const double least = least_gap(
      result, [](const Vector3d& ball, double) { return distance_to_box(ball, Vector3d::Zero()); });
  EXPECT_GT(least, kMargin);
}

/// The robot lifts its tool for the middle of 8 s, out of a channel along x.
constexpr const char* kLifts = R"("trajectory": {"joint_names": ["z"], "points": [
    {"time": 0, "positions": [0]}, {"time": 3, "positions": [1]}, {"time": 6, "positions": [0]},
    {"time": 8, "positions": [0]}]})";
constexpr const char* kInChannel = R"("speeds": {"linear": 1, "angular": 2}, "time": 20,
    "box": [[-1, -0.01, -0.01], [1, 0.01, 0.01]])";

double tool_z(double time) {
  return time < 3.0 ? time / 3.0 : time < 6.0 ? (6.0 - time) / 3.0 : 0.0;
}

TEST_F(BodyAmongRobots, WaitsForARobotThatMoves) {
  const ScenePlan asked = plan(kLifts, kInChannel);
  ASSERT_TRUE(asked.plan.times.has_value());
  const PlanResult result = solve(asked);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_EQ(result.times.back(), 8.0);
  const double least = least_gap(result, [](const Vector3d& ball, double time) {
    return distance_to_box(ball, {0.0, 0.0, tool_z(time)});
  });
  EXPECT_GT(least, kMargin + kPadding);
  EXPECT_GE(least, *result.clearances.front() - 1e-9);
}

TEST_F(BodyAmongRobots, HasNoAnswerWhereARobotIsInTheWayAllTheTime) {
  std::string still = kLifts;
  still.replace(still.find("[1]"), 3, "[0.1]");  // Lifts by too little.
  EXPECT_EQ(solve(plan(still, R"("speeds": {"linear": 1, "angular": 2}, "time": 0.5,
      "box": [[-1, -0.01, -0.01], [1, 0.01, 0.01]])"))
                .verdict,
            PlanVerdict::none);
}

TEST_F(BodyAmongRobots, OpensFromALinkThatItTouches) {
  const std::string pairs =
      R"("contact_pairs": [{"pair": ["ball", "g/tool"], "policy": "must_open"}], "seed": 1)";
  const std::string start = "[-0.1505, 0, 0]";  // 0.5 mm beside the tool.
  EXPECT_THROW((void)solve(plan(R"("state": {"z": 0})", R"("seed": 1)", start)),
               std::invalid_argument);
  const PlanResult result = solve(plan(R"("state": {"z": 0})", pairs, start));
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  PlanResult later = result;
  later.path.erase(later.path.begin());
  const auto gap = [](const Vector3d& ball, double) {
    return distance_to_box(ball, Vector3d::Zero());
  };
  EXPECT_GT(least_gap(result, gap), 0.0005 * 15.0 / 16.0 - 1e-9);
  EXPECT_GT(least_gap(later, gap), kMargin + kPadding);
}

TEST_F(BodyAmongRobots, RefusesWhatARobotHolds) {
  EXPECT_THROW((void)plan(R"("state": {"z": 1}, "attached": [{"body": "ball", "link": "tool"}])",
                          R"("seed": 1)"),
               std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
