// Robots whose base, or any joint, floats: planned as a pose beside the coordinates of joints.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::test {
namespace {

// A drone, a bar of 0.6 m by 0.06 m by 0.06 m, with an arm of 0.3 m; a wall of 10 um with a window
// of 0.5 m by 0.5 m, through which the bar fits lengthwise with its arm stretched or folded.
constexpr const char* kDrone = R"(<robot name="drone"><link name="world"/>
  <link name="hull"><collision><geometry><box size="0.6 0.06 0.06"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.15 0 0"/><geometry><box size="0.3 0.04 0.04"/></geometry></collision></link>
  <joint name="base" type="floating"><parent link="world"/><child link="hull"/></joint>
  <joint name="elbow" type="revolute"><parent link="hull"/><child link="arm"/><origin xyz="0.33 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1.5" upper="1.5" velocity="1" effort="1"/></joint></robot>)";

constexpr const char* kDroneWindow = R"("bodies": [
  {"name": "left", "shape": {"box": {"size": [0.00001, 1.75, 4]}}, "pose": {"position": [0, -1.125, 0]}},
  {"name": "right", "shape": {"box": {"size": [0.00001, 1.75, 4]}}, "pose": {"position": [0, 1.125, 0]}},
  {"name": "below", "shape": {"box": {"size": [0.00001, 0.51, 1.75]}}, "pose": {"position": [0, 0, -1.125]}},
  {"name": "above", "shape": {"box": {"size": [0.00001, 0.51, 1.75]}}, "pose": {"position": [0, 0, 1.125]}}])";

constexpr const char* kDroneBounds =
    R"("bounds": {"base/trans_x": [-1.5, 1.5], "base/trans_y": [-1, 1], "base/trans_z": [-1, 1]})";

class DroneFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("floating_joint_test_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "drone.urdf") << kDrone;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// @param plan  the keys of the question
  [[nodiscard]] ScenePlan plan_with(const std::string& plan) const {
    const Scene scene = parse_scene(std::string(R"({"firstcontact": 1, )") + kDroneWindow +
                                        R"(, "robots": [{"name": "d", "urdf": "drone.urdf",
            "state": {"base": {"position": [-1, 0, 0], "rpy": [0, 0, 1.5707963267948966]}}}],
          "plan": {)" + plan + "}}",
                                    folder_ / "scene.json", 1, {});
    ShapeCache cache;
    return make_scene_plan(scene, *scene.plan, cache);
  }

  [[nodiscard]] std::string refusal(const std::string& plan) const {
    try {
      const ScenePlan made = plan_with(plan);
      (void)plan_path(made.plan, made.start, made.goals, made.options);
    } catch (const ParseError& error) {
      return error.what();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

std::string drone_through_window(const std::string& more = "") {
  return std::string(R"("goal": {"base": {"position": [1, 0.1, 0]}, "elbow": 0.5}, "time": 60, )") +
         kDroneBounds + more;
}

/// The start is a pose of MoveIt's start state, the bounds are MoveIt's workspace.
TEST_F(DroneFile, IsPlannedFromARequest) {
  std::ofstream(folder_ / "window.json") << R"({"firstcontact": 1, )" << kDroneWindow << "}";
  std::ofstream(folder_ / "drone.srdf")
      << "<robot name='drone'><group name='all'><joint name='base'/><joint name='elbow'/></group>"
         "<group_state name='away' group='all'><joint name='base' value='-1 0 0 0 0 0.6 0.8'/>"
         "</group_state></robot>";
  std::ofstream(folder_ / "request.yaml") << R"(
workspace_parameters: {min_corner: [-1.5, -1, -1], max_corner: [1.5, 1, 1]}
group_name: all
start_state:
  joint_state: {name: [elbow], position: [0.25]}
  multi_dof_joint_state:
    joint_names: [base]
    transforms: [{translation: [-1, 0, 0], rotation: [0, 0, 0.6, 0.8]}]
goal_constraints:
- joint_constraints:
  - {joint_name: base/trans_x, position: 1}
  - {joint_name: elbow, position: 0.5}
)";
  RobotQuestion asked{.robot = {.urdf = folder_ / "drone.urdf"},
                      .srdf = folder_ / "drone.srdf",
                      .request = folder_ / "request.yaml",
                      .environment = {folder_ / "window.json"},
                      .plans = true};
  const Scene scene = read_robot_question(asked);
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(scene, *scene.plan, cache);
  EXPECT_EQ(plan.start, (Configuration{0.25, -1, 0, 0, 0.8, 0, 0, 0.6}));
  EXPECT_EQ(plan.goals.at(0), (Configuration{0.5, 1, 0, 0, 0.8, 0, 0, 0.6}));
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
            PlanVerdict::proven);

  asked.request.clear();
  asked.plans = false;
  asked.start = {"away", "elbow=0.25"};
  EXPECT_EQ(read_robot_question(asked).robots.at(0).state, scene.robots.at(0).state);
}

