#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/gap_curve.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/robot_question.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/robot_text.h"

namespace firstcontact {
namespace {

class RobotSceneFile : public testing::Test {
 protected:
  /// A ball of 0.1 m on the y axis, 1.05 m out: where the tip is after a quarter turn.
  static std::string with_ball(const std::string& robot, const std::string& more = "") {
    return R"({"firstcontact": 1, "bodies": [{"name": "ball", "shape": {"sphere": {"radius": 0.1}},
      "pose": {"position": [0, 1.05, 0]}}], "robots": [{"name": "arm", "urdf": "arm.urdf")" +
           robot + "}]" + more + "}";
  }

  Scene parse(const std::string& text) const {
    return parse_scene(text, folder_.path() / "s.json");
  }

  std::string error_of(const std::string& text) const {
    try {
      (void)parse(text);
    } catch (const ParseError& error) {
      std::string what = error.what();
      const std::string folder = folder_.path().string() + "/";
      for (std::size_t at = 0; (at = what.find(folder)) != std::string::npos;) {
        what.erase(at, folder.size());
      }
      return what;
    }
    return "accepted";
  }

  static LoadedScene load(Scene scene) {
    ShapeCache cache;
    return load_scene(std::move(scene), cache);
  }

  static SceneResult check(const LoadedScene& loaded, const CheckOptions& options = {}) {
    ManyBodiesWorkspace workspace;
    return check_scene(loaded, workspace, options);
  }

  test::ArmFolder folder_;
};

constexpr const char* kMove = R"(, "srdf": "arm.srdf", "trajectory": "move.csv")";

// Two balls of 0.1 m on a circle of 1.05 m touch where their angle is 2 asin(0.1 / 1.05). The tip
// turns at half a radian in a second.
const double kTouch = (std::numbers::pi / 2 - 2 * std::asin(0.1 / 1.05)) / 0.5;

TEST_F(RobotSceneFile, IsAnsweredInSecondsWithLinks) {
  const LoadedScene loaded = load(parse(with_ball(kMove)));
  EXPECT_EQ(loaded.scene.duration, 4.0);
  const SceneResult result = check(loaded);
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_NEAR(result.t * 4.0, kTouch, 1e-5);
  const std::string json = write_result(loaded, result);
  EXPECT_NE(json.find(R"("pair":["ball","arm/tip"])"), std::string::npos) << json;
  ASSERT_EQ(loaded.limits.size(), 1u);
  EXPECT_EQ(loaded.warnings.back(),
            "arm: joint \"elbow\" leaves its upper limit of 1.5 rad by 0.5 rad at 4 s");
}

TEST_F(RobotSceneFile, AnswersTheSameFromItsResolvedScene) {
  const LoadedScene loaded = load(parse(
      with_ball(std::string(kMove) + R"(, "padding": {"tip": 0.01}, "tracking_error": 0.02)",
                R"(, "pairs": {"margin": [["arm", "ball", 0.05], ["arm/tip", "ball", 0.03]]})")));
  const SceneResult result = check(loaded);
  EXPECT_LT(result.t * 4.0, kTouch - 0.05);
  const LoadedScene again = load(parse_scene(write_scene(loaded.scene), "elsewhere"));
  EXPECT_EQ(check(again).t, result.t);
  EXPECT_EQ(write_scene(again.scene), write_scene(loaded.scene));
}

TEST_F(RobotSceneFile, LetsTheLinkPrevailOverItsRobot) {
  const std::string rules =
      R"(, "pairs": {"margin": [["ball", "arm/tip", 0.03], ["arm", "ball", 0.05]]})";
  const Scene scene = parse(with_ball(kMove, rules));
  ASSERT_EQ(scene.pair_margins.size(), 3u);
  EXPECT_EQ(member_name(scene, 3), "arm/tip");
  for (const PairMargin& pair : scene.pair_margins) {
    EXPECT_EQ(pair.margin, pair.bodies[1] == 3 ? 0.03 : 0.05);
  }
}

TEST_F(RobotSceneFile, IgnoresPairsByRobotAndByLink) {
  EXPECT_EQ(
      check(load(parse(with_ball(kMove, R"(, "pairs": {"ignore": [["arm", "ball"]]})")))).verdict,
      Verdict::free);
  const SceneResult bar =
      check(load(parse(with_ball(kMove, R"(, "pairs": {"ignore": [["arm/tip", "ball"]]})"))));
  EXPECT_EQ(bar.verdict, Verdict::contact);
  EXPECT_GT(bar.t * 4.0, kTouch);
}

TEST_F(RobotSceneFile, CarriesAttachedBodies) {
  const std::string carried = std::string(kMove) +
                              R"(, "state": {}, "attached": [{"body": "ball", "link": "tip",
       "from_time": 1, "to_time": 4}])";
  const SceneResult result = check(load(parse(with_ball(carried))));
  EXPECT_EQ(result.verdict, Verdict::free);  // It is carried along before it is reached.
}

