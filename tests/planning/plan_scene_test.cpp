// Plans that scenes ask for, and path files: what is written is read back, and is still proven.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/planning/plan_scene.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_planned_path.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_planned_path.h>
#include <firstcontact/text/parse_error.h>

#include "support/data_dir.h"

namespace firstcontact::test {
namespace {

constexpr const char* kPegOverWall = R"({
  "firstcontact": 1,
  "bodies": [
    {"name": "wall", "shape": {"box": {"size": [0.00001, 1, 1]}}, "pose": {"position": [0, 0, 0]}},
    {"name": "peg", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-0.5, 0, 0]}}
  ],
  "plan": {"body": "peg", "goal": {"position": [0.5, 0.1, 0.25]}, "margin": 0.01, "seed": 3,
           "time": 20}
})";

Scene scene_of(const std::string& text) { return parse_scene(text, "scene.json", 1, {}); }

std::string refusal_of(const std::string& text) {
  try {
    const Scene scene = scene_of(text);
    ShapeCache cache;
    (void)make_scene_plan(scene, *scene.plan, cache);
  } catch (const ParseError& error) {
    return error.what();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string refusal(const std::string& plan) {
  const std::string text = kPegOverWall;
  return refusal_of(text.substr(0, text.find("\"plan\"")) + "\"plan\": " + plan + "}");
}

TEST(ScenePlan, PlansABodyAndWritesItsPath) {
  const Scene scene = scene_of(kPegOverWall);
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(scene, *scene.plan, cache);
  EXPECT_EQ(plan.options.seed, 3u);
  EXPECT_EQ(plan.options.time, 20.0);
  EXPECT_EQ(plan.loaded.scene.options.margin, 0.01);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);

  const PlannedPath written = planned_path(plan, plan.options, result);
  const std::string text = write_planned_path(written);
  const PlannedPath read = parse_planned_path(text, "path.json");
  EXPECT_TRUE(read.is_proven);
  EXPECT_EQ(read.body, "peg");
  EXPECT_EQ(read.waypoints, result.path);  // To the bit.
  EXPECT_EQ(read.clearances, result.clearances);
  EXPECT_EQ(read.goals, plan.goals);
  EXPECT_EQ(read.margin, 0.01);
  EXPECT_EQ(read.seed, 3u);
  EXPECT_EQ(read.input_digest, plan.loaded.input_digest);
  EXPECT_EQ(write_planned_path(read), text);
  PlanOptions odd = plan.options;
  odd.seed = std::uint64_t{1} << 53;  // No reader of JSON has to keep it.
  EXPECT_THROW((void)planned_path(plan, odd, result), std::invalid_argument);

  // From the file alone: its scene, its waypoints.
  ShapeCache other;
  const LoadedScene loaded = load_scene_of(read, other);
  EXPECT_EQ(loaded.input_digest, read.input_digest);
  PlanQuestion again;
  again.body = 1;
  const ScenePlan replanned = make_scene_plan(read.scene, again, other);
  const EdgeChecker checker(replanned.plan,
                            {.tolerance = read.tolerance, .extra_clearance = read.extra_clearance});
  for (std::size_t k = 0; k + 1 < read.waypoints.size(); ++k) {
    EXPECT_EQ(checker.check(read.waypoints[k], read.waypoints[k + 1]).verdict, EdgeVerdict::free);
    EXPECT_GE(read.clearances[k].value(), 0.01);
  }
}

// The tolerance of 1 um is small beside kilometres, so that the least distance takes more effort
// than is allowed. The clearance was the hair that the proof adds.
TEST(ScenePlan, HasAClearanceInKilometres) {
  const Scene scene = scene_of(R"({
  "firstcontact": 1,
  "bodies": [
    {"name": "wall", "shape": {"box": {"size": [1000, 10000, 10000]}}},
    {"name": "block", "shape": {"box": {"size": [3000, 3000, 3000]}}, "pose": {"position": [-5000, 0, 0]}}
  ],
  "plan": {"body": "block", "goal": {"position": [5000, 1000, 0]}, "time": 20}
})");
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(scene, *scene.plan, cache);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  for (const std::optional<double>& clearance : result.clearances) {
    EXPECT_GT(clearance.value(), 0.1);
  }
}

