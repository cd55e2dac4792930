#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/verification/verify_path.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"

namespace firstcontact {
namespace {

/// A path among a post and a table that stand on each other, with a clearance of 0 for each edge.
PlannedPath path_in(const std::string& scene, const std::filesystem::path& source = "s") {
  PlannedPath path;
  path.scene = parse_scene(scene, source);
  ShapeCache cache;
  path.input_digest = load_scene(path.scene, cache).input_digest;
  path.is_proven = true;
  path.goal = 0;
  path.extra_clearance = 1e-9;
  return path;
}

void set_waypoints(PlannedPath& path, std::vector<std::vector<double>> waypoints) {
  path.goals = {waypoints.back()};
  path.clearances.assign(waypoints.size() - 1, 0.0);
  path.clearance = 0.0;
  path.waypoints = std::move(waypoints);
}

/// A ball that goes around a post, which stands on a table.
PlannedPath ball_path() {
  PlannedPath path = path_in(R"({"firstcontact": 1, "bodies": [
    {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [-1, 0, 0]}},
    {"name": "post", "shape": {"box": {"size": [0.2, 0.2, 2]}}},
    {"name": "table", "shape": {"box": {"size": [9, 9, 1]}}, "pose": {"position": [0, 0, -1.5]}}]})");
  path.body = "ball";
  set_waypoints(path, {{-1, 0, 0, 1, 0, 0, 0}, {0, 0.25, 0, 0, 1, 0, 0}, {1, 0, 0, 1, 0, 0, 0}});
  return path;
}

TEST(VerifyPath, ProvesABody) {
  const PathVerification proven = verify_path(ball_path());
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_EQ(proven.edges, 2u);
  EXPECT_EQ(proven.tested, 2u);  // The post on its table is none of them.
  EXPECT_TRUE(proven.reaches_goal);
}

TEST(VerifyPath, RefutesAnEdgeThatTouches) {
  PlannedPath path = ball_path();
  path.waypoints[1][1] = 0.15;
  const PathVerification refuted = verify_path(path);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_EQ(refuted.problem_edge, 0u);
  ASSERT_TRUE(refuted.problem_at);
  EXPECT_GT(refuted.problem_at->from, 0.5);
  EXPECT_LE(refuted.problem_at->from, 1.0);
}

TEST(VerifyPath, RefutesAClearanceThatIsTooLarge) {
  PlannedPath path = ball_path();
  path.clearances = {0.0, 0.021};
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::proven);
  path.clearances = {0.0, 0.022};
  const PathVerification refuted = verify_path(path);
  EXPECT_EQ(refuted.verdict, ProofVerdict::refuted);
  EXPECT_EQ(refuted.problem_edge, 1u);
}

TEST(VerifyPath, TellsAnApproximatePath) {
  PlannedPath path = ball_path();
  path.is_proven = false;
  path.goal.reset();
  const PathVerification proven = verify_path(path);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven);
  EXPECT_FALSE(proven.reaches_goal);
}

// An approximate path tells how far from a goal it ends: that is measured again.
TEST(VerifyPath, MeasuresTheDistanceToTheGoal) {
  PlannedPath path = ball_path();
  path.is_proven = false;
  path.goal.reset();
  path.goals = {{5, 0, 0, 1, 0, 0, 0}, {1, 2, 0, 0.6, 0.8, 0, 0}};
  const double turn = 2.0 * std::acos(0.6);
  path.distance_to_goal = 2.0 + 0.1 * turn;  // The ball has a radius of 0.1 m.
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::proven) << verify_path(path).problem;
  path.distance_to_goal = 1e-9;
  const PathVerification found = verify_path(path);
  EXPECT_EQ(found.verdict, ProofVerdict::broken);
  EXPECT_EQ(found.problem.find("The distance_to_goal of the path is 1e-09; it ends 2.18"), 0u)
      << found.problem;
  path = ball_path();
  path.distance_to_goal = 0.5;
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::broken);
}

