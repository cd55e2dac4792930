// Robots in a user's hand whose joints follow grips: links where the robot has them, proven runs.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <unistd.h>

#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics/detail/tool_links.h>
#include <firstcontact/haptics_files/haptic_log.h>
#include <firstcontact/haptics_files/haptic_run.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/record/read_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/verification/verify_run.h>

#include "scene/load_text.h"
#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// A palm on a flange, a finger of two links with a tip, whose second joint follows the first, and
/// a thumb that slides.
constexpr const char* kHand = R"(<robot name="hand">
  <link name="flange"/>
  <link name="palm"><collision><geometry><box size="0.1 0.03 0.02"/></geometry></collision></link>
  <link name="badge"><collision><geometry><box size="0.01 0.01 0.01"/></geometry></collision></link>
  <link name="near"><collision><origin xyz="0 0 -0.02"/><geometry><box size="0.01 0.02 0.03"/></geometry></collision></link>
  <link name="knuckle"/>
  <link name="far"><collision><origin xyz="0 0 -0.02"/><geometry><box size="0.01 0.02 0.03"/></geometry></collision></link>
  <link name="tip"><collision><geometry><sphere radius="0.006"/></geometry></collision></link>
  <link name="thumb"><collision><origin xyz="0 0 -0.03"/><geometry><box size="0.01 0.02 0.05"/></geometry></collision></link>
  <joint name="mount" type="fixed"><parent link="flange"/><child link="palm"/><origin xyz="0 0 -0.01" rpy="0 0 0.3"/></joint>
  <joint name="pin" type="fixed"><parent link="palm"/><child link="badge"/><origin xyz="0 0.03 0"/></joint>
  <joint name="bend" type="revolute"><parent link="palm"/><child link="near"/><origin xyz="0.04 0 -0.012"/>
    <axis xyz="0 2 0"/><limit lower="-0.3" upper="1" velocity="1" effort="1"/></joint>
  <joint name="weld" type="fixed"><parent link="near"/><child link="knuckle"/><origin xyz="0 0 -0.04"/></joint>
  <joint name="follow" type="revolute"><parent link="knuckle"/><child link="far"/>
    <axis xyz="0 -1 0"/><limit lower="-2" upper="0.6" velocity="1" effort="1"/><mimic joint="bend" multiplier="-0.5" offset="0.1"/></joint>
  <joint name="end" type="fixed"><parent link="far"/><child link="tip"/><origin xyz="0 0 -0.045"/></joint>
  <joint name="slide" type="prismatic"><parent link="palm"/><child link="thumb"/><origin xyz="-0.04 0 -0.01" rpy="0.1 0 0"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.05" velocity="1" effort="1"/></joint>
  <joint name="twist" type="planar"><parent link="palm"/><child link="plane"/></joint>
  <link name="plane"/>
</robot>)";

class MovingLinks : public testing::Test {
 protected:
  MovingLinks()
      : folder_(std::filesystem::temp_directory_path() / ("hand." + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "hand.urdf") << kHand;
  }
  ~MovingLinks() override { std::filesystem::remove_all(folder_); }

