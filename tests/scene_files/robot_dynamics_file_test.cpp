// "dynamics" of a robot, and what a robot at rest needs.

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_scene.h>
#include <firstcontact/text/parse_error.h>

#include "scene/load_text.h"
#include "scene/robot_text.h"
#include "scene/scene_bits.h"

namespace firstcontact {
namespace {

class RobotDynamicsFile : public testing::Test {
 protected:
  RobotDynamicsFile() {
    folder_.write("hand.urdf", R"(<robot name="hand">
      <link name="palm"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
      <joint name="first" type="revolute"><parent link="palm"/><child link="a"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1" velocity="1" effort="2"/></joint>
      <joint name="second" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
        <limit lower="0" upper="1" velocity="1" effort="3"/></joint>
      <joint name="same" type="revolute"><parent link="a"/><child link="c"/><axis xyz="0 0 1"/>
        <limit lower="-9" upper="9" velocity="9" effort="1"/><mimic joint="first"/></joint>
      <joint name="plane" type="planar"><parent link="palm"/><child link="d"/><axis xyz="0 0 1"/></joint>
    </robot>)");
  }

  [[nodiscard]] Scene parse(const std::string& keys) const {
    return parse_scene(
        R"({"firstcontact": 1, "robots": [{"name": "r", "urdf": "hand.urdf")" + keys + "}]}",
        folder_.path() / "s.json");
  }

  [[nodiscard]] RobotDynamics dynamics(const std::string& inside,
                                       const std::string& keys = "") const {
    const Scene scene = parse(keys + R"(, "dynamics": {)" + inside + "}");
    const Scene again = parse_scene(write_scene(scene), "/nowhere/s.json");
    EXPECT_EQ(test::SceneBits(again), test::SceneBits(scene)) << inside;
    return scene.robots.at(0).dynamics.value();
  }

  [[nodiscard]] JointMotor motor(const std::string& inside) const {
    return dynamics(R"("motors": {"first": {)" + inside + "}}").motors.at(0);
  }

  /// The message about a robot of these keys, from its place in the robot on.
  [[nodiscard]] std::string said(const std::string& keys) const {
    const std::string place = (folder_.path() / "s.json").string() + ":1: robots[0]";
    const std::string text = test::message_of<ParseError>([&] { (void)parse(keys); });
    return text.starts_with(place) ? text.substr(place.size()) : text;
  }

  [[nodiscard]] std::string said_of_dynamics(const std::string& inside) const {
    const std::string text = said(R"(, "dynamics": )" + inside);
    return text.starts_with(".dynamics") ? text.substr(9) : text;
  }

  test::ArmFolder folder_;
};

constexpr const char* kFirstMoves = R"(, "trajectory": {"joint_names": ["first"], "points": [
    {"time": 0, "positions": [0]}, {"time": 2, "positions": [1]}]})";

TEST_F(RobotDynamicsFile, AreHeldAndDrivenByNothingUnlessAsked) {
  const RobotDynamics plain = dynamics("");
  EXPECT_FALSE(plain.has_free_base);
  EXPECT_TRUE(plain.linear_velocity.isZero(0.0));
  EXPECT_TRUE(plain.velocities.empty());
  EXPECT_TRUE(plain.motors.empty());
  EXPECT_FALSE(plain.density);
  EXPECT_FALSE(plain.surface.friction);
  EXPECT_FALSE(plain.surface.restitution);
  EXPECT_TRUE(parse(R"(, "dynamics": {})").simulation.has_value());
}

