// Combinations that the files of a question may contain, and those that are refused.

#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_bits.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

class QuestionRules : public testing::Test {
 protected:
  QuestionRules() {
    folder_.write("post.off", "OFF\n3 1 0\n0 0 9\n1 0 9\n0 1 9\n3 0 1 2\n");
    folder_.write("goal.yaml",
                  "start_state:\n  joint_state: {name: [elbow], position: [0.25]}\n"
                  "goal_constraints:\n- joint_constraints: [{joint_name: elbow, position: 1}]\n");
  }

  [[nodiscard]] RobotQuestion question() const {
    return {.robot = {.urdf = folder_.path() / "arm.urdf"}, .srdf = folder_.path() / "arm.srdf"};
  }
  [[nodiscard]] RobotQuestion among(const std::vector<std::string>& files) const {
    RobotQuestion asked = question();
    for (const std::string& file : files) {
      asked.environment.push_back(folder_.path() / file);
    }
    return asked;
  }
  [[nodiscard]] std::string at(const std::string& file) const {
    return (folder_.path() / file).string();
  }

  static std::string said(const RobotQuestion& question) {
    const auto read = [&] { (void)read_robot_question(question); };
    try {
      return test::message_of<ParseError>(read);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }

  static std::vector<std::string> body_names(const Scene& scene) {
    std::vector<std::string> names;
    for (const Body& body : scene.bodies) {
      names.push_back(body.name);
    }
    return names;
  }

  test::ArmFolder folder_;
};

TEST_F(QuestionRules, HasOneMotionAtMost) {
  RobotQuestion asked = question();
  asked.trajectory = folder_.path() / "move.csv";
  asked.request = folder_.path() / "goal.yaml";
  EXPECT_EQ(said(asked), "expected one of a trajectory, a request and a goal, got 2");
  asked.goal = {"half"};
  EXPECT_EQ(said(asked), "expected one of a trajectory, a request and a goal, got 3");
  const std::string alone =
      "expected a start beside a goal alone; where joints rest that the motion does not name is "
      "the state";
  asked = question();
  asked.start = {"half"};
  asked.request = folder_.path() / "goal.yaml";
  EXPECT_EQ(said(asked), alone);
  asked.request.clear();
  asked.trajectory = folder_.path() / "move.csv";
  EXPECT_EQ(said(asked), alone);
  asked = question();
  asked.goal = {"half"};
  EXPECT_EQ(said(asked), "expected a start beside the goal, got none");
  asked = question();
  asked.unwrap = true;
  EXPECT_EQ(said(asked), "expected a trajectory, whose whole turns unwrap takes out, got none");
}

// Without a motion the robot rests where its state, and over it its start, has it.
TEST_F(QuestionRules, RestsWithoutAMotion) {
  RobotQuestion asked = question();
  asked.state = {"half"};
  Scene scene = read_robot_question(asked);
  EXPECT_EQ(scene.id, "arm");
  EXPECT_EQ(scene.duration, 1.0);
  EXPECT_TRUE(scene.robots.at(0).trajectory.joint_names.empty());
  EXPECT_EQ(scene.robots[0].state, (JointPositions{{"elbow", 0.5}}));
  asked.start = {"half", "elbow=-0.125"};
  EXPECT_EQ(read_robot_question(asked).robots[0].state, (JointPositions{{"elbow", -0.125}}));
}

TEST_F(QuestionRules, SaysWhatIsNoState) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"elbow", "start: expected a state of the SRDF, got \"elbow\"; it has \"all/half\""},
      {"elbow=", "elbow=0.1"},
      {"elbow=nan", "a finite number"},
      {"elbow=1e400", "a finite number"},
      {"elbow=0.5 rad", "a finite number"},
      {"=1", "\"\""},
      {"elbwo=1", "did you mean \"elbow\"?"}};
  for (const auto& [state, part] : cases) {
    RobotQuestion asked = question();
    asked.start = {state};
    const std::string message = said(asked);
    EXPECT_NE(message.find(part), std::string::npos) << state << ": " << message;
  }
}

