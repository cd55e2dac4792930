#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/record/read_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/text/parse_error.h>

#include "simulation/simulated_run.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::body;
using test::box;
using test::run;
using test::verify;

/// A folder with the URDF files of a test.
class SimulateRobots : public testing::Test {
 protected:
  SimulateRobots()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("firstcontact_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~SimulateRobots() override { std::filesystem::remove_all(folder_); }

  /// The text of a scene with one robot.
  std::string scene(const std::string& urdf, const std::string& robot, const std::string& bodies,
                    const std::string& simulation) const {
    std::ofstream(folder_ / "robot.urdf") << urdf;
    return R"({"firstcontact": 1, "bodies": [)" + bodies +
           R"(], "robots": [{"name": "r", "urdf": ")" + (folder_ / "robot.urdf").string() +
           R"(", )" + robot + R"(}], "simulation": {)" + simulation + "}}";
  }

  static LoadedScene load(const std::string& text) {
    ShapeCache cache;
    return load_scene(parse_scene(text, "test.json"), cache);
  }

  static Simulator simulator(const std::string& text) { return Simulator(load(text)); }

 private:
  std::filesystem::path folder_;
};

std::string link(const std::string& name, double mass, const std::string& centre,
                 const std::string& geometry) {
  const std::string origin = R"(<origin xyz=")" + centre + R"("/>)";
  const std::string m = std::to_string(mass);
  const std::string moment = std::to_string(0.001 * mass);
  return "<link name=\"" + name + "\"><inertial>" + origin + "<mass value=\"" + m +
         "\"/><inertia ixx=\"" + moment + "\" iyy=\"" + moment + "\" izz=\"" + moment +
         "\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>" +
         (geometry.empty()
              ? ""
              : "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>") +
         "</link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& axis, const std::string& origin,
                  const std::string& more = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><axis xyz=\"" + axis + "\"/><origin xyz=\"" + origin +
         "\"/>" + more + "</joint>";
}

std::string robot_of(const std::string& inside) {
  return "<robot name=\"r\">" + inside + "</robot>";
}

/// A rod of 0.5 m that hangs from the origin and swings about y.
const std::string kPendulum = robot_of(
    "<link name=\"base\"/>" + link("rod", 1.0, "0 0 -0.25", "<box size=\"0.02 0.02 0.5\"/>") +
    joint("hinge", "continuous", "base", "rod", "0 1 0", "0 0 0"));

constexpr double kWeight = 9.81 * 0.25;                // [N m]  Of the rod at right angles.
constexpr double kMoment = 0.001 + 1.0 * 0.25 * 0.25;  // [kg m^2]  About the hinge.

double energy(const RunStep& step) { return step.kinetic_energy + step.potential_energy; }

TEST_F(SimulateRobots, RestAtHalfOfTheDistanceOfBodies) {
  const auto distance = [&](const std::string& bodies) {
    return simulator(scene(kPendulum, R"("dynamics": {"base": "fixed"})", bodies, ""))
        .header()
        .scene.simulation->contact_distance.value();
  };
  const double reach = std::sqrt(0.25 * 0.25 + 2 * 0.01 * 0.01);  // [m]  Of the rod.
  EXPECT_NEAR(distance(""), 5e-4 * reach, 1e-12);
  // A free body decides where there is one, also a larger one.
  EXPECT_NEAR(distance(body("a", box("[2, 2, 2]"), "[0, 0, 9]", R"(, "dynamics": {})")),
              1e-3 * std::sqrt(3.0), 1e-12);
}

// As exactly with many links as with few.
TEST_F(SimulateRobots, LongArmFollowsItsMotors) {
  constexpr int kJoints = 8;
  std::string urdf = "<robot name=\"arm\">" + link("link 0", 5.0, "0 0 0", "");
  for (int k = 1; k <= kJoints; ++k) {
    const std::string name = "link " + std::to_string(k);
    urdf += link(name, 1.0 + k % 3, "0.15 0 0", R"(<box size="0.2 0.05 0.05"/>)");
    urdf += joint("joint " + std::to_string(k), "continuous", "link " + std::to_string(k - 1), name,
                  k % 2 == 1 ? "0 1 0" : "0 0 1", k == 1 ? "0 0 0" : "0.3 0 0");
  }
  Simulator s = simulator(
      scene(urdf + "</robot>", R"("dynamics": {"base": "fixed", "motors": {"*": {"velocity": 1}}})",
            "", R"("step": 0.005)"));
  run(s, 10);
  for (const double velocity : s.robot_states()[0].velocities) {
    EXPECT_NEAR(velocity, 1.0, 2e-3);  // But for how they are carried along.
  }
}