  /// A cube and the hand above it.
  [[nodiscard]] Scene parse(const std::string& state, const std::string& grips,
                            const std::string& more = "") const {
    return parse_scene(R"({"firstcontact": 1, "bodies": [
        {"name": "cube", "shape": {"box": {"size": [0.03, 0.03, 0.03]}}}],
        "robots": [{"name": "hand", "urdf": "hand.urdf", "base": {"position": [0, 0, 0.08]},
                    "state": {)" +
                           state + R"(}}], "haptics": {"tools": [{"robot": "hand")" + grips +
                           R"(}], "friction": 0.4, "contact_distance": 1e-5})" + more + "}",
                       folder_ / "scene.json");
  }

  [[nodiscard]] std::string refusal(const std::string& state, const std::string& grips) const {
    return test::message_of<std::exception>([&] {
      Scene scene = parse(state, grips);
      ShapeCache cache;
      prepare_haptics(scene, cache, 1.0);
    });
  }

  std::filesystem::path folder_;
  const std::string grips_ =
      R"(, "grips": [{"joints": {"bend": [0, 0.8]}}, {"joints": {"slide": [0, 0.045]}}])";
};

TEST_F(MovingLinks, AreWhereTheRobotHasThem) {
  Scene scene = parse(R"("bend": 0.2, "slide": 0.01)", grips_);
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  const LoadedScene loaded = load_scene(std::move(scene), cache);
  const HapticSetup setup = haptic_setup(loaded);
  const HapticTool& tool = setup.scene.tools[0];
  ASSERT_EQ(tool.joints.size(), 2U);
  EXPECT_EQ(tool.joints[0].name, "bend");
  EXPECT_EQ(tool.joints[0].start, 0.2);
  EXPECT_EQ(tool.joints[0].stiffness, 1.0);
  EXPECT_EQ(tool.joints[1].stiffness, 1000.0);
  // The joint that follows has -0.5 q + 0.1 in [-2, 0.6]: q is at least -1, no new limit.
  EXPECT_EQ(tool.joints[0].lower, -0.3);
  EXPECT_EQ(tool.joints[0].upper, 1.0);
  const detail::ToolLinks links(setup.scene.tools);
  test::Random random(4);
  for (int k = 0; k < 50; ++k) {
    const std::array joints{random.uniform(-0.3, 1.0), random.uniform(0.0, 0.05)};
    const Scene posed = parse(
        "\"bend\": " + std::to_string(joints[0]) + ", \"slide\": " + std::to_string(joints[1]), "");
    const LoadedScene robot = load_scene(posed, cache);
    std::array<Pose, kMostHapticLinks> poses;
    std::array<HapticAxis, kMostHapticLinks> axes;
    links.place(std::array{tool.X_WB}, joints, poses, axes);
    std::size_t compared = 0;
    for (std::size_t link = 0; link < tool.links.size(); ++link) {
      const auto member = robot.robots->find_member(tool.links[link].name);
      if (tool.links[link].shape) {
        ASSERT_TRUE(member) << tool.links[link].name;
        const Pose X_WL = robot.robots->pose(*member, 0.0);
        EXPECT_LT((X_WL.position - poses[link].position).norm(), 1e-6) << tool.links[link].name;
        EXPECT_LT(X_WL.rotation.angularDistance(poses[link].rotation), 1e-5);
        ++compared;
      }
    }
    EXPECT_EQ(compared, 5U);  // Badge, near, far, tip and thumb.
  }
}

/// Requires that the device of a step has the links where it leads them.
void expect_links(const HapticSetup& setup, const ForceTick& tick, const RunStep& step) {
  const detail::ToolLinks links(setup.scene.tools);
  std::array<Pose, kMostHapticLinks> poses;
  std::array<HapticAxis, kMostHapticLinks> axes;
  links.place(std::array{tick.tools[0].target}, std::span(tick.joint_targets).first(tick.joints),
              poses, axes);
  std::size_t found = 0;
  for (std::size_t link = 0; link < setup.scene.tools[0].links.size(); ++link) {
    if (setup.scene.tools[0].links[link].shape) {
      ASSERT_LT(found, step.devices[0].links.size());
      const RunDeviceLink& of_device = step.devices[0].links[found];
      EXPECT_EQ(of_device.X_WB.position, poses[link].position);
      EXPECT_EQ(of_device.body, setup.bodies[setup.bodies.size() - 5 + found]);
      ++found;
    }
  }
  EXPECT_EQ(found, 5U);  // Badge, near, far, tip and thumb.
  EXPECT_EQ(step.devices[0].links.size(), found);
}

/// A session of a hand that knows nothing of the scene, as a run.
std::string run_of(const LoadedScene& loaded, const HapticSetup& setup) {
  RandomPathOptions path;
  path.radius = 0.04;
  path.fastest = 0.4;
  SimulatedOperatorOptions options;
  options.fingers = {.grips = 2, .period = 0.4, .closed = 1.2};
  options.path = random_via_points(path);
  SimulatedOperator hand(options);
  HapticSession session(setup.scene, setup.options);
  HapticRun run(loaded, setup, session.contacts().contact_distance());
  std::string text = write_run_header(run.header());
  std::size_t contacts = 0;
  for (int k = 0; k < 6000; ++k) {
    const std::int64_t now = session.time_ns();
    const ForceTick& tick = session.step(std::array{hand.read(now)});
    hand.command(tick.tools[0].command, now);
    if (session.cycle() != nullptr) {
      contacts += session.cycle()->contacts > 0 ? 1 : 0;
      const RunStep step = run.step(*session.cycle(), run.devices(tick));
      expect_links(setup, tick, step);
      text += write_run_step(step);
    }
  }
  EXPECT_GT(contacts, 300U);
  return text;
}

RunVerification verified(const std::string& text) {
  std::istringstream stream(text);
  RunReader reader(stream, "run.jsonl");
  return verify_run(reader.header(), [&] { return reader.next(); });
}

TEST_F(MovingLinks, AreProvenAsTheyAreWritten) {
  Scene scene = parse("\"bend\": 0.1", grips_);
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.5);
  const LoadedScene loaded = load_scene(std::move(scene), cache);
  const HapticSetup setup = haptic_setup(loaded);
  const std::string text = run_of(loaded, setup);
  const RunVerification proof = verified(text);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_GT(proof.least_distance, 0.0);
  EXPECT_EQ(text, run_of(loaded, setup));  // The same on every run.

  // A finger that jumps by a millimetre in one step.
  std::istringstream stream(text);
  RunReader reader(stream, "run.jsonl");
  std::size_t count = 0;
  const RunVerification forged = verify_run(reader.header(), [&] {
    auto step = reader.next();
    if (step && ++count == 700) {
      step->bodies.back().pieces.front().X_WB.position.x() += 1e-3;
    }
    return step;
  });
  EXPECT_NE(forged.verdict, ProofVerdict::proven);
}