// Quaternions of four digits are 1e-5 off the length 1.
/// The plan of a body from one side of something to the other.
ScenePlan past(const std::string& obstacle, const std::string& shape, const std::string& more) {
  const Scene scene =
      scene_of(R"({"firstcontact": 1, "bodies": [)" + obstacle +
               R"({"name": "p", "pose": {"position": [-1, 0, 0]}, "shape": )" + shape +
               R"(}], "plan": {"body": "p",)" + more + R"("goal": {"position": [1, 0, 0]}}})");
  ShapeCache cache;
  return make_scene_plan(scene, *scene.plan, cache);
}

// Without a box, a body has room to go around all that there is.
TEST(ScenePlan, HasRoomAroundThickShapesAndMargins) {
  const char* kCapsule = R"({"name": "w", "shape": {"capsule": {"radius": 0.3, "length": 0.2}}},)";
  const char* kBall = R"({"name": "w", "shape": {"sphere": {"radius": 0.3}}},)";
  const char* kCube = R"({"name": "w", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}},)";
  const char* kCubeShape = R"({"box": {"size": [0.1, 0.1, 0.1]}})";
  for (const ScenePlan& plan :
       {past(kBall, R"({"sphere": {"radius": 0.1}})", ""), past(kCapsule, kCubeShape, ""),
        past(kBall, R"({"capsule": {"radius": 0.1, "length": 0.01}})", ""),
        past(kCube, kCubeShape, R"("margin": 0.3,)")}) {
    EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
              PlanVerdict::proven);
  }
}

// Also around where a body is meanwhile: this one goes to and fro.
TEST(ScenePlan, HasRoomAroundWhatMovesBetweenItsEnds) {
  const ScenePlan plan = past(
      R"({"name": "w", "shape": {"box": {"size": [0.2, 0.2, 0.2]}},
          "motion": {"type": "waypoints", "times": [0, 1, 2], "poses": [{"position": [0, 0, 0]},
                     {"position": [0, 3, 0]}, {"position": [0, 0, 0]}]}},)",
      R"({"box": {"size": [0.1, 0.1, 0.1]}})", R"("speeds": {"linear": 2, "angular": 2},)");
  EXPECT_GT(plan.plan.space.high().y(), 3.1);
}

TEST(ScenePlan, TakesQuaternionsOfAFewDigits) {
  const std::string text = kPegOverWall;
  const std::string start = R"("start": {"position": [-0.5, 0, 0],
                                         "quaternion_wxyz": [0.7071, 0, 0.7071, 0]}, )";
  for (const std::string& begin : {std::string(), start}) {
    const Scene scene = scene_of(
        text.substr(0, text.find("\"plan\"")) + R"("plan": {"body": "peg", )" + begin +
        R"("goal": {"position": [0.5, 0.1, 0.25], "quaternion_wxyz": [0, 0, 0.7071, 0.7071]},
            "time": 20}})");
    ShapeCache cache;
    const ScenePlan plan = make_scene_plan(scene, *scene.plan, cache);
    const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
    ASSERT_EQ(result.verdict, PlanVerdict::proven);
    EXPECT_EQ(result.path.back()[5], result.path.back()[6]);
    EXPECT_NEAR(result.path.back()[6], std::sqrt(0.5), 1e-15);
    // The file begins where its scene has the peg, to the bit: a second proof demands it.
    const PlannedPath written = planned_path(plan, plan.options, result);
    const Pose pose = std::get<FixedMotion>(written.scene.bodies[1].motion).pose;
    const std::vector<double>& first = written.waypoints.front();
    EXPECT_EQ(pose.rotation.coeffs(), Eigen::Vector4d(first[4], first[5], first[6], first[3]));
  }
}

TEST(ScenePlan, RefusesWhatIsNoPlan) {
  EXPECT_NE(refusal(R"({"body": "pog", "goal": {"position": [0, 0, 1]}})").find("\"peg\""),
            std::string::npos);
  EXPECT_NE(refusal(R"({"goal": {"position": [0, 0, 1]}})").find("what moves"), std::string::npos);
  EXPECT_NE(refusal(R"({"body": "peg"})").find("\"goal\""), std::string::npos);
  EXPECT_NE(refusal(R"({"body": "peg", "goals": []})").find("at least one goal"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"body": "peg", "goal": {"position": [0, 0, 1]}, "time": 0})").find("> 0"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"body": "peg", "goal": {"position": [0, 0, 1]}, "joints": ["a"]})")
                .find("is of a robot"),
            std::string::npos);
  EXPECT_EQ(
      refusal_of(R"({"firstcontact": 1, "bodies": [
      {"name": "peg", "shape": {"sphere": {"radius": 1}}},
      {"name": "cloth", "shape": {"vertices": [[3, 0, 0], [4, 0, 0], [3, 1, 0]],
       "triangles": [[0, 1, 2]]},
       "motion": {"type": "vertices", "to": [[3, 0, 0], [4, 0, 0], [3, 2, 0]]}}],
      "plan": {"body": "peg", "goal": {"position": [0, 0, 9]}}})"),
      "body \"cloth\" deforms; expected rigid bodies, among which a path can be proven again");
}