TEST_F(RobotSceneFile, FindsEveryContactInTime) {
  const SceneResult result = check(load(parse(with_ball(kMove))), {.all_contacts_in_time = true});
  double enter = 4.0;
  double leave = 0.0;
  for (const PairAnswer& pair : result.pairs) {
    for (const ContactInterval& interval : pair.intervals) {
      enter = std::min(enter, interval.enter * 4.0);
      leave = std::max(leave, interval.leave * 4.0);
    }
  }
  const double left = (std::numbers::pi / 2 + 2 * std::asin(0.1 / 1.05)) / 0.5;
  EXPECT_NEAR(enter, kTouch, 1e-5);
  EXPECT_NEAR(leave, left, 4e-3 + 1e-5);
}

/// A sheet whose middle is pulled into the arm's plane, and a link that cannot hold it.
TEST_F(RobotSceneFile, ChecksBodiesThatDeform) {
  const auto with_sheet = [](const std::string& robot) {
    return R"({"firstcontact": 1, "bodies": [{"name": "sheet", "shape": {"vertices": [[2, 0, 1],
      [-2, 2, 1], [-2, -2, 1], [0, 0, 1]], "triangles": [[0, 1, 3], [1, 2, 3], [2, 0, 3]]},
      "motion": {"type": "vertices", "to": [[2, 0, 1], [-2, 2, 1], [-2, -2, 1], [0, 0, -1]]}}],
      "robots": [{"name": "arm", "urdf": "arm.urdf")" +
           robot + "}]}";
  };
  const SceneResult result = check(load(parse(with_sheet(""))));
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_LE(result.t, 0.5);
  EXPECT_GT(result.t, 0.4);  // The arm is 0.1 thick at most.
  EXPECT_EQ(error_of(with_sheet(R"(, "attached": [{"body": "sheet", "link": "tip"}])")),
            "s.json:4: robots[0].attached[0].body: expected a rigid body, got one that deforms: "
            "its motion is \"vertices\"");
}

