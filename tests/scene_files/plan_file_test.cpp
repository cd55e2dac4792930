// "plan" of a scene: every key, and what is refused. Whether a plan can be made is tested
// elsewhere.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <firstcontact/scene/plan_question.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

class PlanFile : public testing::Test {
 protected:
  PlanFile() {
    folder_.write("cart.urdf", R"(<robot name="cart"><link name="floor"/><link name="plate"/>
      <joint name="roll" type="planar"><parent link="floor"/><child link="plate"/>
        <axis xyz="0 0 1"/></joint></robot>)");
  }

  /// The question of a scene with two bodies, an arm and a cart.
  [[nodiscard]] PlanQuestion plan(const std::string& plan) const {
    const std::string robots =
        R"("robots": [{"name": "arm", "urdf": "arm.urdf", "srdf": "arm.srdf"},
                      {"name": "cart", "urdf": "cart.urdf"}], "plan": {)" +
        plan + "}";
    return parse_scene(test::scene(test::body("wall") + "," + test::body("peg"), robots),
                       folder_.path() / "s.json")
        .plan.value();
  }

  [[nodiscard]] PlanQuestion of_arm(const std::string& more) const {
    return plan(R"("robot": "arm")" + (more.empty() ? "" : ", " + more));
  }

  /// The message about a plan, from its place in the plan on.
  [[nodiscard]] std::string said(const std::string& keys) const {
    const std::string text = test::message_of<ParseError>([&] { (void)plan(keys); });
    const std::string place = "plan";
    const std::size_t at = text.find(": " + place);
    return at == std::string::npos ? text : text.substr(at + 2 + place.size());
  }

  void expect_plan_messages(const std::string& begin,
                            const std::vector<std::pair<std::string, std::string>>& cases) const {
    for (const auto& [keys, message] : cases) {
      EXPECT_EQ(said(begin + keys), message) << keys;
    }
  }

  test::ArmFolder folder_;
};

TEST_F(PlanFile, LeavesToThePlannerWhatItDoesNotSay) {
  const PlanQuestion arm = of_arm(R"("goal": {"elbow": 1})");
  EXPECT_EQ(arm.robots, (std::vector<std::size_t>{0}));
  EXPECT_FALSE(arm.body);
  EXPECT_TRUE(arm.joints.empty());
  EXPECT_TRUE(arm.start.empty());
  EXPECT_TRUE(arm.speeds.empty());
  EXPECT_TRUE(arm.bounds.empty());
  EXPECT_TRUE(arm.contact_pairs.empty());
  EXPECT_FALSE(arm.margin);
  EXPECT_FALSE(arm.planner);
  EXPECT_FALSE(arm.contacts);
  EXPECT_FALSE(arm.seed);
  EXPECT_FALSE(arm.time);
  const PlanQuestion peg = plan(R"("body": "peg", "goal": {})");
  EXPECT_FALSE(peg.start_pose);
  EXPECT_FALSE(peg.box);
  EXPECT_EQ(peg.goal_poses.size(), 1u);
}