TEST(PlannedPath, NamesWhatIsNoPathFile) {
  const Scene scene = scene_of(kPegOverWall);
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(scene, *scene.plan, cache);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  const std::string good = write_planned_path(planned_path(plan, plan.options, result));
  const auto broken = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    return text.replace(place, from.size(), to);
  };
  for (const std::string& text :
       {broken("\"firstcontact_path\":1", "\"firstcontact_path\":2"),
        broken("\"moves\":{\"body\":\"peg\"}", "\"moves\":{\"body\":\"pog\"}"),
        broken("\"waypoints\":[[", "\"waypoints\":[[1,"),
        broken("\"edges\":[{", "\"edges\":[{\"verdict\":\"proven\",\"clearance\":1},{"),
        broken("\"verdict\":\"proven\"", "\"verdict\":\"approximate\""),
        broken("\"goal\":0", "\"goal\":1"), broken("\"tolerance\"", "\"tolerence\""),
        std::string("{}"), std::string("[")}) {
    EXPECT_THROW((void)parse_planned_path(text, "path.json"), ParseError) << text.substr(0, 200);
  }
  PlannedPath stale = parse_planned_path(good, "path.json");
  stale.input_digest = std::string(64, '0');
  ShapeCache other;
  EXPECT_THROW((void)load_scene_of(stale, other), std::invalid_argument);
}

/// The gantry of a URDF file that holds a load, among a wall.
class GantryFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() /
        ("plan_scene_test_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
         "_" + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "gantry.urdf") << R"(<robot name="gantry">
      <link name="base"/>
      <link name="slide"/>
      <link name="tool"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
      <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/>
        <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
      <joint name="z" type="prismatic"><parent link="slide"/><child link="tool"/>
        <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    </robot>)";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Scene scene(const std::string& plan) const {
    return parse_scene(R"({"firstcontact": 1,
      "bodies": [
        {"name": "wall", "shape": {"box": {"size": [0.00001, 1, 1]}}},
        {"name": "load", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-1, 0, -0.6]}}],
      "robots": [{"name": "g", "urdf": "gantry.urdf", "state": {"x": -1, "z": 0},
                  "attached": [{"body": "load", "link": "tool"}]}],
      "plan": )" + plan + "}",
                       folder_ / "scene.json", 1, {});
  }

  std::filesystem::path folder_;
};

TEST_F(GantryFile, KeepsWhatIsHeldInItsPlace) {
  const Scene asked = scene(R"({"goal": {"x": 1}})");
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache);
  ASSERT_EQ(plan.plan.space.size(), 1u);
  EXPECT_EQ(plan.start, Configuration{-1.0});
  // The load hangs 0.6 m under the tool: along x alone the tool is in the way of the wall.
  PlanOptions options = plan.options;
  options.time = 0.1;
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, options).verdict, PlanVerdict::none);

  const Scene both = scene(R"({"joints": ["x", "z"], "goal": {"x": 1}})");
  const ScenePlan over = make_scene_plan(both, *both.plan, cache);
  const PlanResult result = plan_path(over.plan, over.start, over.goals, over.options);
  ASSERT_EQ(result.verdict, PlanVerdict::proven);
  // Over the wall with the load, or under it with the tool.
  double most = 0.0;
  for (const Configuration& q : result.path) {
    most = std::max(most, std::abs(q[1]));
  }
  EXPECT_GT(most, 0.6);
  const PlannedPath path = planned_path(over, over.options, result);
  EXPECT_EQ(path.robots, std::vector<std::string>{"g"});
  EXPECT_EQ(path.joints, (std::vector<std::string>{"x", "z"}));
  ASSERT_TRUE(path.scene.robots[0].attached[0].pose.has_value());
  EXPECT_NEAR(path.scene.robots[0].attached[0].pose->position.z(), -0.6, 1e-12);
  const PlannedPath read = parse_planned_path(write_planned_path(path), "path.json");
  EXPECT_EQ(read.waypoints, result.path);
  EXPECT_EQ(read.turnings, (std::vector<Turning>{Turning::as_given, Turning::as_given}));
}