TEST_F(QuestionRules, TakesTheBaseOfItsRequest) {
  folder_.write("moved.yaml",
                "start_state:\n  joint_state: {name: [elbow], position: [0.25]}\n"
                "  multi_dof_joint_state:\n    joint_names: [world_joint]\n"
                "    transforms: [{translation: [1, 2, 3], rotation: [0, 0, 0, 1]}]\n"
                "goal_constraints:\n- joint_constraints: [{joint_name: elbow, position: 1}]\n");
  RobotQuestion asked = question();
  asked.request = folder_.path() / "moved.yaml";
  asked.base.position = Eigen::Vector3d(9, 9, 9);
  const Scene scene = read_robot_question(asked);
  EXPECT_EQ(scene.id, "moved.yaml");
  EXPECT_EQ(std::get<FixedMotion>(scene.robots.at(0).base).pose.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.robots[0].trajectory.points.front().positions.at(0), 0.25);
  // Objects of a planning scene may be placed by the robot's base.
  folder_.write("room.yaml", "world: {}\n");
  asked.environment = {folder_.path() / "room.yaml"};
  EXPECT_EQ(said(asked), at("moved.yaml") +
                             ": start_state.multi_dof_joint_state: expected a base at the planning "
                             "frame beside planning scene " +
                             at("room.yaml") + ", but it is moved; move the objects in its place");
  asked.request.clear();
  EXPECT_EQ(
      said(asked),
      at("room.yaml") + ": expected a robot whose base is the planning frame, but it is moved");
}

TEST_F(QuestionRules, TakesAGoalOfALinkAsAPlanAlone) {
  folder_.write("reach.yaml",
                "goal_constraints:\n- position_constraints:\n  - link_name: tip\n"
                "    constraint_region: {primitives: [{type: 2, dimensions: [0.5]}], "
                "primitive_poses: [{position: [1, 0, 0]}]}\n");
  RobotQuestion asked = question();
  asked.request = folder_.path() / "reach.yaml";
  EXPECT_EQ(said(asked), at("reach.yaml") +
                             ": expected a goal of joint positions, got the pose of a link; "
                             "`firstcontact plan` finds a path to it");
  asked.plans = true;
  const Scene scene = read_robot_question(asked);
  ASSERT_TRUE(scene.plan.has_value());
  EXPECT_EQ(scene.plan->robots, (std::vector<std::size_t>{0}));
  ASSERT_EQ(scene.plan->link_goals.size(), 1u);
  EXPECT_EQ(scene.plan->link_goals[0].link, "tip");
  EXPECT_EQ(scene.plan->link_goals[0].X_WT.position.x(), 1.0);
  // One name for two frames would mean another goal than the objects beside it.
  folder_.write(
      "room.yaml",
      "fixed_frame_transforms: [{child_frame_id: world, transform: {translation: [0, 0.5, "
      "0]}}]\nworld: {}\n");
  asked.environment = {folder_.path() / "room.yaml"};
  EXPECT_EQ(said(asked), at("room.yaml") +
                             ": fixed_frame_transforms: expected \"world\" to be the planning "
                             "frame beside a goal that is the pose of a link; call the frame "
                             "otherwise");
  asked.request = folder_.path() / "goal.yaml";
  EXPECT_EQ(read_robot_question(asked).plan->goals.size(), 1u);
}

// Who plans has one way to ask, whether goals are of joints or of links, in files or in words.
TEST_F(QuestionRules, TakesGoalsOfJointsAsAPlan) {
  RobotQuestion asked = question();
  asked.request = folder_.path() / "goal.yaml";
  const Scene straight = read_robot_question(asked);
  EXPECT_FALSE(straight.plan);
  const Trajectory& motion = straight.robots.at(0).trajectory;
  ASSERT_EQ(motion.points.size(), 2u);
  asked.plans = true;
  const Scene scene = read_robot_question(asked);
  ASSERT_TRUE(scene.plan.has_value());
  EXPECT_TRUE(scene.robots.at(0).trajectory.joint_names.empty());
  ASSERT_EQ(scene.plan->goals.size(), 1u);
  for (std::size_t k = 0; k < motion.joint_names.size(); ++k) {
    EXPECT_EQ(scene.plan->goals[0].at(motion.joint_names[k]), motion.points[1].positions[k]);
  }
  asked.request.clear();
  asked.start = {motion.joint_names[0] + "=0.125"};
  asked.goal = {motion.joint_names[0] + "=0.5"};
  const Scene in_words = read_robot_question(asked);
  ASSERT_TRUE(in_words.plan.has_value());
  EXPECT_EQ(in_words.plan->goals.at(0), (JointPositions{{motion.joint_names[0], 0.5}}));
  EXPECT_EQ(in_words.robots.at(0).state.at(motion.joint_names[0]), 0.125);
}