TEST_F(SimulateRobots, APendulumKeepsItsEnergyAndItsLinksTogether) {
  const std::string text =
      scene(kPendulum, R"("state": {"hinge": 1.5}, "dynamics": {})", "", R"("step": 0.005)");
  Simulator s = simulator(text);
  const auto steps = run(s, 400);
  for (const RunStep& step : steps) {
    ASSERT_NEAR(energy(step), energy(steps[0]), 1e-7);
    // The recorded link is where its joint has it.
    const double q = step.robots[0].positions[0];
    const Vector3d centre = 0.25 * Vector3d(-std::sin(q), 0.0, -std::cos(q));
    ASSERT_LE((step.bodies[0].X_WB.position - centre).norm(), 1e-12) << step.index;
    ASSERT_NEAR(step.bodies[0].angular_velocity.y(), step.robots[0].velocities[0], 1e-12);
  }
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
}

TEST_F(SimulateRobots, APendulumStopsAtAWallOrBouncesBack) {
  const std::string wall = body("wall", box("[0.2, 1, 1]"), "[-0.05, 0, -0.7]");
  for (const double restitution : {0.0, 1.0}) {
    Simulator s = simulator(
        scene(kPendulum, R"("state": {"hinge": -1.2}, "dynamics": {})", wall,
              R"("step": 0.005, "friction": 0, "restitution": )" + std::to_string(restitution)));
    const auto steps = run(s, 400);
    EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
    for (const RunStep& step : steps) {
      ASSERT_EQ(step.time_lost, 0.0);
      ASSERT_LE(step.robots[0].positions[0], 0.0);
    }
    if (restitution == 0.0) {
      EXPECT_NEAR(steps.back().robots[0].velocities[0], 0.0, 1e-6);
    } else {
      EXPECT_NEAR(energy(steps.back()), energy(steps.front()), 1e-3);
    }
  }
}