TEST_F(PlanFile, TakesEveryKeyOfARobot) {
  const PlanQuestion asked = of_arm(
      R"("joints": ["elbow"], "start": ["half", {"elbow": -0.25}],
         "goals": ["all/half", {"elbow": 1.25}, {"link": "tip", "pose": {"position": [1, 2, 3]},
           "frame": {"position": [0, 0, 4]}, "position_tolerance": 0.5, "rotation_tolerance": 7}],
         "bounds": {"elbow": [-1, 2]}, "speeds": {"elbow": 1e8}, "margin": 0,
         "planner": "lazy_prm_star", "contacts": "slide", "seed": 9007199254740991, "time": 1e-9,
         "contact_pairs": [{"pair": ["peg", "wall"], "policy": "not_deeper"},
                           {"pair": ["arm/tip", "peg"], "policy": "must_open", "at": "goal"}])");
  EXPECT_EQ(asked.joints, (std::vector<std::string>{"elbow"}));
  EXPECT_EQ(asked.start, (JointPositions{{"elbow", -0.25}}));  // What is behind prevails.
  ASSERT_EQ(asked.goals.size(), 2u);
  EXPECT_EQ(asked.goals[0], (JointPositions{{"elbow", 0.5}}));
  EXPECT_EQ(asked.goals[1], (JointPositions{{"elbow", 1.25}}));
  ASSERT_EQ(asked.link_goals.size(), 1u);
  EXPECT_EQ(asked.link_goals[0].link, "tip");
  EXPECT_EQ(asked.link_goals[0].X_WT.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(asked.link_goals[0].X_LT.position, Eigen::Vector3d(0, 0, 4));
  EXPECT_EQ(asked.link_goals[0].position_tolerance, 0.5);
  EXPECT_EQ(asked.link_goals[0].rotation_tolerance, 7.0);
  EXPECT_EQ(asked.bounds, (std::map<std::string, std::array<double, 2>>{{"elbow", {-1.0, 2.0}}}));
  EXPECT_EQ(asked.speeds, (std::map<std::string, double>{{"elbow", 1e8}}));
  EXPECT_EQ(asked.margin, 0.0);
  EXPECT_EQ(asked.planner, Planner::lazy_prm_star);
  EXPECT_EQ(asked.contacts, ContactUse::slide);
  EXPECT_EQ(asked.seed, (std::uint64_t{1} << 53) - 1);
  EXPECT_EQ(asked.time, 1e-9);
  ASSERT_EQ(asked.contact_pairs.size(), 2u);
  EXPECT_EQ(asked.contact_pairs[0].members, (BodyPair{0, 1}));  // In the order of the scene.
  EXPECT_EQ(asked.contact_pairs[0].policy, ContactPolicy::not_deeper);
  EXPECT_EQ(asked.contact_pairs[0].at, PathEnd::start);
  EXPECT_EQ(asked.contact_pairs[1].members, (BodyPair{1, 4}));
  EXPECT_EQ(asked.contact_pairs[1].policy, ContactPolicy::must_open);
  EXPECT_EQ(asked.contact_pairs[1].at, PathEnd::goal);
}

TEST_F(PlanFile, TakesEveryKeyOfABody) {
  const PlanQuestion asked = plan(
      R"("body": "peg", "start": {"position": [1, 0, 0]},
         "goals": [{"position": [2, 0, 0]}, {"quaternion_wxyz": [0, 0, 0, 2]}],
         "box": [[-1, -2, -3], [3, 4, 5]], "speeds": {"linear": 2, "angular": 3})");
  EXPECT_EQ(asked.body, 1u);
  EXPECT_TRUE(asked.robots.empty());
  EXPECT_EQ(asked.start_pose.value().position.x(), 1.0);
  ASSERT_EQ(asked.goal_poses.size(), 2u);
  EXPECT_EQ(asked.goal_poses[0].position.x(), 2.0);
  EXPECT_EQ(asked.goal_poses[1].rotation.z(), 2.0);
  EXPECT_EQ(asked.box.value()[0], Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(asked.box.value()[1], Eigen::Vector3d(3, 4, 5));
  EXPECT_EQ(asked.speeds, (std::map<std::string, double>{{"angular", 3.0}, {"linear", 2.0}}));
}

// A name within one of several robots begins with the robot's, also where a state of the SRDF says
// it without.
TEST_F(PlanFile, CallsCoordinatesByTheirRobots) {
  const PlanQuestion asked = plan(
      R"("robots": ["cart", "arm"], "joints": ["cart/roll/theta", "arm/elbow"],
         "start": ["arm/half", {"cart/roll/x": 3}], "goal": {"arm/elbow": 1},
         "speeds": {"cart/roll/y": 4}, "bounds": {"arm/elbow": [0, 1]})");
  EXPECT_EQ(asked.robots, (std::vector<std::size_t>{1, 0}));
  EXPECT_EQ(asked.joints, (std::vector<std::string>{"cart/roll/theta", "arm/elbow"}));
  EXPECT_EQ(asked.start, (JointPositions{{"arm/elbow", 0.5}, {"cart/roll/x", 3.0}}));
  EXPECT_TRUE(asked.bounds.contains("arm/elbow"));
  EXPECT_TRUE(asked.speeds.contains("cart/roll/y"));
  // Alone, the robot's name is left out.
  const PlanQuestion alone = plan(R"("robot": "cart", "goal": {"roll/theta": 1})");
  EXPECT_EQ(alone.goals[0], (JointPositions{{"roll/theta", 1.0}}));
}

// A pose and a number of it would contradict each other, and one of them would be lost.
TEST_F(PlanFile, RefusesANumberBesideItsPose) {
  const std::string twice = " is given twice, also by a pose; leave one of them out";
  const std::string pose = R"("peg": {"position": [0, 0, 1]})";
  expect_plan_messages(
      R"("robot": "arm", "body": "peg", )",
      {{R"("goal": {"peg/trans_x": 0.5, )" + pose + "}", ".goal.peg: \"peg/trans_x\"" + twice},
       {R"("goal": {)" + pose + R"(, "peg/rot_w": 1})", ".goal[\"peg/rot_w\"]: \"peg/rot_w\"" + twice},
       {R"("goal": {}, "start": {)" + pose + R"(, "peg/trans_z": 1})",
        ".start[\"peg/trans_z\"]: \"peg/trans_z\"" + twice}});
  const std::string lander = R"(<robot name="lander"><link name="world"/><link name="hull"/>
      <joint name="float" type="floating"><parent link="world"/><child link="hull"/></joint></robot>)";
  folder_.write("lander.urdf", lander);
  const auto state = [&](const std::string& of) {
    return test::message_of<ParseError>([&] {
      (void)parse_scene(
          test::scene(test::body("wall"), R"("robots": [{"name": "l", "urdf": "lander.urdf",
                                                          "state": )" +
                                              of + "}]"),
          folder_.path() / "s.json");
    });
  };
  EXPECT_THAT(state(R"({"float/trans_x": 0.5, "float": {"position": [1, 0, 0]}})"),
              testing::HasSubstr(R"("float/trans_x")" + twice));
  // Of an array, the later one counts.
  EXPECT_EQ(state(R"([{"float/trans_x": 0.5}, {"float": {"position": [1, 0, 0]}}])"), "accepted");
}