TEST_F(GantryFile, PlansToThePoseOfALink) {
  ShapeCache cache;
  const Scene asked = scene(R"({"goal": {"link": "tool", "pose": {"position": [1.2, 0, 0.4]},
                                         "frame": {"position": [0.2, 0, 0.1]}}})");
  const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache);
  ASSERT_EQ(plan.goals.size(), 1u);
  EXPECT_NEAR(plan.goals[0][0], 1.0, 1e-6);
  EXPECT_NEAR(plan.goals[0][1], 0.3, 1e-6);
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
            PlanVerdict::proven);

  const auto refusal_of = [&](const std::string& goal) {
    try {
      const Scene wrong = scene("{\"goal\": " + goal + "}");
      (void)make_scene_plan(wrong, *wrong.plan, cache);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refusal_of(R"({"link": "tol", "pose": {}})").find("did you mean \"tool\"?"),
            std::string::npos);
  // The gantry does not leave its plane y = 0.
  EXPECT_NE(refusal_of(R"({"link": "tool", "pose": {"position": [1, 0.5, 0]}})")
                .find("the nearest is 0.5"),
            std::string::npos);
  EXPECT_NE(refusal_of(R"({"link": "tool", "pose": {"position": [0.05, 0, 0]}})").find("wall"),
            std::string::npos);
}

// A held body has the motion of its link, whatever its own is; and where nothing is tested, nothing
// is proven of distances.
TEST_F(GantryFile, LeavesOutTheMotionOfWhatIsHeld) {
  const Scene asked = parse_scene(R"({"firstcontact": 1, "bodies": [
      {"name": "load", "shape": {"box": {"size": [0.1, 0.1, 0.1]}},
       "motion": {"type": "constant_velocity", "translation": [1, 0, 0]}}],
    "robots": [{"name": "g", "urdf": "gantry.urdf", "attached": [
      {"body": "load", "link": "tool", "pose": {"position": [0, 0, -0.5]}, "touch_links": ["tool"]}]}],
    "plan": {"goal": {"x": 1}}})",
                                  folder_ / "scene.json", 1, {});
  ShapeCache cache;
  const ScenePlan plan = make_scene_plan(asked, *asked.plan, cache);
  EXPECT_FALSE(plan.plan.times);
  const PlanResult result = plan_path(plan.plan, plan.start, plan.goals, plan.options);
  EXPECT_EQ(result.verdict, PlanVerdict::proven);
  EXPECT_FALSE(planned_path(plan, plan.options, result).clearance);
}

// Many configurations of a goal are in contact: a joint that does not move the link decides.
TEST_F(GantryFile, LooksForFreePlacesOfAGoal) {
  std::ofstream(folder_ / "gantry.urdf") << R"(<robot name="gantry"><link name="base"/>
      <link name="slide"/>
      <link name="flag"><collision><origin xyz="0.5 0 0"/>
        <geometry><box size="1 0.02 0.02"/></geometry></collision></link>
      <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/>
        <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
      <joint name="turn" type="revolute"><parent link="slide"/><child link="flag"/>
        <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>)";
  ShapeCache cache;
  for (int seed = 1; seed <= 10; ++seed) {
    const Scene asked =
        parse_scene(R"({"firstcontact": 1, "bodies": [
        {"name": "left", "shape": {"box": {"size": [9, 9, 1]}}, "pose": {"position": [0.4, 4.7, 0]}},
        {"name": "right", "shape": {"box": {"size": [9, 9, 1]}}, "pose": {"position": [0.4, -4.7, 0]}}],
      "robots": [{"name": "g", "urdf": "gantry.urdf", "state": {"x": 0, "turn": 0}}],
      "plan": {"joints": ["x", "turn"], "seed": )" +
                        std::to_string(seed) +
                        R"(, "goal": {"link": "slide", "pose": {"position": [1, 0, 0]}}}})",
                    folder_ / "scene.json", 1, {});
    EXPECT_GT(make_scene_plan(asked, *asked.plan, cache).goals.size(), 0u) << seed;
  }
}

