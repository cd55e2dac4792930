// Robots of a scene, written and read back.

#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>

#include "scene/robot_text.h"
#include "scene/scene_bits.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

using test::SceneBits;

/// base -turn (continuous)- disc, base -lift (prismatic)- hook, base -rail (planar)- cart -nut
/// (screw)- bolt -eye (ball)- head, base -weld- plate.
const std::string kEveryJoint = R"(<robot name="every">
  <link name="base"/><link name="disc"/><link name="hook"/><link name="cart"/><link name="plate"/>
  <link name="tip"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="disc"/><axis xyz="0 0 1"/></joint>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="hook"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" velocity="9" effort="1"/></joint>
  <joint name="rail" type="planar"><parent link="base"/><child link="cart"/><axis xyz="0 0 1"/></joint>
  <joint name="float" type="floating"><parent link="cart"/><child link="tip"/></joint>
  <joint name="weld" type="fixed"><parent link="base"/><child link="plate"/></joint>
</robot>)";

class WriteRobots : public testing::Test {
 protected:
  WriteRobots() {
    folder_.write("every.urdf", kEveryJoint);
    folder_.write("every.srdf", R"(<robot name="every">
      <disable_collisions link1="base" link2="tip"/></robot>)");
  }

  /// A scene with one robot; `keys` are more of it.
  [[nodiscard]] Scene parse(const std::string& keys, const std::string& more = "") const {
    return parse_scene(R"({"firstcontact": 1, "bodies": [)" + test::body("a") + "," +
                           test::body("b") + R"(], "robots": [{"name": "r", "urdf": "every.urdf")" +
                           keys + "}]" + more + "}",
                       folder_.path() / "s.json");
  }

  /// The law: a scene that is written reads back as itself, in any folder.
  static void expect_kept(const Scene& scene) {
    const std::string text = write_scene(scene);
    const Scene again = parse_scene(text, "/nowhere/else.json");
    EXPECT_EQ(SceneBits(again), SceneBits(scene)) << text;
    EXPECT_EQ(write_scene(again), text);
  }

  test::ArmFolder folder_;
};

const std::vector<std::string> kKeys = {
    "",
    R"(, "srdf": "every.srdf")",
    R"(, "package_roots": ["."])",
    R"(, "surface": "visual")",
    R"(, "base": {"position": [1, 2, 3], "quaternion_wxyz": [1, 2, 3, 4]})",
    R"(, "base_motion": {"type": "constant_velocity", "translation": [0, 0, 3]})",
    R"(, "base_motion": {"type": "screw", "to": {"position": [1, 0, 0]}})",
    R"(, "state": {"turn": 0.1, "rail/x": 2, "rail/theta": -0.5})",
    R"(, "attached": [{"body": "a", "link": "tip"}])",
    R"(, "attached": [{"body": "b", "link": "hook", "from_time": 0.25, "to_time": 0.5,
                       "touch_links": ["base", "tip"]}])",
    R"(, "attached": [{"body": "b", "link": "hook", "pose": {"position": [1, 0, 0]}}])",
    R"(, "padding": 0.01)",
    R"(, "padding": {"hook": 0.01, "tip": 0.02})",
    R"(, "tracking_error": 0.01)",
    R"(, "tracking_error": {"turn": 0.01, "rail": 0.02, "float": 0.03})",
    R"(, "dynamics": {})",
    R"(, "dynamics": {"density": 10, "friction": 0.5, "velocities": {"lift": 2}})",
};

TEST_F(WriteRobots, KeepsEveryKey) {
  std::set<std::string> texts;
  for (const std::string& key : kKeys) {
    SCOPED_TRACE(key);
    const Scene scene = parse(key);
    expect_kept(scene);
    EXPECT_TRUE(texts.insert(write_scene(scene)).second);
  }
}

// Else a comparison that saw nothing would pass.
TEST_F(WriteRobots, ComparesEveryKey) {
  const SceneBits plain(parse(""));
  for (const std::string& key : kKeys) {
    EXPECT_EQ(SceneBits(parse(key)) == plain, key.empty()) << key;
  }
}