TEST_F(PlanFile, SaysWhatMoves) {
  const std::string goal = R"(, "goal": {})";
  expect_plan_messages(
      "",
      {{R"("goal": {})", ": expected \"robot\", \"robots\" or \"body\", the name of what moves"},
       {R"("robot": "arm", "robots": ["arm"])" + goal,
        ": expected either \"robot\" or \"robots\", got both"},
       {R"("body": "peg", "robots": [])" + goal,
        ".robots: expected at least two robots; a single one is \"robot\", got an array of 0"},
       {R"("body": 1)" + goal, ".body: expected the name of a body, got 1"},
       {R"("body": "peq")" + goal,
        ".body: expected the name of a body of the scene, got \"peq\"; did you mean \"peg\"?"},
       {R"("body": "arm")" + goal, ".body: expected the name of a body of the scene, got \"arm\""},
       {R"("robot": "wall")" + goal,
        ".robot: expected the name of a robot of the scene, got \"wall\""},
       {R"("robots": ["arm", "arm"])" + goal,
        ".robots[1]: expected each robot once, got it a second time"},
       {R"("robots": ["arm"])" + goal,
        ".robots: expected at least two robots; a single one is \"robot\", got an array of 1"},
       {R"("robots": "arm")" + goal, ".robots: expected an array of names of robots, got \"arm\""},
       {R"("robt": "arm")" + goal, ".robt: unknown key; did you mean \"robot\"?"}});
}