TEST_F(GantryFile, KeepsTheLimitsOfJointsThatMimic) {
  std::ofstream(folder_ / "gantry.urdf") << R"(<robot name="gantry">
      <link name="base"/><link name="slide"/>
      <link name="tool"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
      <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/>
        <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
      <joint name="z" type="prismatic"><parent link="slide"/><child link="tool"/>
        <axis xyz="0 0 1"/><limit lower="-2" upper="0.5" effort="1" velocity="1"/>
        <mimic joint="x" multiplier="-1" offset="-1"/></joint>
    </robot>)";
  ShapeCache cache;
  const auto message_of = [&](const std::string& plan) {
    try {
      const Scene asked = parse_scene(R"({"firstcontact": 1,
        "robots": [{"name": "g", "urdf": "gantry.urdf", "state": {"x": -1}}], "plan": )" +
                                          plan + "}",
                                      folder_ / "scene.json", 1, {});
      const ScenePlan made = make_scene_plan(asked, *asked.plan, cache);
      const PlanResult found = plan_path(made.plan, made.start, made.goals, made.options);
      return std::string(found.verdict == PlanVerdict::proven ? "proven" : "none");
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(message_of(R"({"goal": {"x": 0.9}})"), "proven");
  EXPECT_NE(message_of(R"({"goal": {"x": -1.6}})").find("outside of its limits -1.5 to 1"),
            std::string::npos);
  EXPECT_NE(message_of(R"({"goal": {"x": 0.5, "z": 0.3}})").find("mimics \"x\""),
            std::string::npos);
  EXPECT_NE(message_of(R"({"goal": {"x": 0.5}, "bounds": {"x": [3, 4]}})").find("overlap"),
            std::string::npos);
}

// The pose of a link is a goal of all joints that move it: planar ones have three coordinates.
TEST_F(GantryFile, PlansPlanarJointsToThePoseOfALink) {
  std::ofstream(folder_ / "gantry.urdf") << R"(<robot name="cart">
      <link name="base"/><link name="cart"/>
      <link name="tool"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
      <joint name="p" type="planar"><parent link="base"/><child link="cart"/>
        <axis xyz="0 0 1"/></joint>
      <joint name="j" type="revolute"><parent link="cart"/><child link="tool"/>
        <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    </robot>)";
  const auto plan_with = [&](const std::string& more) {
    const Scene asked = parse_scene(R"({"firstcontact": 1,
        "bodies": [{"name": "wall", "shape": {"box": {"size": [0.00001, 1, 1]}}}],
        "robots": [{"name": "c", "urdf": "gantry.urdf", "state": {"p/x": -1}}],
        "plan": {"goal": {"link": "tool", "pose": {"position": [1, 0.2, 0]}})" +
                                        more + "}}",
                                    folder_ / "scene.json", 1, {});
    ShapeCache cache;
    return make_scene_plan(asked, *asked.plan, cache);
  };
  const ScenePlan plan = plan_with(R"(, "bounds": {"p/x": [-2, 2], "p/y": [-2, 2]})");
  ASSERT_EQ(plan.plan.space.size(), 4u);
  EXPECT_EQ(plan.plan.space.coordinates()[1].name, "p/y");
  EXPECT_EQ(plan_path(plan.plan, plan.start, plan.goals, plan.options).verdict,
            PlanVerdict::proven);
  const ScenePlan boundless = plan_with("");
  try {
    (void)plan_path(boundless.plan, boundless.start, boundless.goals, boundless.options);
    ADD_FAILURE() << "expected bounds to be asked for";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("slides without limits; give it bounds"),
              std::string::npos);
  }
}

TEST_F(GantryFile, RefusesGoalsThatAreNone) {
  EXPECT_THROW((void)scene(R"({"goal": {"y": 1}})"), ParseError);
  EXPECT_THROW((void)scene(R"({"goal": "home"})"), ParseError);
  const Scene other = scene(R"({"joints": ["x"], "goal": {"z": 1}})");
  ShapeCache cache;
  EXPECT_THROW((void)make_scene_plan(other, *other.plan, cache), std::invalid_argument);
  const Scene outside = scene(R"({"goal": {"x": 3}})");
  const ScenePlan plan = make_scene_plan(outside, *outside.plan, cache);
  EXPECT_THROW((void)plan_path(plan.plan, plan.start, plan.goals), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