TEST_F(RobotSceneFile, SaysWhatIsWrong) {
  EXPECT_EQ(error_of(with_ball(R"(, "trajectori": 1)")),
            "s.json:2: robots[0].trajectori: unknown key; did you mean \"trajectory\"?");
  EXPECT_EQ(error_of(with_ball(R"(, "trajectory": "none.csv")")),
            "s.json:2: robots[0].trajectory: expected a trajectory file, found none at "
            "\"none.csv\"");
  EXPECT_EQ(error_of(with_ball(R"(, "trajectory": {"joint_names": ["elbov"], "points": []})")),
            "s.json:2: robots[0].trajectory.joint_names[0]: expected a joint of the robot, got "
            "\"elbov\"; did you mean \"elbow\"?");
  EXPECT_EQ(error_of(with_ball(R"(, "srdf": "arm.srdf", "state": "haf")")),
            "s.json:2: robots[0].state: expected a state of the SRDF, got \"haf\"; it has "
            "\"all/half\"");
  EXPECT_EQ(error_of(with_ball(R"(, "padding": {"tipp": 1})")),
            "s.json:2: robots[0].padding.tipp: expected a link of the robot, got \"tipp\"; did "
            "you mean \"tip\"?");
  EXPECT_EQ(error_of(with_ball(R"(, "tracking_error": {"weld": 1})")),
            "s.json:2: robots[0].tracking_error.weld: expected the name of a joint that moves by "
            "itself, got \"weld\"");
  EXPECT_EQ(error_of(with_ball(R"(, "attached": [{"body": "bell", "link": "tip"}])")),
            "s.json:2: robots[0].attached[0].body: expected the name of a body, got \"bell\"; did "
            "you mean \"ball\"?");
  EXPECT_EQ(error_of(with_ball(R"(, "trajectory": "move.csv", "attached": [{"body": "ball",
            "link": "tip", "from_time": 5}])")),
            "s.json:2: robots[0].attached: expected times within the scene's duration, 4 s");
  EXPECT_EQ(
      error_of(with_ball("", R"(, "pairs": {"ignore": [["arm/tpi", "ball"]]})")),
      "s.json:2: pairs.ignore[0][0]: expected the name of a body or robot, or robot/link, got "
      "\"arm/tpi\"; did you mean \"arm/tip\"?");
  EXPECT_EQ(error_of(with_ball(kMove, R"(, "options": {"duration": 3})")),
            "s.json:2: options.duration: expected 4, the last time of the waypoints and "
            "trajectories (or no \"duration\" at all), got 3");
  EXPECT_EQ(error_of(R"({"firstcontact": 1, "robots": []})"),
            "s.json:1: robots: expected at least one body or robot, got none");
}

TEST_F(RobotSceneFile, RefusesToKeepHalfWithinTrackingErrors) {
  const std::string options = R"(, "options": {"start_contacts": "keep_half"})";
  EXPECT_EQ(check(load(parse(with_ball(kMove, options)))).verdict, Verdict::contact);
  const LoadedScene loose =
      load(parse(with_ball(std::string(kMove) + R"(, "tracking_error": 0.02)", options)));
  EXPECT_THROW((void)check(loose), std::invalid_argument);
}

TEST_F(RobotSceneFile, ListsFeaturesWithinTheBand) {
  const auto count = [&](const std::string& options) {
    return check(load(parse(with_ball(kMove, options)))).pairs.at(0).contact_count.at_least;
  };
  // The tip is a ball at the end of the bar: one feature pair, and no more within a small band.
  EXPECT_EQ(count(R"(, "options": {"contact_band": 1e-3})"), count(""));
  EXPECT_GE(count(R"(, "options": {"contact_band": 1})"), 1u);
}

TEST_F(RobotSceneFile, IsPutTogetherFromAQuestion) {
  folder_.write("room.yaml", R"(world: {collision_objects: [{id: ball,
    primitives: [{type: sphere, dimensions: [0.1]}], primitive_poses: [{position: [0, 1.05, 0]}]}]})");
  RobotQuestion question{.robot = {.urdf = folder_.path() / "arm.urdf"}};
  question.trajectory = folder_.path() / "move.csv";
  question.environment = {folder_.path() / "room.yaml"};
  const SceneResult result = check(load(read_robot_question(question)));
  EXPECT_NEAR(result.t * 4.0, kTouch, 1e-5);

  folder_.write("room.yaml", R"({allowed_collision_matrix: {default_entry_names: [ball],
    default_entry_values: [true]}, world: {collision_objects: [{id: ball,
    primitives: [{type: sphere, dimensions: [0.1]}], primitive_poses: [{position: [0, 1.05, 0]}]}]}})");
  EXPECT_EQ(check(load(read_robot_question(question))).verdict, Verdict::free);

  folder_.write("room.json", R"({"firstcontact": 1, "bodies": [{"name": "ball",
    "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 1.05, 0]}}]})");
  question.environment = {folder_.path() / "room.json"};
  EXPECT_EQ(check(load(read_robot_question(question))).t, result.t);

  question.srdf = folder_.path() / "arm.srdf";
  question.goal = {"half"};
  EXPECT_THROW((void)read_robot_question(question), std::invalid_argument);
  question.trajectory.clear();
  question.start = {"elbow=0.25"};
  const Scene scene = read_robot_question(question);
  EXPECT_EQ(scene.robots[0].trajectory.points[0].positions[0], 0.25);
  EXPECT_EQ(scene.robots[0].trajectory.points[1].positions[0], 0.5);
  EXPECT_NEAR(scene.duration, 0.25, 1e-9);
}

