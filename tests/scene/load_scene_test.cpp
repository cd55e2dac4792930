#include <firstcontact/scene/loaded_scene.h>

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/check_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_text.h"

namespace firstcontact {
namespace {

class LoadedScenes : public testing::Test {
 protected:
  [[nodiscard]] LoadedScene load(const std::string& bodies, const std::string& robot,
                                 const std::string& more = "") const {
    const std::string robots =
        robot.empty() ? "" : R"(, "robots": [{"name": "arm", "urdf": "arm.urdf", )" + robot + "}]";
    return test::load_text(
        R"({"firstcontact": 1, "bodies": [)" + bodies + "]" + robots + more + "}",
        folder_.path() / "s.json");
  }

  test::ArmFolder folder_;
};

const std::string kBallAndBox =
    test::moving_ball("ball", "0.25", "[0, 0, 9]", "[0, 0, 2]") +
    R"(, {"name": "box", "shape": {"box": {"size": [1, 1, 1]}}, "pose": {"position": [8, 8, 8]}})";

// Bodies are the same ones beside a robot and without it.
TEST_F(LoadedScenes, HaveTheirBodiesInOrder) {
  for (const std::string& robot : {std::string(), std::string(R"("state": {"elbow": 0.5})")}) {
    const LoadedScene loaded = load(kBallAndBox, robot);
    EXPECT_EQ(loaded.robots == nullptr, robot.empty());
    EXPECT_EQ(shape_of_body(loaded, 0).radius(), 0.25);
    EXPECT_TRUE(shape_of_body(loaded, 1).is_solid());
    const Pose pose =
        loaded.robots ? loaded.robots->pose(0, 0.5) : loaded.bodies.motion(0).pose(0.5);
    EXPECT_EQ(pose.position, Eigen::Vector3d(0, 0, 10));
  }
}

TEST_F(LoadedScenes, HaveMarginsWithPaddings) {
  const std::string rules =
      R"(, "pairs": {"ignore": [["ball", "arm/bar"]], "margin": [["arm/tip", "box", 0.5]]},
         "options": {"margin": 0.25})";
  const LoadedScene loaded =
      load(kBallAndBox, R"("state": {"elbow": 0}, "padding": {"tip": 0.125})", rules);
  EXPECT_EQ(margin_of_pair(loaded, {0, 1}), 0.25);
  EXPECT_EQ(margin_of_pair(loaded, {0, 3}), std::nullopt);
  EXPECT_EQ(margin_of_pair(loaded, {1, 3}), 0.25);
  EXPECT_EQ(margin_of_pair(loaded, {1, 4}), 0.625);
  EXPECT_EQ(margin_of_pair(loaded, {3, 4}), std::nullopt);  // Welded.
  const LoadedScene alone = load(kBallAndBox, "", R"(, "options": {"margin": 0.25})");
  EXPECT_EQ(margin_of_pair(alone, {0, 1}), 0.25);
}

TEST_F(LoadedScenes, HoldBodiesByTheSecondsOfTheScene) {
  const LoadedScene loaded = load(kBallAndBox, R"("trajectory": "move.csv", "attached": [
      {"body": "ball", "link": "tip", "from_time": 1, "to_time": 3, "touch_links": ["bar"]},
      {"body": "box", "link": "bar"}])");
  ASSERT_EQ(loaded.robots->attachments().size(), 2u);
  const Attachment& ball = loaded.robots->attachments()[0];
  EXPECT_EQ(ball.body, 0u);
  EXPECT_EQ(ball.link, 4u);
  EXPECT_EQ(ball.touch_links, (std::vector<std::size_t>{3}));
  EXPECT_EQ(ball.t_from, 0.25);
  EXPECT_EQ(ball.t_to, 0.75);
  const Attachment& box = loaded.robots->attachments()[1];
  EXPECT_EQ(box.t_from, 0.0);
  EXPECT_EQ(box.t_to, 1.0);
}

TEST_F(LoadedScenes, WarnOfJointsThatNothingPlaces) {
  EXPECT_EQ(test::lines_of(load(kBallAndBox, R"("padding": 0)").warnings),
            "arm: no position is given for elbow: it rests at 0, or at the limit next to it\n");
  EXPECT_EQ(test::lines_of(load(kBallAndBox, R"("state": {"elbow": 1})").warnings), "");
}

TEST_F(LoadedScenes, WarnOfTrajectoriesThatBeginLate) {
  folder_.write("late.csv", "time,elbow\n1.5,0\n4,1\n");
  EXPECT_EQ(test::lines_of(load(kBallAndBox, R"("trajectory": "late.csv")").warnings),
            "arm: the trajectory begins at 1.5 s; until then the robot rests where it begins\n");
}