TEST_F(WriteRobots, KeepsTrajectoriesOfEveryKind) {
  const std::string names =
      R"(, "trajectory": {"joint_names": ["turn", "rail/theta"], "points": [)";
  const std::string positions = R"({"time": 0.5, "positions": [0.1, 1e-9]},
      {"time": 1.25, "positions": [7, -3.5]}]})";
  expect_kept(parse(names + positions));
  expect_kept(parse(names + positions + R"(, "turning": "short")"));
  expect_kept(parse(names + R"({"time": 0, "positions": [0, 1], "velocities": [0, 2]},
      {"time": 2, "positions": [1, 0], "velocities": [0.3, -0.1]}]})"));
  expect_kept(parse(names + R"({"time": 0, "positions": [0, 1], "velocities": [0, 2],
       "accelerations": [5, 6]}, {"time": 2, "positions": [1, 0], "velocities": [0.3, -0.1],
       "accelerations": [0, -7]}]})"));
}

// A file of a trajectory is written out; turns that were taken out stay out.
TEST_F(WriteRobots, WriteOutTheirTrajectoryFile) {
  folder_.write("turn.csv", "time,turn\n0,3\n1,-3\n");
  const Scene wrapped = parse(R"(, "trajectory": "turn.csv")");
  const Scene unwrapped = parse(R"(, "trajectory": "turn.csv", "unwrap": true)");
  expect_kept(wrapped);
  expect_kept(unwrapped);
  EXPECT_EQ(wrapped.robots[0].trajectory.points[1].positions[0], -3.0);
  EXPECT_GT(unwrapped.robots[0].trajectory.points[1].positions[0], 3.0);
}

TEST_F(WriteRobots, KeepsNumbersToTheLastBit) {
  std::mt19937_64 rng(11);
  const auto any = [&] { return std::ldexp(static_cast<double>(rng() >> 11), -53); };
  for (int round = 0; round < 200; ++round) {
    Scene scene = parse(kKeys[4] + R"(, "state": {"turn": 0}, "padding": 0, "tracking_error": 0,
        "trajectory": {"joint_names": ["lift"], "points": [{"time": 0, "positions": [0]}]})");
    SceneRobot& robot = scene.robots[0];
    auto& base = std::get<FixedMotion>(robot.base).pose;
    base = {{any(), -any(), any()}, Eigen::Quaterniond(any(), any(), any(), 1.0)};
    robot.state["turn"] = any();
    for (auto& [link, padding] : robot.padding) {
      padding = any();
    }
    for (auto& [joint, error] : robot.tracking_error) {
      error = joint_error(robot.model.joints()[joint], any());
    }
    robot.trajectory.points = {{.time = 0.25 * any(), .positions = {any()}},
                               {.time = 0.5 + 0.25 * any(), .positions = {-any()}}};
    scene.duration = robot.trajectory.points.back().time;
    expect_kept(scene);
  }
}

// Rules by groups of links keep their meaning, and one of a link that of its robot.
TEST_F(WriteRobots, KeepsRulesForPairs) {
  const Scene scene = parse("", R"(, "pairs": {
      "groups": {"g": ["r/tip", "a"], "whole": ["r"], "none": []},
      "ignore": [["a", "r/hook"], ["g", "g"], ["whole", "b"], ["none", "g"]],
      "margin": [["r", "b", 0.5], ["b", "r/tip", 0.25], ["whole", "g", 0.125], ["g", "a", 0.0625]]},
      "options": {"lenient": true})");
  EXPECT_EQ(scene.ignored_pairs.size(), 7u);  // One, and b with each of six links.
  EXPECT_EQ(scene.ignored_groups, (std::vector<GroupPair>{{0, 0}, {2, 0}}));
  expect_kept(scene);
}

}  // namespace
}  // namespace firstcontact