TEST_F(SimulateRobots, AMotorHoldsAWeightAsFarAsItsEffortGoes) {
  const auto angle_after = [&](const std::string& motor) {
    Simulator s = simulator(scene(kPendulum,
                                  R"("state": {"hinge": -1.5707963267948966}, "dynamics": )"
                                  R"({"motors": {"hinge": )" +
                                      motor + "}}",
                                  "", R"("step": 0.01)"));
    return run(s, 50).back().robots[0];
  };
  // Without a bound it stays; with too little effort it falls with what is left of its weight.
  EXPECT_NEAR(angle_after(R"({"position": -1.5707963267948966})").positions[0],
              -std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(angle_after(R"({"position": -1.5707963267948966, "effort": 2.46})").positions[0],
              -std::numbers::pi / 2, 1e-9);
  EXPECT_GT(angle_after(R"({"position": -1.5707963267948966, "effort": 2.0})").positions[0], -1.4);
  EXPECT_NEAR(angle_after(R"({"velocity": 1.5})").velocities[0], 1.5, 1e-7);
  // A spring rests where it carries the weight.
  const RunRobot hung = [&] {
    Simulator s = simulator(scene(kPendulum,
                                  R"("state": {"hinge": -1.57}, "dynamics": {"motors": {"hinge": )"
                                  R"({"position": -1.57, "stiffness": 20, "damping": 3}}})",
                                  "", R"("step": 0.01)"));
    return run(s, 500).back().robots[0];
  }();
  const double q = hung.positions[0];
  EXPECT_NEAR(20.0 * (-1.57 - q), kWeight * std::sin(q), 1e-6);
}

TEST_F(SimulateRobots, ATorqueAcceleratesByTheMoment) {
  Simulator s = simulator(
      scene(kPendulum, R"("dynamics": {"motors": {"hinge": {"torque": [[0, 0], [1, 2]]}}})", "",
            R"("step": 0.001, "gravity": [0, 0, 0])"));
  // Its mean is 1 N m over the first second.
  EXPECT_NEAR(run(s, 1000).back().robots[0].velocities[0], 1.0 / kMoment, 1e-6 / kMoment);
}

// A step in which a link turns by a multiple of the longest plan leaves no rest of a plan whose
// length is rounding.
TEST_F(SimulateRobots, AWheelFollowsARampWhoseStepsAreWholePlans) {
  const std::string wheel = robot_of(
      "<link name=\"base\"/>" + link("wheel", 1.0, "0 0 0", "<box size=\"0.2 0.1 0.1\"/>") +
      joint("axle", "continuous", "base", "wheel", "0 0 1", "0 0 0"));
  for (const double rate : {10.0, 12.0, 20.0, 30.0, 40.0}) {
    const std::string target = "[[0, 0], [1, " + std::to_string(rate) + "]]";
    Simulator s =
        simulator(scene(wheel, R"("dynamics": {"motors": {"axle": {"position": )" + target + "}}}",
                        "", R"("step": 0.01, "gravity": [0, 0, 0])"));
    const std::vector<RunStep> steps = run(s, 50);
    for (std::size_t k = 1; k < steps.size(); ++k) {
      ASSERT_NEAR(steps[k].robots[0].velocities[0], rate, 1e-9 * rate) << k;
      ASSERT_NEAR(steps[k].robots[0].efforts[0], 0.0, 1e-9) << k;
    }
  }
}

/// Two carts on one rail; the second one goes 0.1 m - 2 times the way of the first.
std::string carts(const std::string& of_first, const std::string& of_second) {
  return robot_of("<link name=\"base\"/>" + link("a", 1.0, "0 0 0", "") +
                  link("b", 3.0, "0 0 0", "") +
                  joint("x1", "prismatic", "base", "a", "1 0 0", "0 0 0", of_first) +
                  joint("x2", "prismatic", "base", "b", "1 0 0", "0 0 0",
                        of_second + R"(<mimic joint="x1" multiplier="-2" offset="0.1"/>)"));
}

constexpr double kMassOfCarts = 1.0 + 4.0 * 3.0;  // [kg]  Along the first one's coordinate.

// A joint that mimics has limits, damping and friction of its own.
TEST_F(SimulateRobots, JointsThatMimicActOnTheOneThatTheyFollow) {
  const std::string wide = R"(<limit lower="-5" upper="5" effort="0" velocity="0"/>)";
  const std::string moving = R"("dynamics": {"velocities": {"x1": 1}})";
  const auto last = [&](const std::string& urdf, const std::string& robot,
                        const std::string& gravity) {
    Simulator s = simulator(scene(urdf, robot, "", R"("step": 0.01, "gravity": )" + gravity));
    return run(s, 100).back().robots[0];
  };
  const RunRobot stopped =
      last(carts(wide, R"(<limit lower="-5" upper="0.3" effort="0" velocity="0"/>)"),
           R"("dynamics": {})", "[1, 0, 0]");
  EXPECT_NEAR(stopped.positions[0], -0.1, 1e-3);
  const RunRobot damped =
      last(carts(wide + R"(<dynamics damping="0.5"/>)", wide + R"(<dynamics damping="1"/>)"),
           moving, "[0, 0, 0]");
  EXPECT_NEAR(damped.velocities[0], std::exp(-(0.5 + 4.0) / kMassOfCarts), 1e-4);
  const RunRobot rubbed =
      last(carts(wide + R"(<dynamics friction="0.5"/>)", wide + R"(<dynamics friction="1"/>)"),
           moving, "[0, 0, 0]");
  EXPECT_NEAR(rubbed.velocities[0], 1.0 - (0.5 + 2.0) / kMassOfCarts, 1e-6);
  const std::string of_follower =
      scene(carts(wide, wide), R"("dynamics": {"velocities": {"x2": 1}})", "", R"("step": 0.01)");
  EXPECT_THROW((void)simulator(of_follower), ParseError);
}

// --- What motors apply -------------------------------------------------------------------------

TEST_F(SimulateRobots, TellsTheTorqueThatItIsGiven) {
  Simulator s = simulator(scene(
      kPendulum, R"("dynamics": {"motors": {"hinge": {"torque": [[0, 0], [1, 2]], "effort": 1}}})",
      "", R"("step": 0.01)"));
  for (const RunStep& step : run(s, 100)) {
    const double middle = step.time - 0.005;
    ASSERT_EQ(step.robots[0].efforts.size(), 1U);
    ASSERT_NEAR(step.robots[0].efforts[0], std::min(1.0, 2.0 * middle), 1e-12) << step.index;
  }
}

TEST_F(SimulateRobots, TellsWhatHoldsAWeight) {
  const auto last = [&](const std::string& motor) {
    Simulator s = simulator(scene(kPendulum,
                                  R"("state": {"hinge": -1.5707963267948966}, "dynamics": )"
                                  R"({"motors": {"hinge": )" +
                                      motor + "}}",
                                  "", R"("step": 0.01)"));
    return run(s, 20).back().robots[0];
  };
  const std::string target = R"({"position": -1.5707963267948966)";
  EXPECT_NEAR(last(target + "}").efforts[0], -kWeight, 1e-5);
  EXPECT_NEAR(last(target + R"(, "effort": 2.46})").efforts[0], -kWeight, 1e-5);
  EXPECT_NEAR(last(target + R"(, "effort": 2})").efforts[0], -2.0, 1e-12);
  // A spring tells its mean over the step.
  Simulator s = simulator(
      scene(kPendulum,
            R"("state": {"hinge": -1.5707963267948966}, "dynamics": {"motors": {"hinge": )" +
                target + R"(, "stiffness": 20, "damping": 3}}})",
            "", R"("step": 0.01)"));
  const auto steps = run(s, 20);
  const RunRobot& sprung = steps.back().robots[0];
  const auto effort_at = [](const RunRobot& robot) {
    return 20.0 * (-std::numbers::pi / 2 - robot.positions[0]) - 3.0 * robot.velocities[0];
  };
  const double begin = effort_at(steps[18].robots[0]);
  const double end = effort_at(sprung);
  EXPECT_NEAR(sprung.efforts[0], 0.46 * begin + 0.54 * end, 0.01 * std::abs(end - begin));
  EXPECT_NE(sprung.velocities[0], 0.0);
}

// The hinge itself exerts no moment about its axis: what motors give is what the whole gets,
// impacts in the middle of steps included, and where a step runs out of events. Links are off their
// joints there, so arms of impulses are not quite those of the axis.
TEST_F(SimulateRobots, EffortsAreWhatChangesTheMomentum) {
  const std::string ball = body("ball", test::ball("0.05"), "[0.3, 0, -0.4]",
                                R"(, "dynamics": {"mass": 0.5, "linear_velocity": [-2, 0, 0]})") +
                           "," + body("wall", box("[0.1, 1, 1]"), "[0.6, 0, 0]");
  for (const std::string motor : {R"({"velocity": 0.7})", R"({"velocity": 0.7, "effort": 3})",
                                  R"({"position": 0, "stiffness": 30, "damping": 1})"}) {
    for (const std::string events : {"1000", "1"}) {
      Simulator s = simulator(
          scene(kPendulum, R"("dynamics": {"motors": {"hinge": )" + motor + "}}", ball,
                R"("step": 0.01, "gravity": [0, 0, 0], "restitution": 0.8, "events": )" + events));
      RunStep before = s.step().value();
      bool bounced = false;
      for (const RunStep& step : run(s, 17)) {
        ASSERT_NEAR(step.robots[0].efforts[0] * step.lasted,
                    step.angular_momentum.y() - before.angular_momentum.y(), 2e-6)
            << motor << " " << step.index;
        bounced = bounced || step.bodies[0].linear_velocity.x() > -1.5;
        before = step;
      }
      EXPECT_TRUE(bounced) << motor;
    }
  }
}

// Beyond a limit two laws that nothing yields to would have no solution, and none of them was kept.
TEST_F(SimulateRobots, MotorsWithoutBoundStopAtLimits) {
  const std::string urdf =
      robot_of("<link name=\"base\"/>" + link("sled", 2.0, "0 0 0", "<box size=\"0.1 0.1 0.1\"/>") +
               joint("rail", "prismatic", "base", "sled", "1 0 0", "0 0 0",
                     R"(<limit lower="-0.1" upper="0.1" effort="0" velocity="9"/>)"));
  for (const std::string motor :
       {R"({"velocity": 5})", R"({"position": 5})", R"({"torque": 1e6})"}) {
    for (const std::string gravity : {"[0, 0, 0]", "[0, 0, -9.81]"}) {
      Simulator s = simulator(scene(urdf, R"("dynamics": {"motors": {"rail": )" + motor + "}}", "",
                                    R"("step": 0.01, "gravity": )" + gravity));
      const auto steps = run(s, 10);
      for (const RunStep& step : steps) {
        ASSERT_LE(step.robots[0].positions[0], 0.1 + 1e-6) << motor << gravity;
      }
      EXPECT_NEAR(steps.back().robots[0].positions[0], 0.1, 1e-6) << motor << gravity;
    }
  }
}

// A limit and a script contradict each other: as for a crushed body, time is lost.
TEST_F(SimulateRobots, LimitsDoNotGiveWayToAPress) {
  const std::string urdf =
      robot_of("<link name=\"base\"/>" + link("sled", 2.0, "0 0 0", "<box size=\"0.1 0.1 0.1\"/>") +
               joint("rail", "prismatic", "base", "sled", "1 0 0", "0 0 0",
                     R"(<limit lower="-0.1" upper="0.1" effort="0" velocity="9"/>)"));
  for (const bool from_left : {true, false}) {
    const std::string sign = from_left ? "" : "-";
    const std::string press = R"({"name": "press", "shape": {"box": {"size": [0.1, 0.3, 0.3]}},
        "motion": {"type": "waypoints", "times": [0, 1], "poses": [
          {"position": [)" + std::string(from_left ? "-0.2" : "0.2") +
                              R"(, 0, 0]}, {"position": [)" + sign + R"(0.8, 0, 0]}]}})";
    Simulator s =
        simulator(scene(urdf, R"("dynamics": {})", press, R"("step": 0.01, "events": 100)"));
    const auto steps = run(s, 40);
    double lost = 0.0;
    for (const RunStep& step : steps) {
      ASSERT_LE(std::abs(step.robots[0].positions[0]), 0.1 + 1.1e-3) << step.index;
      lost += step.time_lost;
    }
    EXPECT_GT(std::abs(steps.back().robots[0].positions[0]), 0.099);
    EXPECT_GT(lost, 0.1);
    EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
  }
}

// A robot on its trajectory crushes a cube against a wall with one of two links.
TEST_F(SimulateRobots, AllLinksOfARobotWaitTogether) {
  const std::string urdf =
      robot_of("<link name=\"base\"/>" + link("sled", 2.0, "0 0 0", "<box size=\"0.1 0.1 0.1\"/>") +
               link("arm", 1.0, "0 0 0.3", "<box size=\"0.05 0.05 0.4\"/>") +
               joint("rail", "prismatic", "base", "sled", "1 0 0", "0 0 0.06",
                     R"(<limit lower="-9" upper="9" effort="0" velocity="9"/>)") +
               joint("turn", "revolute", "sled", "arm", "0 0 1", "0 0 0.06",
                     R"(<limit lower="-9" upper="9" effort="0" velocity="9"/>)"));
  const std::string fixed =
      R"({"name": "wall", "shape": {"box": {"size": [0.1, 1, 1]}},
      "pose": {"position": [0.4, 0, 0.5]}}, )" +
      test::kFloor + ", " +
      body("cube", box("[0.1, 0.1, 0.1]"), "[0.29, 0, 0.051]", R"(, "dynamics": {"mass": 1})");
  Simulator s = simulator(scene(urdf, R"("trajectory": {"joint_names": ["rail", "turn"], "points": [
          {"positions": [0, 0], "time_from_start": 0},
          {"positions": [0.5, 1], "time_from_start": 1}]})",
                                fixed, R"("step": 0.01, "duration": 1, "jams": "wait")"));
  const auto steps = run(s, 80);
  for (const RunStep& step : steps) {
    ASSERT_EQ(step.time_lost, 0.0);
    std::vector<double> behind;
    for (const RunBody& moved : step.bodies) {
      if (moved.body >= 3) {
        behind.push_back(moved.behind);
      }
    }
    ASSERT_EQ(behind.size(), 2u);
    ASSERT_EQ(behind[0], behind[1]) << step.index;
  }
  EXPECT_GT(steps.back().bodies.back().behind, 0.3);  // It came to the cube after 0.38 s.
  const RunVerification proof = verify(s.header(), steps);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
}