TEST_F(RobotSceneFile, HasAGapAndAProvenBoundOfIt) {
  const LoadedScene loaded = load(parse(with_ball(kMove, R"(, "options": {"margin": 0.05})")));
  const SceneResult result = check(loaded);
  ASSERT_EQ(result.verdict, Verdict::contact);
  const std::vector<GapSample> curve = gap_curve(loaded, time_of_interest(result));
  ASSERT_GT(curve.size(), 129u);
  const std::vector<GapPoint> bound = gap_lower_bound(loaded, result, curve);
  EXPECT_EQ(bound.front().t, 0.0);
  EXPECT_EQ(bound.back().t, 1.0);
  for (const GapPoint& point : bound) {
    EXPECT_EQ(point.distance, point.t <= result.t ? 0.05 : 0.0) << point.t;
  }
  for (const GapSample& sample : curve) {
    EXPECT_EQ(sample.contact, sample.distance <= 0.05) << sample.t;
    EXPECT_GE(sample.distance, sample.t <= result.t ? 0.05 : 0.0) << sample.t;
  }
}

TEST_F(RobotSceneFile, IsLookedAtWhereItComesClosest) {
  const LoadedScene loaded = load(read_robot_question(
      {.robot = {.urdf = folder_.path() / "arm.urdf"}, .start = {"elbow=1"}, .goal = {"elbow=0"}}));
  const SceneResult result = check(loaded, {.closest = true});
  EXPECT_EQ(time_of_interest(result), result.t);  // No pair is tested.
  const LoadedScene turning = load(parse(with_ball(
      R"(, "trajectory": {"joint_names": ["elbow"], "points": [{"time": 0, "positions": [0.5]},
         {"time": 1, "positions": [1]}, {"time": 4, "positions": [0]}]})")));
  EXPECT_NEAR(time_of_interest(check(turning, {.closest = true})), 0.25, 1e-4);
}