TEST_F(QuestionRules, GivesEveryLinkAndJointItsAllowance) {
  RobotQuestion asked = among({"room.yaml"});
  folder_.write("room.yaml", "link_padding: [{link_name: tip, padding: 0.5}]\nworld: {}\n");
  asked.padding = 0.125;
  asked.tracking_error = 0.25;
  const SceneRobot robot = read_robot_question(asked).robots.at(0);
  EXPECT_EQ(robot.padding, (std::map<std::size_t, double>{{0, 0.125}, {1, 0.125}, {2, 0.5}}));
  ASSERT_EQ(robot.tracking_error.size(), 1u);  // The other joint is fixed.
  EXPECT_EQ(robot.tracking_error.at(0).angle, 0.25);
  asked.padding = 2.0;
  EXPECT_EQ(read_robot_question(asked).robots.at(0).padding.at(2), 2.0);
}

TEST_F(QuestionRules, TellsSurroundingsOfTheSameNameApart) {
  std::filesystem::create_directories(folder_.path() / "other");
  std::filesystem::copy(at("post.off"), at("other/post.off"));
  const Scene scene = read_robot_question(among({"post.off", "other/post.off", "post.off"}));
  EXPECT_EQ(body_names(scene), (std::vector<std::string>{"post", "post (2)", "post (3)"}));
}

// A mesh may be called as the robot is; the scene still has each name once, and can be read back.
TEST_F(QuestionRules, TellsSurroundingsAndTheRobotApart) {
  std::filesystem::copy(at("post.off"), at("arm.off"));
  const Scene scene = read_robot_question(among({"arm.off", "arm.off"}));
  EXPECT_EQ(body_names(scene), (std::vector<std::string>{"arm (2)", "arm (3)"}));
  EXPECT_EQ(scene.robots.at(0).name, "arm");
  const Scene again = parse_scene(write_scene(scene), "/nowhere/s.json");
  EXPECT_EQ(test::SceneBits(again), test::SceneBits(scene));
  ShapeCache cache;
  EXPECT_EQ(load_scene(scene, cache).pair_counts.tested, 4u);
}

// So it is with a group of the scene that comes first.
TEST_F(QuestionRules, TellsSurroundingsAndGroupsApart) {
  folder_.write("room.json",
                test::scene(test::body("a"), R"("pairs": {"groups": {"post": ["a"]}})"));
  const Scene scene = read_robot_question(among({"room.json", "post.off"}));
  EXPECT_EQ(body_names(scene), (std::vector<std::string>{"a", "post (2)"}));
  const Scene again = parse_scene(write_scene(scene), "/nowhere/s.json");
  EXPECT_EQ(test::SceneBits(again), test::SceneBits(scene));
}

TEST_F(QuestionRules, TakesTheRulesOfASceneThatComesFirst) {
  folder_.write("room.json",
                test::scene(test::body("a") + "," + test::body("b"),
                            R"("pairs": {"groups": {"g": ["b"]}, "ignore": [["a", "b"]],
                                         "margin": [["g", "g", 0.5]]},
                               "options": {"margin": 0.25, "duration": 7, "lenient": true})"));
  const Scene scene = read_robot_question(among({"room.json", "post.off"}));
  EXPECT_EQ(body_names(scene), (std::vector<std::string>{"a", "b", "post"}));
  EXPECT_EQ(scene.ignored_pairs, (std::vector<BodyPair>{{0, 1}}));
  EXPECT_EQ(scene.groups.at(0).bodies, (std::vector<std::size_t>{1}));
  EXPECT_EQ(scene.group_margins.size(), 1u);
  EXPECT_EQ(scene.options.margin, 0.25);
  EXPECT_TRUE(scene.options.lenient);
  EXPECT_EQ(scene.duration, 7.0);  // Nothing else has one.
  EXPECT_EQ(
      said(among({"post.off", "room.json"})),
      at("room.json") + ": expected a scene as the first environment: its rules go by bodies");
}