TEST_F(SimulateRobots, LimitsStopAndFrictionHolds) {
  const auto swing = [&](const std::string& more, const std::string& state) {
    const std::string urdf = robot_of(
        "<link name=\"base\"/>" + link("rod", 1.0, "0 0 -0.25", "<box size=\"0.02 0.02 0.5\"/>") +
        joint("hinge", "revolute", "base", "rod", "0 1 0", "0 0 0", more));
    Simulator s = simulator(scene(urdf, R"("state": {"hinge": )" + state + R"(}, "dynamics": {})",
                                  "", R"("step": 0.005)"));
    return run(s, 400);
  };
  const std::string limits = R"(<limit lower="-1.2" upper="0.3" effort="0" velocity="9"/>)";
  for (const RunStep& step : swing(limits, "-1.0")) {
    ASSERT_LE(step.robots[0].positions[0], 0.3 + 1e-9);
    ASSERT_GE(step.robots[0].positions[0], -1.2 - 1e-9);
  }
  EXPECT_NEAR(swing(limits + R"(<dynamics friction="2.0"/>)", "-0.5").back().robots[0].positions[0],
              -0.5, 1e-6);
  EXPECT_THROW((void)swing(limits, "0.5"), std::invalid_argument);
}

/// A palm that slides up and down, and two fingers that close on what is between them.
const std::string kGripper = robot_of(
    "<link name=\"base\"/>" + link("palm", 1.0, "0 0 0", "<box size=\"0.2 0.1 0.02\"/>") +
    link("left", 0.2, "0 0 -0.06", "<box size=\"0.02 0.04 0.1\"/>") +
    link("right", 0.2, "0 0 -0.06", "<box size=\"0.02 0.04 0.1\"/>") +
    joint("lift", "prismatic", "base", "palm", "0 0 1", "0 0 0",
          R"(<limit lower="-1" upper="1" effort="200" velocity="9"/>)") +
    joint("grip", "prismatic", "palm", "left", "1 0 0", "-0.08 0 -0.02",
          R"(<limit lower="0" upper="0.07" effort="50" velocity="9"/>)") +
    joint("follow", "prismatic", "palm", "right", "-1 0 0", "0.08 0 -0.02",
          R"(<limit lower="0" upper="0.07" effort="50" velocity="9"/><mimic joint="grip"/>)"));