TEST_F(PlanFile, SaysWhatIsWrongWithOptions) {
  expect_plan_messages(
      R"("robot": "arm", "goal": {"elbow": 1}, )",
      {{R"("margin": -1e-300)", ".margin: expected a number >= 0, got -1e-300"},
       {R"("time": 0)", ".time: expected a number > 0, got 0"},
       {R"("planner": "rrt")",
        ".planner: unknown word \"rrt\"; known are \"rrt_connect\", \"lazy_prm_star\""},
       {R"("contacts": true)",
        ".contacts: expected one of \"none\", \"sample\", \"slide\", \"both\", got true"},
       {R"("seed": -1)",
        ".seed: expected a seed, a whole number, an integer from 0 to 9007199254740991, got -1"},
       {R"("seed": 9007199254740992)",
        ".seed: expected a seed, a whole number, an integer from 0 to 9007199254740991, got "
        "9007199254740992"},
       {R"("box": [[0, 0, 0], [1, 1, 1]])", ".box: \"box\" is of a body; a robot has \"bounds\""},
       {R"("goals": [])", ": expected either \"goal\" or \"goals\", got both"},
       {R"("speeds": {"elbow": 0})", ".speeds.elbow: expected a number > 0, got 0"},
       {R"("speeds": {"elbow": 100000001})",
        ".speeds.elbow: expected a speed of at most 1e8, got 100000001"},
       {R"("speeds": [1])", ".speeds: expected speeds by joint, got an array of 1"},
       {R"("bounds": [-1, 1])",
        ".bounds: expected limits by joint, such as {\"joint\": [-1, 1]}, got an array of 2"},
       {R"("bounds": {"elbow": [1]})",
        ".bounds.elbow: expected two numbers, the lower limit first, got an array of 1"},
       {R"("bounds": {"elbow": [null, 1]})", ".bounds.elbow[0]: expected a number, got null"},
       {R"("joints": "elbow")", ".joints: expected an array of names of joints, got \"elbow\""},
       {R"("joints": [""])", ".joints[0]: expected the name of a joint, got \"\""},
       {R"("start": 7)",
        ".start: expected positions by joint, such as {\"joint\": 0.1}, or the name of a state of "
        "the SRDF, got 7"},
       {R"("start": ["half", ["half", {"elbow": "up"}]])",
        ".start[1][1].elbow: expected a number, got \"up\""},
       {R"("start": "haf")",
        ".start: expected a state of the SRDF, got \"haf\"; it has \"all/half\""}});
}

TEST_F(PlanFile, SaysWhatIsWrongWithABody) {
  expect_plan_messages(
      R"("body": "peg", "goal": {}, )",
      {{R"("joints": [])", ".joints: \"joints\" is of a robot; a body has \"box\""},
       {R"("bounds": {})", ".bounds: \"bounds\" is of a robot; a body has \"box\""},
       {R"("box": [[0, 0, 0]])",
        ".box: expected two corners, the low one first, got an array of 1"},
       {R"("box": [[0, 0, 0], [1, 1]])", ".box[1]: expected three numbers, got an array of 2"},
       {R"("speeds": {"linear": 1})", ".speeds: expected a key \"angular\", got none"},
       {R"("speeds": {"linear": 1, "angular": 1, "x": 1})",
        ".speeds.x: unknown key; known are \"linear\", \"angular\""},
       {R"("start": {"x": 1})",
        ".start.x: unknown key; known are \"position\", \"quaternion_wxyz\", \"rpy\", "
        "\"rotation_vector\", \"matrix\""}});
  EXPECT_EQ(said(R"("body": "peg")"), ": expected \"goal\" or \"goals\", got neither");
  EXPECT_EQ(said(R"("body": "peg", "goals": [])"),
            ".goals: expected at least one goal, got an array of 0");
  EXPECT_EQ(said(R"("body": "peg", "goals": {})"),
            ".goals: expected an array of goals, got an object");
}