TEST_F(QuestionRules, SaysWhatAreNoSurroundings) {
  const std::string taken =
      ": expected no body or group \"arm\", as the robot has this name; rename it";
  folder_.write("body.json", test::scene(test::body("a") + "," + test::body("arm")));
  EXPECT_EQ(said(among({"body.json"})), at("body.json") + taken);
  folder_.write("group.json",
                test::scene(test::body("a"), R"("pairs": {"groups": {"arm": ["a"]}})"));
  EXPECT_EQ(said(among({"group.json"})), at("group.json") + taken);
  EXPECT_EQ(said(among({"none.off"})),
            at("none.off") +
                ": expected an environment (a mesh, a planning scene in .yaml, or a "
                "scene in .json), found no such file");
  EXPECT_EQ(said(among({"none.json"})), at("none.json") + ": expected an environment, found none");
  folder_.write("arms.json",
                R"({"firstcontact": 1, "robots": [{"name": "r", "urdf": "arm.urdf"}]})");
  EXPECT_EQ(
      said(among({"arms.json"})),
      at("arms.json") + ": expected an environment without robots, got 1; check this scene itself");
  folder_.write("broken.json", "{\"firstcontact\": 1,\n\"bodies\": [}");
  EXPECT_EQ(said(among({"broken.json"})).substr(0, at("broken.json").size() + 3),
            at("broken.json") + ":2:");
  folder_.write(
      "held.yaml",
      "robot_state: {attached_collision_objects: [{link_name: tap, object: {id: rod, "
      "header: {frame_id: tap}, primitives: [{type: sphere, dimensions: [1]}]}}]}\nworld: {}\n");
  EXPECT_EQ(said(among({"held.yaml"})), at("held.yaml") +
                                            ": attached object \"rod\": expected a link of the "
                                            "robot, got \"tap\"");
}

// Bodies that move without times move over the whole scene: its duration is theirs.
TEST_F(QuestionRules, RefusesSurroundingsThatWouldChangeTheirSpeed) {
  const auto room = [&](const std::string& duration) {
    folder_.write("room.json", test::scene(test::body("a", test::falling("1", "-1")),
                                           R"("options": {"duration": )" + duration + "}"));
    RobotQuestion asked = among({"room.json"});
    asked.trajectory = folder_.path() / "move.csv";
    return said(asked);
  };
  EXPECT_EQ(room("4"), "accepted");
  EXPECT_EQ(room("3"), at("room.json") +
                           ": expected options.duration 4, as the trajectory takes, since bodies "
                           "move over all of it; got 3");
  EXPECT_EQ(room("4.0000000001"), "accepted");  // Of rounding.
  folder_.write("room.json", test::scene(test::body("a", test::falling("1", "-1"))));
  RobotQuestion moving = among({"room.json"});
  moving.trajectory = folder_.path() / "move.csv";
  EXPECT_EQ(read_robot_question(moving).duration, 4.0);
  folder_.write("rest.json", test::scene(test::body("a"), R"("options": {"duration": 3})"));
  RobotQuestion asked = among({"rest.json"});
  asked.trajectory = folder_.path() / "move.csv";
  EXPECT_EQ(read_robot_question(asked).duration, 4.0);
}

// The digest names the texts of all files but the robot's own, in their order.
TEST_F(QuestionRules, IsNamedByADigestOfItsTexts) {
  folder_.write("a.json", test::scene(test::body("a")));
  const auto digest = [&](const std::string& trajectory) {
    RobotQuestion asked = among({"a.json"});
    folder_.write("move.csv", trajectory);
    asked.trajectory = folder_.path() / "move.csv";
    return read_robot_question(asked).text_digest;
  };
  const std::string first = digest("time,elbow\n0,0\n4,2\n");
  EXPECT_EQ(first.size(), 64u);
  EXPECT_EQ(digest("time,elbow\n0,0\n4,2\n"), first);
  EXPECT_NE(digest("time,elbow\n0,0\n4,2.5\n"), first);
  folder_.write("a.json", test::scene(test::body("b")));
  EXPECT_NE(digest("time,elbow\n0,0\n4,2\n"), first);
}

}  // namespace
}  // namespace firstcontact