/// It closes on a cube on the floor, and lifts it by 0.2 m.
const std::string kGrasp = R"("state": {"lift": 0.0},
  "dynamics": {"friction": 1.0, "motors": {
    "grip": {"position": [[0, 0], [0.3, 0.06]], "stiffness": 2000, "damping": 40, "effort": 30},
    "lift": {"position": [[0, 0], [0.5, 0], [1.0, 0.2]], "stiffness": 20000, "damping": 400}}})";
const std::string kCube = body("floor", box("[2, 2, 1]"), "[0, 0, -0.65]") + "," +
                          body("cube", box("[0.06, 0.04, 0.06]"), "[0.005, 0, -0.119]",
                               R"(, "dynamics": {"mass": 0.2, "friction": 1.0})");

TEST_F(SimulateRobots, AGripperLiftsACube) {
  Simulator s =
      simulator(scene(kGripper, kGrasp, kCube, R"("step": 0.005, "contact_distance": 1e-4)"));
  const auto steps = run(s, 260);
  const auto& cube = steps.back().bodies.front();
  ASSERT_EQ(cube.body, 1U);
  EXPECT_NEAR(cube.X_WB.position.z(), -0.12 + 0.2, 3e-3);
  EXPECT_LE(steps.back().residual, 1e-3);
  const RunVerification verified = verify(s.header(), steps);
  EXPECT_EQ(verified.verdict, ProofVerdict::proven) << verified.problem;
  EXPECT_EQ(verified.time_lost, 0.0);
}