// Links have greater numbers after it, and every rule goes on to mean the same.
TEST_F(RobotSceneFile, TakesABodyMoreWithoutChangingItsRules) {
  Scene scene = parse(with_ball(
      R"(, "attached": [{"body": "ball", "link": "tip"}])",
      R"(, "pairs": {"groups": {"all": ["ball", "arm/tip"]}, "ignore": [["ball", "arm/bar"]],
                     "margin": [["ball", "arm/tip", 0.5], ["all", "all", 0.25]]})"));
  add_body(scene, {.name = "post", .shape = {.source = make_sphere(0.25)}, .motion = {}});
  const auto name = [&](std::size_t member) { return member_name(scene, member); };
  EXPECT_EQ(name(scene.ignored_pairs.at(0)[0]) + name(scene.ignored_pairs.at(0)[1]), "ballarm/bar");
  EXPECT_EQ(name(scene.pair_margins.at(0).bodies[1]), "arm/tip");
  EXPECT_EQ(name(scene.groups.at(0).bodies[1]), "arm/tip");
  EXPECT_EQ(members_named(scene, "arm"), (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_EQ(members_named(scene, "all"), (std::vector<std::size_t>{0, 4}));
  EXPECT_THROW((void)members_named(scene, "arm/tap"), std::invalid_argument);
  const LoadedScene loaded = load(scene);
  EXPECT_EQ(loaded.robots->geometries(1)[0].shape.radius(), 0.25);
}

// Where the link holds it counts, whatever the body's own pose says; so it does after writing.
TEST_F(RobotSceneFile, HoldsBodiesWhereTheLinkHasThem) {
  const Scene scene = parse(with_ball(std::string(kMove) + R"(, "state": {},
      "attached": [{"body": "ball", "link": "tip", "pose": {"position": [0.5, 0, 0]}, "to_time": 2}])"));
  for (const Scene& said : {scene, parse(write_scene(scene))}) {
    const LoadedScene loaded = load(said);
    EXPECT_NEAR((loaded.robots->pose(0, 0.0).position - Eigen::Vector3d(1.55, 0, 0)).norm(), 0.0,
                1e-12);
    const Eigen::Vector3d put_down = 1.55 * Eigen::Vector3d(std::cos(1.0), std::sin(1.0), 0.0);
    EXPECT_NEAR((loaded.robots->pose(0, 1.0).position - put_down).norm(), 0.0, 1e-12);
  }
  EXPECT_EQ(error_of(with_ball(R"(, "attached": [{"body": "ball", "link": "tip", "pose": {},
                                      "from_time": 1}])")),
            "s.json:2: robots[0].attached[0].pose: expected no \"from_time\" beside \"pose\": the "
            "link holds it from the start");
}

TEST_F(RobotSceneFile, TakesWhatThePlanningSceneSaysOfLinks) {
  const std::string held = R"(
link_padding: [{link_name: tip, padding: 0.02}]
robot_state: {attached_collision_objects: [{link_name: tip, touch_links: [bar], object: {id: rod,
  header: {frame_id: tip}, primitives: [{type: sphere, dimensions: [0.1]}, {type: sphere, dimensions: [0.1]}],
  primitive_poses: [{position: [0.2, 0, 0]}, {position: [0.3, 0, 0]}]}}]}
)";
  const std::string wall = R"(
world: {collision_objects: [{id: wall, primitives: [{type: sphere, dimensions: [0.1]}],
  primitive_poses: [{position: [0, 1.35, 0]}]}]}
)";
  const std::string allowed =
      "allowed_collision_matrix: {entry_names: [rod, wall], entry_values: [[0, 1], [1, 0]]}\n";
  RobotQuestion question;
  question.robot.urdf = folder_.path() / "arm.urdf";
  question.trajectory = folder_.path() / "move.csv";
  question.environment = {folder_.path() / "room.yaml"};
  folder_.write("room.yaml", held + wall);
  const Scene scene = read_robot_question(question);
  EXPECT_EQ(scene.robots[0].padding, (std::map<std::size_t, double>{{2, 0.02}}));
  const LoadedScene loaded = load(scene);
  const SceneResult result = check(loaded);
  EXPECT_EQ(result.verdict, Verdict::contact);
  const PairAnswer& first = result.pairs[*result.first];
  EXPECT_EQ(loaded.robots->name(first.members[0]) + loaded.robots->name(first.members[1]),
            "wallrod/1");
  EXPECT_FALSE(loaded.robots->margin({1, 2}));  // The parts of the rod.
  folder_.write("room.yaml", allowed + held + wall);
  EXPECT_EQ(check(load(read_robot_question(question))).verdict, Verdict::free);
  folder_.write("room.yaml", "link_padding: [{link_name: tap, padding: 0.1}]\n" + wall);
  EXPECT_THROW((void)read_robot_question(question), ParseError);
}

}  // namespace
}  // namespace firstcontact