// Each of these stood under "proven" although nothing had proven it.
TEST(VerifyPath, NamesWhatNoEdgeShows) {
  const auto problem_of = [](const auto& change) {
    PlannedPath path = ball_path();
    change(path);
    const PathVerification found = verify_path(path);
    EXPECT_EQ(found.verdict, ProofVerdict::broken);
    return found.problem;
  };
  EXPECT_EQ(problem_of([](PlannedPath& path) { path.margin = 0.05; }),
            "The margin of the path is not that of its scene.");
  EXPECT_EQ(problem_of([](PlannedPath& path) { path.clearance = 1.0; }),
            "The clearance of the path is not the least of its edges.");
  EXPECT_EQ(
      problem_of([](PlannedPath& path) { path.scene.bodies[1].motion = ConstantVelocityMotion{}; }),
      "The body \"post\" moves by itself.");
  EXPECT_EQ(problem_of([](PlannedPath& path) {
              path.waypoints[1] = {0.0, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0};
            }),
            "A waypoint has a quaternion that is not of length 1.");
  EXPECT_EQ(problem_of([](PlannedPath& path) { path.waypoints[0][2] = 1e-12; }),
            "The path does not begin where its scene has body \"ball\".");
}

TEST(VerifyPath, NamesWhatContradictsItself) {
  PlannedPath path = ball_path();
  path.goals[0][0] = 1.5;
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::broken);
  path = ball_path();
  path.clearances.pop_back();
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::broken);
  path = ball_path();
  path.clearances[1].reset();
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::broken);
  path = ball_path();
  path.body = "bull";
  EXPECT_EQ(verify_path(path).problem, "The scene has no body \"bull\".");
}

TEST(VerifyPath, ProvesAPlace) {
  PlannedPath path = ball_path();
  set_waypoints(path, {{-1, 0, 0, 1, 0, 0, 0}});
  path.clearance = 0.7;
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::proven);
  path.clearance = 0.81;
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::refuted);
  set_waypoints(path, {{-0.15, 0, 0, 1, 0, 0, 0}});
  path.scene.bodies[0].motion = FixedMotion{{{-0.15, 0, 0}, Eigen::Quaterniond::Identity()}};
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::refuted);
}

TEST(VerifyPath, ProvesARobotAndWhatItCarries) {
  const test::ArmFolder folder;
  PlannedPath path = path_in(R"({"firstcontact": 1, "bodies": [
    {"name": "post", "shape": {"box": {"size": [0.1, 0.1, 2]}}, "pose": {"position": [0, 1.4, 0]}},
    {"name": "ball", "shape": {"sphere": {"radius": 0.2}}}],
    "robots": [{"name": "arm", "urdf": "arm.urdf", "srdf": "arm.srdf",
      "attached": [{"body": "ball", "link": "tip", "touch_links": ["bar"],
                    "pose": {"position": [0.15, 0, 0]}}]}]})",
                             folder.path() / "scene.json");
  path.robots = {"arm"};
  path.joints = {"elbow"};
  path.turnings = {Turning::as_given};
  set_waypoints(path, {{0.0}, {0.9}, {1.5}});
  const PathVerification hit = verify_path(path);
  EXPECT_EQ(hit.verdict, ProofVerdict::refuted);
  EXPECT_EQ(hit.problem_edge, 1u);
  EXPECT_EQ(hit.problem_at.value().pair[1], "ball");
  set_waypoints(path, {{0.0}, {0.9}, {1.2}});
  const PathVerification proven = verify_path(path);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_EQ(proven.edges, 2u);
  path.turnings = {Turning::shortest};
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::broken);
  path.turnings = {Turning::as_given};
  set_waypoints(path, {{0.1}, {0.9}});
  EXPECT_EQ(verify_path(path).problem,
            "The path does not begin where its scene has joint \"elbow\".");
  set_waypoints(path, {{0.0}, {-2.0}});
  EXPECT_EQ(verify_path(path).problem,
            "A waypoint has joint \"elbow\" at -2, outside of its limits.");
}