TEST_F(PlanFile, SaysWhatIsWrongWithGoalsOfLinks) {
  const std::string tip = R"("goal": {"link": "tip")";
  expect_plan_messages(
      R"("robot": "arm", )",
      {{tip + "}", ".goal: expected a key \"pose\", got none"},
       {tip + R"(, "pose": {}, "tolerance": 1})",
        ".goal.tolerance: unknown key; known are \"link\", \"frame\", \"pose\", "
        "\"position_tolerance\", \"rotation_tolerance\""},
       {tip + R"(, "pose": {}, "position_tolerance": 0})",
        ".goal.position_tolerance: expected a number > 0, got 0"},
       {tip + R"(, "pose": {}, "rotation_tolerance": "any"})",
        ".goal.rotation_tolerance: expected a number, got \"any\""},
       {tip + R"(, "pose": {"position": [0, 0]}})",
        ".goal.pose.position: expected three numbers, got an array of 2"},
       {R"("goal": {"link": "tpi", "pose": {}})",
        ".goal.link: expected a link of the robot, got \"tpi\"; did you mean \"tip\"?"},
       {R"("goal": {"link": "arm/tip", "pose": {}})",
        ".goal.link: expected a link of the robot, got \"arm/tip\""}});
}

TEST_F(PlanFile, SaysWhatIsWrongWithPairsInContact) {
  const std::string policy = R"(, "policy": "may_stay"})";
  const std::string name = "expected the name of a body, or robot/link, got ";
  const auto pairs = [](const std::string& inside) {
    return R"("contact_pairs": [)" + inside + "]";
  };
  const std::string twice = R"({"pair": ["wall", "peg"])" + policy;
  expect_plan_messages(
      R"("body": "peg", "goal": {}, )",
      {{R"("contact_pairs": {})",
        ".contact_pairs: expected an array of pairs in contact, got an object"},
       {pairs(R"({"pair": ["peg"])" + policy),
        ".contact_pairs[0].pair: expected a pair of names, such as [\"peg\", \"block\"], got an "
        "array of 1"},
       {pairs(R"({"pair": ["peg", "peg"])" + policy),
        ".contact_pairs[0].pair: expected two bodies, got one twice"},
       {pairs(twice + "," + R"({"pair": ["peg", "wall"])" + policy),
        ".contact_pairs[1].pair: expected each pair once, or must_open at both ends; got it a "
        "second time"},
       // A robot is many members: which of them is in contact has to be said.
       {pairs(R"({"pair": ["peg", "arm"])" + policy),
        ".contact_pairs[0].pair[1]: " + name + "the robot or group \"arm\""},
       {pairs(R"({"pair": ["peg", "arm/tpi"])" + policy),
        ".contact_pairs[0].pair[1]: " + name + "\"arm/tpi\"; did you mean \"arm/tip\"?"},
       {pairs(R"({"pair": ["peg", "wall"]})"),
        ".contact_pairs[0]: expected a key \"policy\", got none"},
       {pairs(R"({"pair": ["peg", "wall"], "policy": "stay"})"),
        ".contact_pairs[0].policy: unknown word \"stay\"; known are \"may_stay\", \"not_deeper\", "
        "\"must_open\""},
       {pairs(R"({"pair": ["peg", "wall"], "policy": "may_stay", "at": "middle"})"),
        ".contact_pairs[0].at: unknown word \"middle\"; known are \"start\", \"goal\""}});
}

// A question is no part of a resolved scene: what is answered is in the path.
TEST_F(PlanFile, IsLeftOutOfAResolvedScene) {
  const Scene scene =
      parse_scene(test::scene(test::body("peg"), R"("plan": {"body": "peg", "goal": {}},
                                        "haptics": {"tools": [{"body": "peg"}]})"),
                  "s");
  ASSERT_TRUE(scene.plan && scene.haptics);
  const Scene again = parse_scene(write_scene(scene), "s");
  EXPECT_FALSE(again.plan);
  EXPECT_FALSE(again.haptics);
}

}  // namespace
}  // namespace firstcontact