TEST_F(MovingLinks, IgnoreWhatTheRobotIgnores) {
  Scene scene =
      parse("\"bend\": 0.1", grips_,
            R"(, "pairs": {"ignore": [["hand/tip", "hand/thumb"], ["hand/far", "cube"]]})");
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  const auto body = [&](const std::string& name) {
    const auto found = std::ranges::find(scene.bodies, name, &Body::name);
    return static_cast<std::size_t>(found - scene.bodies.begin());
  };
  const auto is_ignored = [&](const std::string& a, const std::string& b) {
    const BodyPair pair{std::min(body(a), body(b)), std::max(body(a), body(b))};
    return std::ranges::find(scene.ignored_pairs, pair) != scene.ignored_pairs.end();
  };
  EXPECT_TRUE(is_ignored("hand", "hand/badge"));      // Fixed to each other.
  EXPECT_TRUE(is_ignored("hand", "hand/near"));       // One joint.
  EXPECT_TRUE(is_ignored("hand/far", "hand/tip"));    // Fixed.
  EXPECT_TRUE(is_ignored("hand/tip", "hand/thumb"));  // The scene.
  EXPECT_TRUE(is_ignored("hand/far", "cube"));        // The scene.
  EXPECT_FALSE(is_ignored("hand", "hand/far"));
  EXPECT_FALSE(is_ignored("hand/far", "hand/thumb"));
  EXPECT_FALSE(is_ignored("hand/near", "cube"));
  EXPECT_FALSE(is_ignored("hand/badge", "hand/thumb"));
}

TEST_F(MovingLinks, LogsHaveAColumnForEachGripAndJoint) {
  Scene scene = parse("", grips_);
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  const HapticSetup setup = haptic_setup(load_scene(std::move(scene), cache));
  const GripColumns columns = grip_columns(setup.scene, setup.options);
  EXPECT_EQ(columns.grips, 2U);
  EXPECT_EQ(columns.joints, 2U);
  HapticCycle cycle;
  cycle.joints = {0.1, 0.2};
  const auto commas = [](const std::string& line) {
    return std::ranges::count(line.substr(0, line.find('\n')), ',');
  };
  EXPECT_EQ(commas(haptic_tick_header(columns)), commas(haptic_tick_lines({}, 1, columns)));
  EXPECT_EQ(commas(haptic_cycle_header(columns)), commas(haptic_cycle_line(cycle, 0)));
}

TEST_F(MovingLinks, RefuseGripsThatMakeNoSense) {
  const auto says = [&](const std::string& state, const std::string& grips,
                        const std::string& expected) {
    const std::string said = refusal(state, R"(, "grips": )" + grips);
    EXPECT_NE(said.find(expected), std::string::npos) << said;
  };
  says("", "[]", "expected 1 to 16 grips, got 0; leave the key out");
  says("", R"([{}])", "joints");
  says("", R"([{"joints": {"bent": [0, 1]}}])",
       "robot \"hand\" has no joint \"bent\"; expected one of \"bend\", \"slide\"");
  says("", R"([{"joints": {"bend": [0, 1.1]}}])",
       "haptics.tools[0].grips[0].joints.bend[1]: expected a position of joint \"bend\" within its "
       "limits, -0.3 to 1, got 1.1");
  says("", R"([{"joints": {"bend": [0]}}])", "expected two positions, open and closed, got 1");
  says("", R"([{"joints": {"bend": [0.5, 0.5]}}])", "expected two positions that differ");
  says("", R"([{"joints": {"follow": [0, 1]}}])",
       "joint \"follow\" follows \"bend\" by itself; name that one instead");
  says("", R"([{"joints": {"weld": [0, 1]}}])", "joint \"weld\" is fixed");
  says("", R"([{"joints": {"twist": [0, 1]}}])", "joint \"twist\" is planar");
  says("", R"([{"joints": {"bend": [0, 1]}}, {"joints": {"bend": [0, 1]}}])",
       "joint \"bend\" stands twice");
  says("", R"([{"joints": {"bend": [0, 1]}, "seconds": 1}])", "with a \"button\" alone");
  says("\"bend\": 1.2", R"([{"joints": {"bend": [0, 1]}}])",
       "joint \"bend\" starts at 1.2, out of its limits -0.3 to 1; give its \"state\" another "
       "position");
}

// It would stop the grip before its end.
TEST_F(MovingLinks, RefuseAGripThatLeadsAJointThatMimicsBeyondItsLimits) {
  std::string narrow = kHand;
  const std::string limits = "lower=\"-2\" upper=\"0.6\"";
  narrow.replace(narrow.find(limits), limits.size(), "lower=\"-0.2\" upper=\"0.6\"");
  std::ofstream(folder_ / "hand.urdf") << narrow;
  EXPECT_NE(refusal("", R"(, "grips": [{"joints": {"bend": [0, 0.8]}}])")
                .find("joints.bend[1]: expected a position of joint \"bend\" that leads \"follow\" "
                      "within its limits, -0.2 to 0.6, got -0.3"),
            std::string::npos);
  EXPECT_NO_THROW((void)parse("", R"(, "grips": [{"joints": {"bend": [0, 0.5]}}])"));
}

}  // namespace
}  // namespace firstcontact