TEST_F(SimulateRobots, ResumesBitForBit) {
  const std::string text =
      scene(kGripper, kGrasp, kCube, R"("step": 0.005, "contact_distance": 1e-4)");
  Simulator whole = simulator(text);
  const auto steps = run(whole, 60);
  std::stringstream file;
  file << write_run_header(whole.header());
  for (std::size_t k = 0; k < 40; ++k) {
    file << write_run_step(steps[k]);
  }
  RunReader reader(file, "run.json");
  std::optional<RunStep> last;
  while (const auto step = reader.next()) {
    last = step;
  }
  Simulator resumed = simulator(text);
  resumed.resume(last.value());
  for (std::size_t k = 40; k < steps.size(); ++k) {
    ASSERT_EQ(write_run_step(resumed.step().value()), write_run_step(steps[k])) << k;
  }
}

TEST_F(SimulateRobots, EffortsOfARunAreThoseOfItsVelocities) {
  Simulator s = simulator(scene(kPendulum, R"("dynamics": {})", "", ""));
  const std::string header = write_run_header(s.header());
  RunStep step = s.step().value();
  EXPECT_EQ(step.robots[0].efforts, std::vector<double>{0.0});
  step.robots[0].efforts.push_back(1.0);
  std::istringstream file(header + write_run_step(step));
  RunReader reader(file, "run.json");
  try {
    (void)reader.next();
    FAIL();
  } catch (const ParseError& error) {
    EXPECT_NE(std::string(error.what()).find("robots[0].efforts: expected as many as velocities"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(SimulateRobots, AFreeBaseFallsAndKeepsItsMomentum) {
  const std::string urdf =
      robot_of(link("body", 2.0, "0 0 0", "<box size=\"0.3 0.2 0.1\"/>") +
               link("arm", 0.5, "0.3 0 0", "<box size=\"0.4 0.05 0.05\"/>") +
               joint("shoulder", "continuous", "body", "arm", "0 0 1", "0.2 0 0"));
  const std::string robot = R"("base": {"position": [0, 0, 3]}, "dynamics": {"base": "free",
      "angular_velocity": [0, 0, 2], "velocities": {"shoulder": 5}})";
  Simulator s = simulator(scene(urdf, robot, "", R"("step": 0.002)"));
  const auto steps = run(s, 300);
  const double time = steps.back().time;
  EXPECT_LE((steps.back().linear_momentum - steps[0].linear_momentum -
             Vector3d(0, 0, -9.81 * 2.5 * (time - 0.002)))
                .norm(),
            1e-3);
  EXPECT_NEAR(energy(steps.back()), energy(steps[0]), 1e-3 * steps[0].kinetic_energy);
}

TEST_F(SimulateRobots, RefusesStatesBeyondLimits) {
  const std::string urdf =
      robot_of(link("body", 2.0, "0 0 0", "<box size=\"0.3 0.2 0.1\"/>") +
               link("arm", 0.5, "0 0 0.3", "<box size=\"0.1 0.1 0.1\"/>") +
               joint("hinge", "revolute", "body", "arm", "0 1 0", "0 0 0.1",
                     R"(<limit lower="-2" upper="2" effort="0" velocity="9"/>)"));
  Simulator s = simulator(scene(urdf, R"("dynamics": {"base": "fixed"})", "", ""));
  MechanismState state = s.robot_states()[0];
  for (const double inside : {-2.0, 0.5, 2.0, 2.0005}) {  // A simulation may go as far.
    state.positions[0] = inside;
    EXPECT_NO_THROW(s.set_robot_state(0, state)) << inside;
  }
  for (const double beyond : {3.0, -2.1}) {
    state.positions[0] = beyond;
    EXPECT_THROW(s.set_robot_state(0, state), std::invalid_argument) << beyond;
  }
  EXPECT_EQ(s.robot_states()[0].positions[0], 2.0005);
}

TEST_F(SimulateRobots, TakesStatesFromOutside) {
  const std::string urdf = robot_of(link("body", 2.0, "0 0 0", "<box size=\"0.3 0.2 0.1\"/>") +
                                    link("head", 0.5, "0 0 0.3", "<box size=\"0.1 0.1 0.1\"/>") +
                                    joint("neck", "ball", "body", "head", "0 0 1", "0 0 0.1"));
  Simulator s = simulator(
      scene(urdf, R"("base": {"position": [0, 0, 3]}, "dynamics": {"base": "free"})", "", ""));
  MechanismState state = s.robot_states()[0];
  state.positions.segment<4>(3) *= 3.0;
  state.velocities[0] = 1.0;
  s.set_robot_state(0, state);
  state.positions.segment<4>(3) /= 3.0;
  EXPECT_EQ(s.robot_states()[0].positions, state.positions);  // Unit quaternions.
  EXPECT_EQ(s.states()[0].v_WC, Vector3d::UnitX());

  const auto complaint = [&](const MechanismState& wrong, std::size_t robot = 0) -> std::string {
    try {
      s.set_robot_state(robot, wrong);
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(s.robot_states()[0].positions, state.positions);
      EXPECT_EQ(s.robot_states()[0].velocities, state.velocities);
      return error.what();
    }
    return "";
  };
  // Quaternions of the base and of the ball joint; too small and too long for the squares of
  // doubles.
  for (const Eigen::Index at : {3, 7}) {
    for (const double size : {0.0, 1e-200, 1e200}) {
      MechanismState wrong = state;
      wrong.positions.segment<4>(at) *= size;
      EXPECT_NE(complaint(wrong).find("positions " + std::to_string(at) + " to"),
                std::string::npos);
    }
  }
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    MechanismState wrong = state;
    wrong.positions[1] = bad;
    EXPECT_NE(complaint(wrong).find("finite"), std::string::npos);
    wrong = state;
    wrong.velocities[8] = bad;
    EXPECT_NE(complaint(wrong).find("finite"), std::string::npos);
  }
  EXPECT_NE(complaint({state.positions.head(10), state.velocities}).find("11 positions"),
            std::string::npos);
  EXPECT_NE(complaint({state.positions, state.positions}).find("9 velocities"), std::string::npos);
  EXPECT_NE(complaint(state, 1).find("no robot 1"), std::string::npos);
  EXPECT_TRUE(s.step().has_value());

  RunStep step = s.step().value();
  std::fill_n(step.robots[0].positions.begin() + 3, 4, 0.0);
  EXPECT_THROW(s.resume(step), std::invalid_argument);
}

/// Two rods, the second one beside the end of the first, about axes that are not parallel.
std::string two_rods(const std::string& limits) {
  return robot_of("<link name=\"base\"/>" +
                  link("upper", 1.0, "0.1 0.05 0", "<sphere radius=\"0.02\"/>") +
                  link("lower", 0.5, "0.15 0 0.1", "<sphere radius=\"0.02\"/>") +
                  joint("shoulder", "continuous", "base", "upper", "0 0 1", "0 0 0") +
                  joint("elbow", "revolute", "upper", "lower", "0.2 1 0.4", "0.3 0 0", limits));
}

// A joint that has limits is driven, though they do not act.
TEST_F(SimulateRobots, FastTurnsKeepTheirEnergyWhereJointsAreDriven) {
  Simulator s =
      simulator(scene(two_rods(R"(<limit lower="-99" upper="99" effort="0" velocity="9"/>)"),
                      R"("dynamics": {"velocities": {"shoulder": 25, "elbow": -30}})", "",
                      R"("step": 0.01, "gravity": [0, 0, 0])"));
  const auto steps = run(s, 200);
  for (const RunStep& step : steps) {
    ASSERT_NEAR(step.kinetic_energy, steps[0].kinetic_energy, 1e-3 * steps[0].kinetic_energy)
        << step.index;
  }
}

// Inertia alone would lead beyond them.
TEST_F(SimulateRobots, LimitsHoldFastTurns) {
  Simulator s =
      simulator(scene(two_rods(R"(<limit lower="-1" upper="1" effort="0" velocity="9"/>)"),
                      R"("dynamics": {"velocities": {"shoulder": 25, "elbow": -30}})", "",
                      R"("step": 0.01, "gravity": [0, 0, 0])"));
  for (const RunStep& step : run(s, 200)) {
    ASSERT_LE(std::abs(step.robots[0].positions[1]), 1.0 + 1e-6) << step.index;
  }
}

TEST_F(SimulateRobots, AnArmThatIsToldWhereToGoPushesWhatIsInItsWay) {
  const std::string robot = R"("base": {"position": [0, 0, 0.6]},
      "trajectory": {"joint_names": ["hinge"], "points": [
        {"time": 0, "positions": [0.8]}, {"time": 1, "positions": [-0.8]}]})";
  const std::string bodies =
      body("floor", box("[4, 4, 1]"), "[0, 0, -0.501]") + "," +
      body("cube", box("[0.2, 0.2, 0.2]"), "[0.15, 0, 0.1]", R"(, "dynamics": {"mass": 1})");
  Simulator s = simulator(scene(kPendulum, robot, bodies, R"("step": 0.005, "duration": 1)"));
  const auto steps = run(s, 200);
  EXPECT_GT(steps.back().bodies.front().X_WB.position.x(), 0.2);
  const RunVerification verified = verify(s.header(), steps);
  EXPECT_EQ(verified.verdict, ProofVerdict::proven) << verified.problem;
}