// From 0 to 2 rad in 1 s: beyond the limits of 1.5 rad and of 1 rad/s.
TEST_F(LoadedScenes, TellEveryLimitThatIsLeft) {
  folder_.write("fast.csv", "time,elbow\n0,0\n1,2\n");
  const LoadedScene loaded = load(kBallAndBox, R"("trajectory": "fast.csv")");
  const std::string upper =
      "arm: joint \"elbow\" leaves its upper limit of 1.5 rad by 0.5 rad at 1 s";
  const std::string speed =
      "arm: joint \"elbow\" leaves its velocity limit of 1 rad/s by 1 rad/s at ";
  ASSERT_EQ(loaded.warnings.size(), 2u);
  EXPECT_EQ(loaded.warnings[0], upper);
  EXPECT_EQ(loaded.warnings[1].substr(0, speed.size()), speed);
  ASSERT_EQ(loaded.limits.size(), 1u);
  EXPECT_EQ(loaded.limits[0].robot, 0u);
  EXPECT_EQ(test::message_of<std::invalid_argument>([&] { require_within_limits(loaded); }),
            "expected a motion within the joint limits, but " + upper + ", and 1 more");
  EXPECT_NO_THROW(require_within_limits(load(kBallAndBox, R"("state": {"elbow": 1})")));
}

TEST_F(LoadedScenes, DeformBesideRobots) {
  const std::string flag = test::body(
      "flag", R"("motion": {"type": "vertices", "to": [[0, 0, 4], [1, 0, 4], [0, 1, 5]]})");
  const LoadedScene loaded = load(flag, R"("state": {"elbow": 1})");
  EXPECT_EQ(shape_of_body(loaded, 0).vertices_to().size(), 3u);
  EXPECT_FALSE(loaded.robots->rests(0));
}

// One digest for all that was read: nothing can change without it.
TEST_F(LoadedScenes, AreNamedByAllTheirFiles) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  folder_.write("t.obj", triangle);
  const std::string mesh =
      R"(, {"name": "mesh", "shape": {"mesh": "t.obj"}, "pose": {"position": [0, 0, 50]}})";
  const std::string robot = R"("srdf": "arm.srdf", "trajectory": "move.csv")";
  const auto digest = [&](const std::string& more = "") {
    return load(kBallAndBox + mesh, robot, more).input_digest;
  };
  const std::string first = digest();
  EXPECT_EQ(digest(), first);
  std::set<std::string> digests{first, digest(R"(, "id": "other")")};
  folder_.write("t.obj", triangle + "\n");
  digests.insert(digest());
  folder_.write("move.csv", "time,elbow\n0,0\n4,1.9\n");
  digests.insert(digest());
  folder_.write("arm.srdf", R"(<robot name="arm"></robot>)");
  digests.insert(digest());
  EXPECT_EQ(digests.size(), 5u);
}

TEST_F(LoadedScenes, ReportEachFileOnce) {
  folder_.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto mesh = [](const std::string& name, const std::string& z) {
    return R"({"name": ")" + name +
           R"(", "shape": {"mesh": "t.obj"}, "pose": {"position": [0, 0, )" + z + "]}}";
  };
  const LoadedScene loaded = load(mesh("a", "50") + "," + mesh("b", "60"),
                                  R"("srdf": "arm.srdf", "trajectory": "move.csv")");
  std::multiset<std::string> names;
  for (const FileReport& report : loaded.files) {
    names.insert(std::filesystem::path(report.path).filename());
  }
  EXPECT_EQ(names, (std::multiset<std::string>{"arm.srdf", "arm.urdf", "move.csv", "t.obj"}));
}

TEST_F(LoadedScenes, WarnOfACheckWithDynamicsAndWithoutPairs) {
  const std::string free = test::body("a", R"("dynamics": {"mass": 1})");
  const std::string more = test::body("b", R"("dynamics": {"mass": 1})");
  const LoadedScene loaded =
      load(free + "," + more, R"("state": {"elbow": 0}, "dynamics": {"density": 1})");
  const std::string dynamics =
      " with \"dynamics\": at rest here; \"firstcontact simulate\" moves what has dynamics";
  EXPECT_EQ(check_warnings(loaded).back(), "\"a\" and 2 more" + dynamics);
  const std::vector<std::string> alone = check_warnings(load(free, ""));
  ASSERT_EQ(alone.size(), 2u);
  EXPECT_EQ(alone[0],
            "no pair is tested: this answer says nothing about contact; there is only one body");
  EXPECT_EQ(alone[1], "\"a\"" + dynamics);
}

TEST(AnswersEachPair, WhereThatIsAskedOrFollows) {
  const LoadedScene bodies = test::load_text(test::scene(test::body("a")));
  EXPECT_FALSE(answers_each_pair(bodies, {}));
  EXPECT_TRUE(answers_each_pair(bodies, {.all_pairs = true}));
  EXPECT_TRUE(answers_each_pair(bodies, {.closest = true}));
  EXPECT_TRUE(answers_each_pair(bodies, {.all_contacts_in_time = true}));
  const test::ArmFolder folder;
  const LoadedScene robots =
      test::load_text(R"({"firstcontact": 1, "robots": [{"name": "arm", "urdf": "arm.urdf"}]})",
                      folder.path() / "s.json");
  EXPECT_FALSE(answers_each_pair(robots, {.closest = true}));
  EXPECT_TRUE(answers_each_pair(robots, {.all_pairs = true}));
  EXPECT_TRUE(answers_each_pair(robots, {.all_contacts_in_time = true}));
}

}  // namespace
}  // namespace firstcontact