TEST_F(RobotDynamicsFile, TakeEveryKey) {
  const RobotDynamics all = dynamics(
      R"("base": "free", "linear_velocity": [1, 2, 3], "angular_velocity": [4, 5, 6],
         "velocities": {"first": -0.5, "plane/theta": 7}, "density": 800, "friction": 0.25,
         "restitution": 1)");
  EXPECT_TRUE(all.has_free_base);
  EXPECT_EQ(all.linear_velocity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(all.angular_velocity, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(all.velocities.at("first"), -0.5);
  EXPECT_EQ(all.velocities.at("plane/theta"), 7.0);
  EXPECT_EQ(all.density, 800.0);
  EXPECT_EQ(all.surface.friction, 0.25);
  EXPECT_EQ(all.surface.restitution, 1.0);
}

TEST_F(RobotDynamicsFile, TakeMotorsOfEveryKind) {
  const JointMotor spring =
      motor(R"("position": 0.5, "stiffness": 100, "damping": 3, "effort": 0)");
  EXPECT_EQ(spring.kind, JointMotor::Kind::position);
  ASSERT_EQ(spring.target.size(), 1u);
  EXPECT_EQ(spring.target[0].time, 0.0);
  EXPECT_EQ(spring.target[0].number, 0.5);
  EXPECT_EQ(spring.stiffness, 100.0);
  EXPECT_EQ(spring.damping, 3.0);
  EXPECT_EQ(spring.effort, 0.0);
  const JointMotor velocity = motor(R"("velocity": [[0, 0], [0.5, -1], [2, 1e300]])");
  EXPECT_EQ(velocity.kind, JointMotor::Kind::velocity);
  ASSERT_EQ(velocity.target.size(), 3u);
  EXPECT_EQ(velocity.target[1].time, 0.5);
  EXPECT_EQ(velocity.target[2].number, 1e300);
  EXPECT_EQ(velocity.effort, std::nullopt);  // That of the model.
  EXPECT_EQ(motor(R"("torque": -4)").kind, JointMotor::Kind::torque);
  const RobotDynamics along =
      dynamics(R"("motors": {"first": {"position": "trajectory"}})", kFirstMoves);
  EXPECT_TRUE(along.motors.at(0).target.empty());
}

// "*" stands for all joints of one coordinate that follow no other and are not named.
TEST_F(RobotDynamicsFile, GiveAMotorToAllOthers) {
  const auto motors =
      dynamics(R"("motors": {"*": {"velocity": 2}, "second": {"torque": 1}})").motors;
  ASSERT_EQ(motors.size(), 2u);
  EXPECT_EQ(motors.at(0).kind, JointMotor::Kind::velocity);
  EXPECT_EQ(motors.at(1).kind, JointMotor::Kind::torque);
}

TEST_F(RobotDynamicsFile, SayWhatIsWrong) {
  const std::string free = "expected \"base\": \"free\" beside the velocity of the base";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"7",
       ": expected an object with \"base\", \"linear_velocity\", \"angular_velocity\", "
       "\"velocities\", \"motors\", \"density\", \"friction\", \"restitution\", got 7"},
      {R"({"mass": 1})", ".mass: unknown key; did you mean \"base\"?"},
      {R"({"base": "floating"})",
       ".base: unknown word \"floating\"; known are \"fixed\", \"free\""},
      {R"({"linear_velocity": [0, 0, 0]})", ".linear_velocity: " + free},
      {R"({"base": "fixed", "angular_velocity": [0, 0, 1]})", ".angular_velocity: " + free},
      {R"({"base": "free", "linear_velocity": [0, 0, 1e61]})",
       ".linear_velocity[2]: expected a number of at most 1e60 in size, got 1e+61"},
      {R"({"density": 0})", ".density: expected a number > 0, got 0"},
      {R"({"friction": -0.5})", ".friction: expected a number >= 0, got -0.5"},
      {R"({"restitution": 1.0000000000000002})",
       ".restitution: expected a number from 0 to 1, got 1.0000000000000002"},
      {R"({"velocities": [1]})",
       ".velocities: expected velocities by joint, such as {\"elbow\": 0.5}, got an array of 1"},
      {R"({"velocities": {"first": "fast"}})",
       ".velocities.first: expected a number, got \"fast\""},
      {R"({"motors": null})",
       ".motors: expected motors by joint, such as {\"elbow\": {\"position\": 0.5}}, got null"}};
  for (const auto& [inside, message] : cases) {
    EXPECT_EQ(said_of_dynamics(inside), message) << inside;
  }
  EXPECT_EQ(said(R"(, "base_motion": {"type": "fixed"}, "dynamics": {})"),
            ".base_motion: expected \"base\" beside \"dynamics\": where the robot starts from");
}