TEST_F(DroneFile, IsPlannedThroughAWindow) {
  const ScenePlan plan = plan_with(drone_through_window());
  const ConfigurationSpace& space = plan.plan.space;
  ASSERT_EQ(space.size(), 8u);
  EXPECT_FALSE(space.is_body());
  EXPECT_EQ(space.number_name(0), "elbow");
  EXPECT_EQ(space.number_name(1), "base/trans_x");
  EXPECT_EQ(space.number_name(4), "base/rot_w");
  EXPECT_EQ(plan.start[1], -1.0);
  EXPECT_NEAR(plan.start[4], std::sqrt(0.5), 1e-15);
  for (const Planner planner : {Planner::rrt_connect, Planner::lazy_prm_star}) {
    PlanOptions options = plan.options;
    options.planner = planner;
    const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, options);
    ASSERT_EQ(result.verdict, PlanVerdict::proven);
    EXPECT_EQ(result.path.front(), plan.start);
    EXPECT_EQ(result.path.back(), plan.goals.front());
    const PlannedPath written = planned_path(plan, options, result);
    const std::string text = write_planned_path(written);
    const PlannedPath read = parse_planned_path(text, "path.json");
    EXPECT_EQ(read.joints[1], "base/trans_x");
    EXPECT_EQ(read.waypoints, result.path);  // To the bit.
    EXPECT_EQ(write_planned_path(read), text);
    // With the window shut, none of these paths is free.
    PlanScene closed = plan.plan;
    closed.scene.add_body("shutter", make_box({1e-5, 0.5, 0.5}), Motion::fixed());
    const EdgeChecker checker(closed);
    bool is_blocked = false;
    for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
      is_blocked = is_blocked || checker.check(result.path[k], result.path[k + 1]).verdict ==
                                     EdgeVerdict::blocked;
    }
    EXPECT_TRUE(is_blocked);
  }
}

TEST_F(DroneFile, SlidesAlongContacts) {
  const ScenePlan plan = plan_with(drone_through_window(R"(, "contacts": "both", "seed": 2)"));
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
            PlanVerdict::proven);
}

// The pose moves with the base alone: joints that no goal names rest.
TEST_F(DroneFile, PlansThePoseAlone) {
  const ScenePlan plan = plan_with(
      std::string(R"("goal": {"base/trans_x": -0.9, "base/trans_z": 0.5}, )") + kDroneBounds);
  ASSERT_EQ(plan.plan.space.size(), 7u);
  EXPECT_FALSE(plan.plan.space.is_body());
  EXPECT_EQ(plan.goals[0][3], plan.start[3]);
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
            PlanVerdict::proven);
}

TEST_F(DroneFile, MovesInTime) {
  const std::string plan =
      drone_through_window(R"(, "speeds": {"base/linear": 1, "base/angular": 2})");
  const std::string text =
      std::string(R"({"firstcontact": 1, "options": {"duration": 20}, )") +
      std::string(kDroneWindow).substr(0, std::string(kDroneWindow).size() - 1) +
      R"(, {"name": "shutter", "shape": {"box": {"size": [0.1, 0.5, 0.5]}},
        "motion": {"type": "waypoints", "times": [0, 5, 8, 20], "poses": [{"position": [0, 0, 0]},
        {"position": [0, 0, 0]}, {"position": [0.2, 0, 3]}, {"position": [0.2, 0, 3]}]}}],
        "robots": [{"name": "d", "urdf": "drone.urdf", "state": {"base/trans_x": -1}}],
        "plan": {)" +
      plan + "}}";
  const Scene scene = parse_scene(text, folder_ / "scene.json", 1, {});
  ShapeCache cache;
  const ScenePlan made = make_scene_plan(scene, *scene.plan, cache);
  ASSERT_TRUE(made.plan.times.has_value());
  EXPECT_EQ(made.plan.times->speeds, (std::vector<double>{1, 1, 2}));
  const PlanResult result = plan_path(made.plan, made.start, made.goals, made.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
    const double seconds = result.times[k + 1] - result.times[k];
    EXPECT_GE(
        seconds * (1.0 + 1e-9),
        made.plan.space.travel_time(result.path[k], result.path[k + 1], made.plan.times->speeds));
  }
}

