#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/parse_json.h>

namespace firstcontact {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

/// A bar of 1 m that turns without end about z, 1 rad/s at most, and has a fixed tip; a post behind
/// it at x = -0.8, and one before it at x = 0.8.
class RobotQuestions : public testing::Test {
 protected:
  RobotQuestions()
      : folder_(std::filesystem::temp_directory_path() / ("spinner." + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    write("arm.urdf", R"(<robot name="spinner"><link name="base"/>
      <link name="bar"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.04 0.04"/></geometry></collision></link>
      <link name="tip"/>
      <joint name="turn" type="continuous"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/>
        <limit effort="10" velocity="1"/></joint>
      <joint name="finger" type="fixed"><parent link="bar"/><child link="tip"/></joint></robot>)");
    write("arm.srdf", R"(<robot name="spinner"><group name="g"><joint name="turn"/></group>
      <group_state name="a" group="g"><joint name="turn" value="3.0"/></group_state>
      <group_state name="b" group="g"><joint name="turn" value="-3.0"/></group_state></robot>)");
    write("behind.json", post(-0.8));
    write("before.json", post(0.8));
  }
  ~RobotQuestions() override { std::filesystem::remove_all(folder_); }

  static std::string post(double x) {
    return R"({"firstcontact": 1, "bodies": [{"name": "post", "shape": {"box": {"size": [0.1, 0.1, 0.6]}},
      "pose": {"position": [)" +
           std::to_string(x) + ", 0, 0]}}]}";
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  [[nodiscard]] RobotQuestion question(const std::string& environment = "") const {
    RobotQuestion question{.robot = {.urdf = folder_ / "arm.urdf"}, .srdf = folder_ / "arm.srdf"};
    if (!environment.empty()) {
      question.environment = {folder_ / environment};
    }
    return question;
  }

  [[nodiscard]] RobotQuestion between_states(const std::string& environment) const {
    RobotQuestion asked = question(environment);
    asked.start = {"a"};
    asked.goal = {"b"};
    return asked;
  }

  [[nodiscard]] RobotQuestion along(const std::string& file, const std::string& text) const {
    write(file, text);
    RobotQuestion asked = question();
    asked.trajectory = folder_ / file;
    return asked;
  }

  static LoadedScene load(const Scene& scene) {
    ShapeCache cache;
    return load_scene(scene, cache);
  }

  static SceneResult check(const LoadedScene& loaded) {
    ManyBodiesWorkspace workspace;
    return check_scene(loaded, workspace, {});
  }

  static SceneResult check(const RobotQuestion& question) {
    return check(load(read_robot_question(question)));
  }

  /// Warnings of the answer with this word in them.
  static std::vector<std::string> warnings(const RobotQuestion& question, const std::string& word) {
    std::vector<std::string> found = check_warnings(load(read_robot_question(question)));
    std::erase_if(found, [&](const std::string& w) { return w.find(word) == std::string::npos; });
    return found;
  }

  std::filesystem::path folder_;
};

// Results and paths have the resolved scene: read again, it has the digest of what was asked.
TEST_F(RobotQuestions, KeepTheirDigestInAnEmbeddedScene) {
  const Scene scene = read_robot_question(question("behind.json"));
  Scene embedded = parse_embedded_scene(R"({"scene": )" + write_scene(scene) + "}", "result.json");
  embedded.text_digest = scene.text_digest;
  EXPECT_EQ(load(embedded).input_digest, load(scene).input_digest);
}

// From 3 to -3 rad the bar's edge meets the post behind it where the corner (-0.75, 0.05) is.
TEST_F(RobotQuestions, GoTheShortWayBetweenStatesAsMoveItDoes) {
  const double angle =
      kHalfTurn - std::atan2(0.05, 0.75) - std::asin(0.02 / std::hypot(0.75, 0.05));
  const LoadedScene loaded = load(read_robot_question(between_states("behind.json")));
  const SceneResult result = check(loaded);
  EXPECT_EQ(result.verdict, Verdict::contact);
  EXPECT_NEAR(loaded.scene.duration, 2.0 * kHalfTurn - 6.0, 1e-9);
  EXPECT_NEAR(result.t * loaded.scene.duration, angle - 3.0, 2e-6);
  EXPECT_EQ(check(between_states("before.json")).verdict, Verdict::free);
}

TEST_F(RobotQuestions, GoTheLongWayWhereThatIsAsked) {
  RobotQuestion asked = between_states("before.json");
  asked.turning = Turning::as_given;
  EXPECT_EQ(check(asked).verdict, Verdict::contact);
  EXPECT_NEAR(read_robot_question(asked).duration, 6.0, 1e-9);
  asked.environment = {folder_ / "behind.json"};
  EXPECT_EQ(check(asked).verdict, Verdict::free);
}

TEST_F(RobotQuestions, GoTheShortWayToTheGoalOfARequest) {
  write("request.yaml",
        "start_state:\n  joint_state: {name: [turn], position: [3.0]}\ngoal_constraints:\n- "
        "joint_constraints: [{joint_name: turn, position: -3.0}]\n");
  RobotQuestion asked = question("behind.json");
  asked.request = folder_ / "request.yaml";
  EXPECT_EQ(check(asked).verdict, Verdict::contact);
  asked.turning = Turning::as_given;
  EXPECT_EQ(check(asked).verdict, Verdict::free);
}

TEST_F(RobotQuestions, FollowTrajectoriesAsGivenUnlessAsked) {
  RobotQuestion asked = along("move.csv", "time,turn\n0,3\n10,-3\n");
  asked.environment = {folder_ / "before.json"};
  EXPECT_EQ(check(asked).verdict, Verdict::contact);
  asked.turning = Turning::shortest;
  EXPECT_EQ(check(asked).verdict, Verdict::free);
}

// The result contains the answered question, and the scene in it gives the same answer again.
TEST_F(RobotQuestions, SayWhichWayWasTaken) {
  const Scene scene = read_robot_question(between_states("behind.json"));
  const LoadedScene loaded = load(scene);
  const std::string result = write_result(loaded, check(loaded));
  const detail::JsonValue root = detail::parse_json(result, "result");
  const auto& turns = std::get<detail::JsonArray>(
      detail::find(std::get<detail::JsonObject>(root.value), "turns")->value);
  const auto& turn = std::get<detail::JsonObject>(turns.at(0).value);
  EXPECT_EQ(std::get<std::string>(detail::find(turn, "joint")->value), "turn");
  EXPECT_EQ(std::get<std::string>(detail::find(turn, "turning")->value), "short");
  EXPECT_NEAR(std::get<double>(detail::find(turn, "turned")->value), 2.0 * kHalfTurn - 6.0, 1e-15);
  const Scene again = parse_scene(write_scene(scene), "again.json");
  EXPECT_EQ(again.robots[0].trajectory.turning, Turning::shortest);
  EXPECT_EQ(check(load(again)).t, check(loaded).t);
}

TEST_F(RobotQuestions, WarnOfRecordingsThatWrapAndUnwrapThem) {
  std::string text = "time,turn\n";
  for (int k = 0; k <= 100; ++k) {
    text += std::to_string(0.1 * k) + "," +
            std::to_string(std::remainder(2.5 + 0.02 * k, 2.0 * kHalfTurn)) + "\n";
  }
  RobotQuestion asked = along("recorded.csv", text);
  asked.environment = {folder_ / "before.json"};
  EXPECT_EQ(check(asked).verdict, Verdict::contact) << "the jump sweeps through the front";
  const std::vector<std::string> told = warnings(asked, "--unwrap");
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("joint \"turn\" jumps by a whole turn"), std::string::npos) << told[0];
  EXPECT_NE(told[0].find("at 3.3 s"), std::string::npos) << told[0];
  asked.unwrap = true;
  EXPECT_EQ(check(asked).verdict, Verdict::free);
  EXPECT_TRUE(warnings(asked, "unwrap").empty());
  asked.trajectory.clear();
  EXPECT_THROW((void)read_robot_question(asked), std::invalid_argument);
}

TEST_F(RobotQuestions, LeaveOutPositionsOfFixedJointsWithOneWarning) {
  write("request.yaml",
        "start_state:\n  joint_state: {name: [turn, finger], position: [0.0, 0.4]}\n"
        "goal_constraints:\n- joint_constraints: [{joint_name: turn, position: 0.5}, {joint_name: "
        "finger, position: 0.4}]\n");
  RobotQuestion asked = question();
  asked.request = folder_ / "request.yaml";
  const std::string what =
      "a position is given for a fixed joint, finger; it is where the URDF has it";
  EXPECT_EQ(warnings(asked, "finger"),
            (std::vector<std::string>{(folder_ / "request.yaml").string() + ": " + what}));
  asked = between_states("before.json");
  asked.state = {"finger=0.4"};
  EXPECT_EQ(warnings(asked, "finger"), (std::vector<std::string>{"state: " + what}));
  asked.state = {"fingr=0.4"};
  EXPECT_THROW((void)read_robot_question(asked), std::invalid_argument);
}

TEST_F(RobotQuestions, RestWhereThePlanningSceneSaysIfNothingElseDoes) {
  write("around.yaml",
        "robot_state:\n  joint_state: {name: [turn, finger, gone], position: [1.0, 2.0, 3.0]}\n"
        "world: {}\n");
  RobotQuestion asked = question("around.yaml");
  EXPECT_EQ(read_robot_question(asked).robots[0].state, (JointPositions{{"turn", 1.0}}));
  EXPECT_EQ(warnings(asked, "gone").size(), 1u);
  EXPECT_EQ(warnings(asked, "finger").size(), 1u);
  EXPECT_TRUE(warnings(asked, "no position is given").empty());
  asked.state = {"turn=0.5"};
  EXPECT_EQ(read_robot_question(asked).robots[0].state, (JointPositions{{"turn", 0.5}}));
}

// MoveIt's `is_diff`: what a request leaves out is where the robot is.
TEST_F(RobotQuestions, BeginWhereThePlanningSceneHasTheRobot) {
  write("around.yaml", "robot_state:\n  joint_state: {name: [turn], position: [1.0]}\nworld: {}\n");
  write("request.yaml",
        "start_state: {is_diff: true}\ngoal_constraints:\n"
        "- joint_constraints: [{joint_name: turn, position: 0.5}]\n");
  RobotQuestion asked = question("around.yaml");
  asked.request = folder_ / "request.yaml";
  const Scene scene = read_robot_question(asked);
  EXPECT_EQ(scene.robots[0].trajectory.points.front().positions, std::vector<double>{1.0});
  EXPECT_EQ(scene.robots[0].trajectory.points.back().positions, std::vector<double>{0.5});
}

TEST_F(RobotQuestions, TakeQuaternionsOfZerosAsTheIdentity) {
  write("around.yaml",
        "world:\n  collision_objects:\n  - {id: wall, pose: {position: [0.8, 0, 0], orientation: "
        "{x: 0, y: 0, z: 0, w: 0}}, primitives: [{type: box, dimensions: [0.1, 0.1, 0.6]}]}\n");
  RobotQuestion asked = question("around.yaml");
  asked.start = {"turn=1"};
  asked.goal = {"turn=-1"};
  EXPECT_EQ(check(asked).verdict, Verdict::contact);
  EXPECT_EQ(warnings(asked, "zeros"),
            (std::vector<std::string>{
                (folder_ / "around.yaml").string() +
                ": a quaternion of zeros is taken as the identity, as MoveIt does: wall"}));
}

TEST_F(RobotQuestions, AreAskedInScenesByKeysOfTheRobot) {
  const auto scene = [&](const std::string& keys) {
    return parse_scene(
        R"({"firstcontact": 1, "robots": [{"name": "arm", "urdf": "arm.urdf", )" + keys + "}]}",
        folder_ / "s.json");
  };
  const std::string moves = R"("trajectory": {"joint_names": ["turn"], "points": [{"time": 0,
    "positions": [3]}, {"time": 1, "positions": [-3]}]})";
  EXPECT_EQ(scene(moves).robots[0].trajectory.turning, Turning::as_given);
  EXPECT_EQ(scene(moves + R"(, "turning": "long")").robots[0].trajectory.turning,
            Turning::as_given);
  EXPECT_EQ(scene(moves + R"(, "turning": "short")").robots[0].trajectory.turning,
            Turning::shortest);
  const Trajectory mended = scene(moves + R"(, "unwrap": true)").robots[0].trajectory;
  EXPECT_NEAR(mended.points[1].positions[0], 2.0 * kHalfTurn - 3.0, 1e-15);
  EXPECT_EQ(
      scene(moves + R"(, "state": {"finger": 1})").warnings,
      (std::vector<std::string>{"arm: state: a position is given for a fixed joint, finger; it "
                                "is where the URDF has it"}));
  EXPECT_THROW((void)scene(R"("turning": "short")"), ParseError) << "without a trajectory";
  EXPECT_THROW((void)scene(moves + R"(, "turning": "shortest")"), ParseError);
  EXPECT_THROW((void)scene(moves + R"(, "unwrap": 1)"), ParseError);
}

}  // namespace
}  // namespace firstcontact