TEST_F(RobotDynamicsFile, NameJointsThatHaveNoVelocityOrMotor) {
  const std::string one = "expected a joint of one coordinate that mimics no other, got ";
  const std::string motor = R"(": {"torque": 0}}})";
  EXPECT_EQ(said_of_dynamics(R"({"motors": {"same)" + motor), ".motors.same: " + one + "\"same\"");
  EXPECT_EQ(said_of_dynamics(R"({"motors": {"plane/x)" + motor),
            ".motors[\"plane/x\"]: " + one + "\"plane/x\"");
  const std::string unknown = said_of_dynamics(R"({"motors": {"frist)" + motor);
  EXPECT_NE(unknown.find("\"frist\"; did you mean \"first\"?"), std::string::npos) << unknown;
  const std::string none = said_of_dynamics(R"({"velocities": {"plane": 1}})");
  EXPECT_NE(none.find("NAME/x, NAME/y or NAME/theta"), std::string::npos) << none;
}

TEST_F(RobotDynamicsFile, SayWhatIsWrongWithMotors) {
  const std::string pairs =
      "expected a number, or [time, number] pairs such as [[0, 0], [1, 0.5]], got ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", ": expected \"position\", \"velocity\" or \"torque\", got none"},
      {R"("effort": 1)", ": expected \"position\", \"velocity\" or \"torque\", got none"},
      {R"("position": 1, "torque": 1)",
       ".torque: expected one of \"position\", \"velocity\", \"torque\", got two"},
      {R"("positon": 1)", ".positon: unknown key; did you mean \"position\"?"},
      {R"("velocity": [])", ".velocity: " + pairs + "an array of 0"},
      {R"("velocity": true)", ".velocity: " + pairs + "true"},
      {R"("velocity": [[0, 1, 2]])", ".velocity[0]: " + pairs + "an array of 3"},
      {R"("velocity": [0, 1])", ".velocity[0]: " + pairs + "0"},
      {R"("velocity": [[-1, 0]])", ".velocity[0][0]: expected a number >= 0, got -1"},
      {R"("velocity": [[0, 0], [0, 1]])", ".velocity[1][0]: expected times that increase, got 0"},
      {R"("velocity": "trajectory")",
       ".velocity: expected a number, or [time, number] pairs, got \"trajectory\""},
      {R"("position": "trajetory")",
       ".position: expected a position, [time, position] pairs, or \"trajectory\", got "
       "\"trajetory\""},
      {R"("position": "trajectory")",
       ".position: expected a robot with a \"trajectory\" that names \"first\""},
      {R"("torque": 1, "stiffness": 1)",
       ".stiffness: expected \"stiffness\" of a \"position\" only"},
      {R"("position": 1, "stiffness": 0)", ".stiffness: expected a number > 0, got 0"},
      {R"("position": 1, "damping": 1)",
       ".damping: expected \"damping\" beside a \"stiffness\" only"},
      {R"("position": 1, "stiffness": 1, "damping": -1)",
       ".damping: expected a number >= 0, got -1"},
      {R"("torque": 1, "effort": -1)", ".effort: expected a number >= 0, got -1"}};
  for (const auto& [inside, message] : cases) {
    EXPECT_EQ(said_of_dynamics(R"({"motors": {"first": {)" + inside + "}}}"),
              ".motors.first" + message)
        << inside;
    EXPECT_EQ(said_of_dynamics(R"({"motors": {"*": {)" + inside + "}}}"),
              ".motors[\"*\"]" + message)
        << inside;
  }
}

// Nothing says where the joint is: it rests at its limit, where no certificate could be had.
TEST_F(RobotDynamicsFile, RefuseRestBeyondWhatMotionsTake) {
  folder_.write("far.urdf", R"(<robot name="far"><link name="a"/><link name="b"/>
      <joint name="slide" type="prismatic"><parent link="a"/><child link="b"/>
        <limit lower="2e8" upper="3e8" velocity="1" effort="1"/></joint></robot>)");
  const auto said_of = [&](const std::string& keys) {
    return test::message_of<ParseError>([&] {
      (void)parse_scene(
          R"({"firstcontact": 1, "robots": [{"name": "r", "urdf": "far.urdf")" + keys + "}]}",
          folder_.path() / "s.json");
    });
  };
  const std::string place = (folder_.path() / "s.json").string() + ":1: robots[0]";
  const std::string message =
      "joint \"slide\": CoordinatePath: position must be finite and at most 1e8 in size";
  EXPECT_EQ(said_of(""), place + ": " + message);
  EXPECT_EQ(said_of(R"(, "state": {})"), place + ".state: " + message);
  EXPECT_EQ(said_of(R"(, "state": {"slide": 1})"), "accepted");
}

}  // namespace
}  // namespace firstcontact