TEST_F(DroneFile, RefusesWhatIsNoPose) {
  EXPECT_NE(refusal(R"("goal": {"base": {"position": [1, 0, 0]}})")
                .find("\"base/trans_x\" slides without limits; give it bounds"),
            std::string::npos);
  EXPECT_NE(refusal(drone_through_window(R"(, "joints": ["base/trans_x", "elbow"])"))
                .find("planned as a whole, by its name \"base\""),
            std::string::npos);
  EXPECT_NE(refusal(std::string(R"("goal": {"base/rot_x": 0.5}, )") + kDroneBounds)
                .find("quaternion of length 1"),
            std::string::npos);
  EXPECT_NE(refusal(std::string(R"("goal": {"base": {"position": [1.6, 0, 0]}}, )") + kDroneBounds)
                .find("outside of the box"),
            std::string::npos);
  EXPECT_NE(refusal(R"("goal": {"elbow": 0.1}, "bounds": {"base/trans_x": [0, 1]})")
                .find("which is not planned"),
            std::string::npos);
  EXPECT_NE(refusal(R"("goal": {"base/trans_x": -0.9}, "bounds": {"base/rot_x": [0, 1]})")
                .find("a quaternion has none"),
            std::string::npos);
}

/// The angle of the rotation that takes one quaternion to the other.
double turn_between(const Configuration& a, const Configuration& b, std::size_t first) {
  const Eigen::Quaterniond x(a[first], a[first + 1], a[first + 2], a[first + 3]);
  const Eigen::Quaterniond y(b[first], b[first + 1], b[first + 2], b[first + 3]);
  return x.angularDistance(y);
}

// The path length is a metric; interpolation runs at a constant rate; pieces keep the ends.
TEST_F(DroneFile, HasAMetricAndConstantRates) {
  const ScenePlan plan = plan_with(drone_through_window());
  const ConfigurationSpace& space = plan.plan.space;
  RandomNumbers random(5);
  for (int k = 0; k < 500; ++k) {
    const Configuration a = space.sample(random);
    const Configuration b = space.sample(random);
    const Configuration c = space.sample(random);
    EXPECT_TRUE(space.holds(a));
    EXPECT_FALSE(space.defect(a)) << *space.defect(a);
    EXPECT_LE(space.distance(a, c), space.distance(a, b) + space.distance(b, c) + 1e-12);
    EXPECT_NEAR(space.distance(a, b), space.distance(b, a), 1e-12);
    const double turn = turn_between(a, b, 4);
    EXPECT_NEAR(space.distance(a, b),
                std::hypot(b[0] - a[0], b[1] - a[1], std::hypot(b[2] - a[2], b[3] - a[3], turn)),
                1e-12);
    const double share = random.uniform();
    const Configuration between = space.interpolate(a, b, share);
    EXPECT_NEAR(space.distance(a, between), share * space.distance(a, b), 1e-12);
    EXPECT_NEAR(turn_between(a, between, 4), share * turn, 1e-7);
    EXPECT_EQ(space.interpolate(a, b, 1.0), b);
    EXPECT_EQ(space.interpolate(a, a, share), a);  // To the bit: what rests does not drift.
  }
}

// A piece to a rounded place departs from its edge by no more than the bound.
TEST_F(DroneFile, BoundsTheDepartureOfRoundedPieces) {
  const ScenePlan plan = plan_with(drone_through_window());
  const ConfigurationSpace& space = plan.plan.space;
  RandomNumbers random(6);
  PlanScene scene = plan.plan;
  const std::size_t arm = scene.scene.first_member(scene.robots[0]) + 2;
  for (int k = 0; k < 200; ++k) {
    const Configuration a = space.sample(random);
    const Configuration b = space.sample(random);
    const double bound = space.rounding_bound(a, b);
    EXPECT_LT(bound, 1e-12);
    const double share = random.uniform();
    const Configuration piece = space.interpolate(a, b, share);
    const double at = random.uniform();
    scene.set_motions(scene.scene, a, b);
    const Pose whole = scene.scene.pose(arm, share * at);
    scene.set_motions(scene.scene, a, piece);
    const Pose part = scene.scene.pose(arm, at);
    EXPECT_LT((whole.position - part.position).norm(), bound + 1e-14);
  }
  Configuration a = space.sample(random);
  Configuration opposite = a;
  const Eigen::Quaterniond half_turn =
      Eigen::Quaterniond(a[4], a[5], a[6], a[7]) *
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()));
  opposite[4] = half_turn.w();
  opposite[5] = half_turn.x();
  opposite[6] = half_turn.y();
  opposite[7] = half_turn.z();
  EXPECT_TRUE(std::isinf(space.rounding_bound(a, opposite)));
}

}  // namespace
}  // namespace firstcontact::test