/// A ball that passes a door while it is open, from 1.3 to 4.7 s, and then rests.
PlannedPath path_through_a_door() {
  PlannedPath path = path_in(R"({"firstcontact": 1, "bodies": [
    {"name": "ball", "shape": {"sphere": {"radius": 0.2}}},
    {"name": "door", "shape": {"box": {"size": [0.02, 3, 3]}},
     "motion": {"type": "waypoints", "times": [0, 3, 6, 8],
       "poses": [{"position": [1, 0, 0]}, {"position": [1, 4, 0]}, {"position": [1, 0, 0]}, {"position": [1, 0, 0]}]}}]})");
  path.body = "ball";
  set_waypoints(
      path,
      {{0, 0, 0, 1, 0, 0, 0}, {0, 0, 0, 1, 0, 0, 0}, {2, 0, 0, 1, 0, 0, 0}, {2, 0, 0, 1, 0, 0, 0}});
  path.times = {0.0, 1.5, 4.0, 8.0};
  return path;
}

TEST(VerifyPath, ProvesAPathInTime) {
  PlannedPath path = path_through_a_door();
  const PathVerification proven = verify_path(path);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  EXPECT_EQ(proven.edges, 3u);
  EXPECT_EQ(proven.tested, 1u);
  // Too early, too late, and at rest in the way of the door that comes back.
  path.times = {0.0, 0.1, 1.0, 8.0};
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::refuted);
  EXPECT_EQ(verify_path(path).problem_edge, 1u);
  path.times = {0.0, 4.5, 6.5, 8.0};
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::refuted);
  path = path_through_a_door();
  path.waypoints[2][0] = path.waypoints[3][0] = path.goals[0][0] = 1.1;
  EXPECT_EQ(verify_path(path).problem_edge, 2u);
  path = path_through_a_door();
  path.times = {0.0, 1.5, 4.0, 7.0};
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::broken);
  path.times.clear();
  EXPECT_EQ(verify_path(path).problem, "The body \"door\" moves by itself.");
}

// Times with one quotient by the duration left an edge of no length, along which nothing was
// tested.
TEST(VerifyPath, RefusesTimesThatDoublesDoNotTellApart) {
  PlannedPath path = path_through_a_door();
  set_waypoints(path, {{0, 0, 0, 1, 0, 0, 0}, {2, 0, 0, 1, 0, 0, 0}, {2, 0, 0, 1, 0, 0, 0}});
  path.times = {0.0, 5e-324, 8.0};
  EXPECT_EQ(verify_path(path).problem,
            "The times of the path are so close that doubles do not tell them apart.");
}

// A body that rests beside a robot counted as one whose pairs are not tested.
TEST(VerifyPath, RefutesAPlaceInAnotherBodyBesideARobot) {
  const test::ArmFolder folder;
  PlannedPath path = path_in(R"({"firstcontact": 1, "bodies": [
    {"name": "post", "shape": {"box": {"size": [0.1, 0.1, 2]}}, "pose": {"position": [0, 1.4, 0]}},
    {"name": "ball", "shape": {"sphere": {"radius": 0.2}}, "pose": {"position": [0, 1.4, 0]}}],
    "robots": [{"name": "arm", "urdf": "arm.urdf", "srdf": "arm.srdf"}]})",
                             folder.path() / "scene.json");
  path.body = "ball";
  set_waypoints(path, {{0, 1.4, 0, 1, 0, 0, 0}});
  path.clearance = 0.0;
  EXPECT_EQ(verify_path(path).verdict, ProofVerdict::refuted);
}

TEST(VerifyPath, RefusesAFileThatHasChanged) {
  PlannedPath path = ball_path();
  path.input_digest.back() = path.input_digest.back() == '0' ? '1' : '0';
  EXPECT_NE(test::message_of<std::invalid_argument>([&] {
              (void)verify_path(path);
            }).find("is not what it was"),
            std::string::npos);
}

}  // namespace
}  // namespace firstcontact
