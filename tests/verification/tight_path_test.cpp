// Paths of a micrometre and less: written, read back and proven, forwards and backwards.

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/scene/planned_path.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/verification/verify_path.h>

namespace firstcontact {
namespace {

// A slot of 0.1 m and 2e-7 m for a cube of 0.1 m.
constexpr const char* kSlot = R"({"firstcontact": 1, "options": {"tolerance": 1e-9}, "bodies": [
  {"name": "left", "shape": {"box": {"size": [0.5, 0.5, 2]}}, "pose": {"position": [0, -0.3000001, 0]}},
  {"name": "right", "shape": {"box": {"size": [0.5, 0.5, 2]}}, "pose": {"position": [0, 0.3000001, 0]}},
  {"name": "cube", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-1, 0, 0]}}],
  "plan": {"body": "cube", "goal": {"position": [1, 0, 0]}, "time": 100}})";

TEST(TightPath, OfATenthOfAMicrometreIsProvenAsItIsRead) {
  const Scene asked = parse_scene(kSlot, "slot.json", 1, {});
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  const PlannedPath path = planned_path(plan, plan.options, result);
  ASSERT_TRUE(path.clearance);
  EXPECT_LE(*path.clearance, 1.001e-7);
  EXPECT_GE(*path.clearance, 0.9e-7);
  const PlannedPath read = parse_planned_path(write_planned_path(path), "slot.path.json");
  EXPECT_EQ(read.waypoints, path.waypoints);
  EXPECT_EQ(read.clearances, path.clearances);
  const PathVerification proven = verify_path(read);
  EXPECT_EQ(proven.verdict, ProofVerdict::proven) << proven.problem;
  // Tight: a micrometre is more than there is.
  PlannedPath wide = read;
  wide.clearances.assign(wide.clearances.size(), 1e-6);
  wide.clearance = 1e-6;
  EXPECT_EQ(verify_path(wide).verdict, ProofVerdict::refuted);
}

using Waypoints = std::vector<std::vector<double>>;

/// A path of a peg through a hole that is 1e-6 m wider on each side, with a clearance of 0.9 um.
PlannedPath peg_path(const Waypoints& waypoints) {
  const std::vector<double>& at = waypoints.front();
  const auto number = [&](std::size_t k) { return detail::write_json(at[k]); };
  const std::string pose = R"({"position": [)" + number(0) + ", " + number(1) + ", " + number(2) +
                           R"(], "quaternion_wxyz": [)" + number(3) + ", " + number(4) + ", " +
                           number(5) + ", " + number(6) + "]}";
  PlannedPath path;
  path.scene = parse_scene(R"({"firstcontact": 1, "bodies": [
    {"name": "left", "shape": {"box": {"size": [0.25, 1, 2]}}, "pose": {"position": [0, -0.550001, 0]}},
    {"name": "right", "shape": {"box": {"size": [0.25, 1, 2]}}, "pose": {"position": [0, 0.550001, 0]}},
    {"name": "below", "shape": {"box": {"size": [0.25, 0.2, 1]}}, "pose": {"position": [0, 0, -0.550001]}},
    {"name": "above", "shape": {"box": {"size": [0.25, 0.2, 1]}}, "pose": {"position": [0, 0, 0.550001]}},
    {"name": "peg", "shape": {"box": {"size": [0.3, 0.1, 0.1]}}, "pose": )" +
                               pose + "}]}",
                           "peg.json");
  ShapeCache cache;
  path.input_digest = load_scene(path.scene, cache).input_digest;
  path.body = "peg";
  path.is_proven = true;
  path.goal = 0;
  path.goals = {waypoints.back()};
  path.extra_clearance = 1e-9;
  path.clearances.assign(waypoints.size() - 1, 9e-7);
  path.clearance = 9e-7;
  path.waypoints = waypoints;
  return path;
}

TEST(TightPath, ThroughAHoleIsProvenBackwards) {
  Waypoints way = {{-0.5, 0.1, 0.1, 0.8, 0.0, 0.6, 0.0},
                   {-0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0},
                   {0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0},
                   {0.5, 0.1, -0.1, 0.8, 0.0, 0.0, -0.6}};
  for (const bool is_back : {false, true}) {
    const PlannedPath path = peg_path(way);
    const PathVerification proven = verify_path(path);
    EXPECT_EQ(proven.verdict, ProofVerdict::proven) << is_back << ": " << proven.problem;
    EXPECT_EQ(proven.edges, 3u);
    EXPECT_TRUE(proven.reaches_goal);
    // Tight: by a micrometre and a tenth beside the middle it touches.
    PlannedPath beside = path;
    beside.waypoints[1][1] = beside.waypoints[2][1] = 1.1e-6;
    EXPECT_EQ(verify_path(beside).verdict, ProofVerdict::refuted) << is_back;
    std::ranges::reverse(way);
  }
}

}  // namespace
}  // namespace firstcontact