// The sagitta of the arc, which docs/simulation.md promises: no more, and not much less.
TEST_F(SimulateRobots, JointsComeApartBySagittasBetweenTheEndsOfSteps) {
  const double h = 0.01;
  Simulator s = simulator(
      scene(kPendulum, R"("state": {"hinge": 1.5}, "dynamics": {})", "", R"("step": 0.01)"));
  double rate = 0.0;
  for (const RunStep& step : run(s, 100)) {
    const double mean = 0.5 * (rate + step.robots[0].velocities[0]);
    rate = step.robots[0].velocities[0];
    ASSERT_EQ(step.bodies[0].pieces.size(), 1U);
    const RunPiece& piece = step.bodies[0].pieces[0];
    const double apart = 0.25 - (piece.X_WB.position + 0.5 * piece.translation).norm();
    const double sagitta = mean * mean * h * h * 0.25 / 8.0;
    ASSERT_LE(apart, 1.01 * sagitta + 1e-12) << step.index;
    ASSERT_GE(apart, 0.99 * sagitta - 1e-12) << step.index;
  }
}

// Whatever the step: links move on straight ways, and their arcs are not to be far from these.
TEST_F(SimulateRobots, FastLinksAreMovedByATenthOfARadianAtATime) {
  constexpr double kSpeed = 30.0;  // [rad/s]
  Simulator s = simulator(
      scene(kPendulum, R"("dynamics": {"velocities": {"hinge": )" + std::to_string(kSpeed) + "}}",
            "", R"("step": 0.01, "gravity": [0, 0, 0])"));
  for (const RunStep& step : run(s, 50)) {
    double turned = 0.0;
    for (const RunPiece& piece : step.bodies[0].pieces) {
      ASSERT_LE(piece.rotation_vector.norm(), 0.1 + 1e-9) << step.index;
      turned += piece.rotation_vector.norm();
    }
    ASSERT_NEAR(turned, kSpeed * 0.01, 1e-9) << step.index;
    ASSERT_NEAR(step.robots[0].velocities[0], kSpeed, 1e-9) << step.index;
  }
}

TEST_F(SimulateRobots, SaysWhatIsWrong) {
  const auto complaint = [&](const std::string& robot) -> std::string {
    try {
      (void)simulator(scene(kPendulum, robot, "", ""));
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  const auto expect = [&](const std::string& robot, const std::string& part) {
    const std::string text = complaint(robot);
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(R"("dynamics": {"motors": {"elbow": {"position": 0}}})", "elbow");
  expect(R"("dynamics": {"motors": {"hinge": {}}})", "expected \"position\", \"velocity\"");
  expect(R"("dynamics": {"motors": {"hinge": {"velocity": 1, "stiffness": 2}}})", "\"stiffness\"");
  expect(R"("dynamics": {"motors": {"hinge": {"position": "trajectory"}}})", "\"trajectory\"");
  expect(R"("dynamics": {"motors": {"hinge": {"position": [[1, 0], [1, 2]]}}})",
         "times that increase");
  expect(R"("dynamics": {"linear_velocity": [1, 0, 0]})", "\"base\": \"free\"");
  expect(R"("tracking_error": 0.1, "dynamics": {})", "tracking_error");
  expect(R"("dynamics": {"velocities": {"hinge": "fast"}})", "number");
}

}  // namespace
}  // namespace firstcontact
