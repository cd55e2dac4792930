// A robot is a tree of links, or an error that names the joint.

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/robot/robot_model.h>

namespace firstcontact {
namespace {

Joint turning(const std::string& name, const std::string& parent, const std::string& child) {
  return {.name = name, .type = JointType::continuous, .parent = parent, .child = child};
}

/// base - a - b, base - c.
RobotDescription fork() {
  return {
      .name = "fork",
      .links = {{"base", {}, {}}, {"a", {}, {}}, {"b", {}, {}}, {"c", {}, {}}},
      .joints = {turning("ja", "base", "a"), turning("jb", "a", "b"), turning("jc", "base", "c")}};
}

/// The message of the defect.
std::string defect_of(const RobotDescription& robot) {
  EXPECT_THROW(RobotModel{robot}, std::invalid_argument);
  const std::optional<RobotDefect> defect = find_defect(robot);
  return defect ? defect->message : "none";
}

TEST(RobotModel, KnowsItsTree) {
  const RobotModel robot(fork());
  EXPECT_EQ(robot.name(), "fork");
  EXPECT_EQ(robot.root(), 0u);
  EXPECT_EQ(robot.find_link("b"), 2u);
  EXPECT_EQ(robot.find_joint("jc"), 2u);
  EXPECT_FALSE(robot.find_link("d").has_value());
  EXPECT_EQ(robot.chain(0, 2), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(robot.chain(1, 2), (std::vector<std::size_t>{1}));
  EXPECT_TRUE(robot.chain(3, 3).empty());
  EXPECT_EQ(robot.last_common_ancestor(2, 3), 0u);
  EXPECT_EQ(robot.last_common_ancestor(1, 2), 1u);
  EXPECT_EQ(robot.last_common_ancestor(2, 2), 2u);
  EXPECT_TRUE(robot.are_adjacent(0, 1));
  EXPECT_TRUE(robot.are_adjacent(2, 1));
  EXPECT_FALSE(robot.are_adjacent(0, 2));
  EXPECT_FALSE(robot.parent_joint(0).has_value());
}

TEST(RobotModel, DoesNotMindTheOrderOfLinks) {
  RobotDescription robot = fork();
  std::swap(robot.links[0], robot.links[3]);
  std::swap(robot.joints[0], robot.joints[1]);
  const RobotModel model(robot);
  EXPECT_EQ(model.links()[model.root()].name, "base");
  EXPECT_EQ(model.chain(model.root(), *model.find_link("b")), (std::vector<std::size_t>{1, 0}));
}

TEST(RobotModel, RefusesALoopByItsJoint) {
  RobotDescription robot = fork();
  robot.joints[0].parent = "b";
  EXPECT_EQ(defect_of(robot), "joint 'ja' is part of a loop of links; remove a joint of the loop");
}

TEST(RobotModel, RefusesASecondParentByItsJoint) {
  RobotDescription robot = fork();
  robot.joints.push_back(turning("jd", "c", "b"));
  EXPECT_EQ(defect_of(robot),
            "joint 'jd': its child link 'b' already hangs on joint 'jb'; a link has one parent");
}

TEST(RobotModel, RefusesAnUnknownLinkByItsJoint) {
  RobotDescription robot = fork();
  robot.joints[1].parent = "nowhere";
  EXPECT_EQ(defect_of(robot), "joint 'jb': its parent link 'nowhere' is not a link of the robot");
}

TEST(RobotModel, RefusesASecondRoot) {
  RobotDescription robot = fork();
  robot.joints.pop_back();
  EXPECT_EQ(defect_of(robot), "links 'base' and 'c' both have no parent; connect them by a joint");
}

TEST(RobotModel, RefusesDoubledNames) {
  RobotDescription robot = fork();
  robot.links[3].name = "a";
  EXPECT_EQ(defect_of(robot), "two links are named 'a'; rename one of them");
  robot = fork();
  robot.joints[2].name = "ja";
  EXPECT_EQ(defect_of(robot), "two joints are named 'ja'; rename one of them");
}

TEST(RobotModel, RefusesNumbersWithoutSense) {
  RobotDescription robot = fork();
  robot.joints[0].axis.setZero();
  EXPECT_EQ(defect_of(robot), "joint 'ja': its axis must be finite and not zero");
  for (const double size : {1e-300, 1e100}) {
    robot.joints[0].axis = size * Eigen::Vector3d::UnitZ();
    EXPECT_EQ(defect_of(robot),
              "joint 'ja': its axis must be from 1e-60 to 1e60 in size; give it the length 1");
  }
  robot = fork();
  robot.joints[0].limits = {.lower = 1.0, .upper = -1.0};
  EXPECT_EQ(defect_of(robot), "joint 'ja': its lower limit is above its upper limit");
  robot = fork();
  robot.joints[0].limits.velocity = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(defect_of(robot), "joint 'ja': its velocity and effort limits must be finite and >= 0");
  robot = fork();
  robot.joints[1].X_PJ.position.x() = std::numeric_limits<double>::infinity();
  EXPECT_NE(defect_of(robot).find("joint 'jb': its origin must be finite"), std::string::npos);
  EXPECT_EQ(defect_of({.name = "none", .links = {}, .joints = {}}), "the robot has no link");
}

TEST(RobotModel, RefusesMimicsThatMeanNothing) {
  RobotDescription robot = fork();
  robot.joints[0].mimic = Mimic{.joint = "jx"};
  EXPECT_EQ(defect_of(robot), "joint 'ja': it mimics 'jx', which is not a joint of the robot");
  robot = fork();
  robot.joints[0].mimic = Mimic{.joint = "jb"};
  robot.joints[1].mimic = Mimic{.joint = "ja"};
  EXPECT_NE(defect_of(robot).find("it mimics itself, by way of other joints"), std::string::npos);
  robot = fork();
  robot.joints[0].mimic = Mimic{.joint = "ja"};
  EXPECT_EQ(defect_of(robot), "joint 'ja': it mimics itself; name another joint");
  robot = fork();
  robot.joints[0].mimic = Mimic{.joint = "jb"};
  robot.joints[1].type = JointType::planar;
  EXPECT_EQ(defect_of(robot), "joint 'ja': only joints of one coordinate mimic and are mimicked");
}

TEST(RobotModel, HasBallAndScrewJoints) {
  RobotDescription robot = fork();
  robot.joints[0].type = JointType::ball;
  robot.joints[1].type = JointType::screw;
  robot.joints[1].pitch = 0.002;
  const RobotModel model(robot);
  EXPECT_EQ(coordinate_count(model.joints()[0].type), 0u);
  EXPECT_EQ(coordinate_count(model.joints()[1].type), 1u);
  EXPECT_EQ(model.joints()[1].pitch, 0.002);
}

}  // namespace
}  // namespace firstcontact
