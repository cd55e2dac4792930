// Robots whose links slide and spin on what they touch: the motion is of second order in the step,
// as inertia acts on what contacts change.

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "simulation/double_pendulum.h"
#include "simulation/simulated_run.h"
#include "simulation/top.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using test::kLength;
using test::number_text;
using test::numbers;
using test::Swing;
using test::Top;

constexpr double kNear = 1e-5;    // [m]  Contact distance.
constexpr double kRadius = 0.02;  // [m]  Of what touches.
constexpr double kSlides = 0.4;   // [s]

/// A folder with the URDF file of a test.
class RobotContact : public testing::Test {
 protected:
  RobotContact()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("firstcontact_robot_contact_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~RobotContact() override { std::filesystem::remove_all(folder_); }

  /// A proven run of a robot on a floor.
  ///
  /// @param floor  [m]  height of its upper side
  /// @param robot  its keys
  std::vector<RunStep> run(const std::string& urdf, double floor, const std::string& robot,
                           double friction, double duration, double step) const {
    std::ofstream(folder_ / "robot.urdf") << "<robot name=\"r\">" << urdf << "</robot>";
    const std::string text =
        R"({"firstcontact": 1, "bodies": [)" +
        test::body("floor", test::box("[9, 9, 1]"), numbers({0.0, 0.0, floor - 0.5})) +
        R"(], "robots": [{"name": "r", "urdf": ")" + (folder_ / "robot.urdf").string() + R"(", )" +
        robot + R"(}], "simulation": {)" + test::settings(step, friction, kNear) + "}}";
    ShapeCache cache;
    Simulator s(load_scene(parse_scene(text, "test.json"), cache));
    std::vector<RunStep> steps =
        test::run(s, static_cast<std::size_t>(std::lround(duration / step)));
    EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << step;
    return steps;
  }

 private:
  std::filesystem::path folder_;
};

std::string ball_at(const std::string& place) {
  return R"(<collision><origin xyz=")" + place + R"("/><geometry><sphere radius=")" +
         number_text(kRadius) + R"("/></geometry></collision>)";
}

// Plans of a robot are as long as its links turn by 0.1 rad.
TEST_F(RobotContact, ATopPrecessesAsLagrangeHasIt) {
  const Top top;
  const std::string urdf =
      test::massive("top", test::kMassOfTop, "0 0 0.1", top.moments, "", ball_at("0 0 0"));
  const std::string robot =
      R"("base": {"position": )" + numbers({0.0, 0.0, kRadius + kNear}) + R"(, "rpy": )" +
      numbers({0.0, top.lean, 0.0}) + R"(}, "dynamics": {"base": "free", "angular_velocity": )" +
      numbers({top.spin * std::sin(top.lean), 0.0, top.spin * std::cos(top.lean)}) + "}";
  const Vector3d right = test::right_axis(top, 0.5);
  for (const double step : {0.005, 0.00125, 0.000625, 0.0003125}) {
    const std::vector<RunStep> steps = run(urdf, 0.0, robot, 0.0, 0.5, step);
    const Vector3d axis = steps.back().bodies[0].X_WB.rotation * Vector3d::UnitZ();
    const double turned = std::min(0.1, top.spin * step);
    EXPECT_LT((axis - right).norm(), 0.06 * turned * turned) << step;
  }
}

/// Torques on the joints of an arm.
using JointTorques = std::function<Vector2d(const Swing&)>;

/// [m]  How much the end of an arm rises with its angles, and how much the lowest point of the ball
/// there goes along x.
std::array<Vector2d, 2> ways_of_end(const Vector2d& q) {
  const double a = q[0];
  const double b = q[0] + q[1];
  const Vector2d up(kLength * (std::sin(a) + std::sin(b)), kLength * std::sin(b));
  const Vector2d along(-kLength * (std::cos(a) + std::cos(b)), -kLength * std::cos(b));
  return {up, along - kRadius * Vector2d::Ones()};
}

/// The accelerations of an arm whose end slides along a floor, which pushes it.
Vector2d sliding(const Swing& s, const JointTorques& torques, double friction) {
  const Eigen::LLT<Matrix2d> M = test::pendulum_mass(s.q[1]).llt();
  const Vector2d free = M.solve(torques(s) - test::pendulum_bias(s));
  const auto [up, along] = ways_of_end(s.q);
  const double direction = along.dot(s.v) > 0.0 ? 1.0 : -1.0;
  const Vector2d push = M.solve(up - friction * direction * along);
  const double turning = s.v[0] + s.v[1];
  const double bends = kLength * (std::cos(s.q[0]) * s.v[0] * s.v[0] +
                                  std::cos(s.q[0] + s.q[1]) * turning * turning);
  const double force = -(bends + up.dot(free)) / up.dot(push);
  EXPECT_GT(force, 0.0);
  return free + force * push;
}

/// By Runge and Kutta's rule in steps of 0.1 ms.
Swing slid(Swing s, const JointTorques& torques, double friction) {
  constexpr int kCount = 4000;
  const double h = kSlides / kCount;
  const auto rates = [&](const Swing& at) { return Swing{at.v, sliding(at, torques, friction)}; };
  const auto moved = [](const Swing& at, double by, const Swing& rate) {
    return Swing{at.q + by * rate.q, at.v + by * rate.v};
  };
  for (int k = 0; k < kCount; ++k) {
    const Swing a = rates(s);
    const Swing b = rates(moved(s, 0.5 * h, a));
    const Swing c = rates(moved(s, 0.5 * h, b));
    const Swing d = rates(moved(s, h, c));
    s = {s.q + h / 6.0 * (a.q + 2.0 * b.q + 2.0 * c.q + d.q),
         s.v + h / 6.0 * (a.v + 2.0 * b.v + 2.0 * c.v + d.v)};
  }
  return s;
}

/// An arm of two links whose end slides along a floor.
struct Slide {
  std::string name;
  double first_rate = 1.0;    // [rad/s]  Of the first joint.
  std::string joint = "";     // What both joints have in the URDF.
  std::string dynamics = "";  // Keys, with a comma before.
  JointTorques torques = [](const Swing&) -> Vector2d { return Vector2d::Zero(); };
  double friction = 0.0;
  double noise = 6e-6;  // [rad]
};

std::vector<Slide> slides() {
  std::vector<Slide> cases;
  cases.push_back({.name = "without friction"});
  cases.push_back({.name = "with limits", .joint = R"(<limit lower="-9" upper="9" effort="1"
                                                          velocity="99"/>)"});
  cases.push_back({.name = "with damping",
                   .joint = R"(<dynamics damping="0.3"/>)",
                   .torques = [](const Swing& s) -> Vector2d { return -0.3 * s.v; }});
  // It turns back: where it nearly stands still, velocities at the end of a plan lead motors.
  cases.push_back({.name = "with a spring and a damper",
                   .dynamics = R"(, "motors": {"j2": {"position": -1.4, "stiffness": 5,
                                                      "damping": 0.1}})",
                   .torques = [](const Swing& s) -> Vector2d {
                     return {0.0, 5.0 * (-1.4 - s.q[1]) - 0.1 * s.v[1]};
                   },
                   .noise = 6e-5});
  cases.push_back({.name = "with friction", .first_rate = -1.0, .friction = 0.2});
  return cases;
}

TEST_F(RobotContact, AnArmSlidesAlongAFloorAsLagrangeHasIt) {
  for (const Slide& slide : slides()) {
    Swing start{{0.9, -1.4}, {slide.first_rate, 0.0}};
    const auto [up, along] = ways_of_end(start.q);
    start.v[1] = -up[0] / up[1] * start.v[0];
    const double floor =
        -kLength * (std::cos(start.q[0]) + std::cos(start.q[0] + start.q[1])) - kRadius - kNear;
    const Swing right = slid(start, slide.torques, slide.friction);
    const std::string robot =
        R"("state": {"j1": 0.9, "j2": -1.4}, "dynamics": {"base": "fixed", "velocities": {"j1": )" +
        number_text(start.v[0]) + R"(, "j2": )" + number_text(start.v[1]) + "}" + slide.dynamics +
        "}";
    for (const double step : {0.005, 0.0025, 0.00125, 0.000625}) {
      const RunRobot last =
          run(test::double_pendulum(slide.joint, slide.joint, ball_at("0 0 -0.5")), floor, robot,
              slide.friction, kSlides, step)
              .back()
              .robots[0];
      const double error =
          (Vector2d(last.positions[0], last.positions[1]) - right.q).cwiseAbs().maxCoeff();
      EXPECT_LT(error, 1.0 * step * step + slide.noise) << slide.name << " " << step;
    }
  }
}

// --- Robots whose links do not turn --------------------------------------------------------------

std::string box_at(const std::string& place, const std::string& size) {
  return R"(<collision><origin xyz=")" + place + R"("/><geometry><box size=")" + size +
         R"("/></geometry></collision>)";
}

/// [N]  The upward force of contacts in a step.
double upward_force(const RunStep& step) {
  double sum = 0.0;
  for (const RunContact& contact : step.contacts) {
    sum += std::abs(contact.impulse.z());
  }
  return sum / step.lasted;
}

/// A floating robot that slides along a floor.
struct Slider {
  std::string name;
  std::string more = "";      // Further links and joints.
  std::string dynamics = "";  // Keys, with a comma before.
  double mass = 2.0;          // [kg]
};

/// A block of 2 kg, alone or with an arm of 1 kg.
std::vector<Slider> sliders() {
  const std::string arm = test::massive("arm", 1.0, "0 0 0.1", {0.01, 0.02, 0.01}) +
                          test::connected("a", "continuous", "block", "arm", "0 1 0", "0 0 0.3");
  return {{.name = "one link"},
          {.name = "an arm that a motor holds",
           .more = arm,
           .dynamics = R"(, "motors": {"a": {"position": 0}})",
           .mass = 3.0},
          {.name = "an arm that a spring holds",
           .more = arm,
           .dynamics = R"(, "motors": {"a": {"position": 0, "stiffness": 500, "damping": 20}})",
           .mass = 3.0}};
}

// The centre of mass is above the floor. Impulses at another time than the weight would turn it.
TEST_F(RobotContact, AFloatingRobotSlidesUpright) {
  const std::string block = test::massive("block", 2.0, "0 0 0.1", {0.05, 0.05, 0.05}, "",
                                          box_at("0 0 0", "0.4 0.4 0.2"));
  for (const Slider& slider : sliders()) {
    for (const double friction : {0.0, 0.05}) {
      const std::string robot = R"("base": {"position": )" + numbers({0.0, 0.0, 0.1 + kNear}) +
                                R"(}, "dynamics": {"base": "free", "linear_velocity": [1, 0, 0])" +
                                slider.dynamics + "}";
      const std::vector<RunStep> steps = run(block + slider.more, 0.0, robot, friction, 0.5, 0.01);
      const double right = 0.5 - 0.125 * friction * test::kPull;
      EXPECT_NEAR(steps.back().robots[0].positions[0], right, 5e-5) << slider.name << friction;
      for (const RunStep& step : steps) {
        const std::vector<double>& v = step.robots[0].velocities;
        ASSERT_LT(std::abs(v[2]), 5e-5) << slider.name << friction << " " << step.time;
        ASSERT_LT(std::abs(v[4]), 3e-4) << slider.name << friction << " " << step.time;
        ASSERT_NEAR(upward_force(step), slider.mass * test::kPull, 1e-2)
            << slider.name << friction << " " << step.time;
      }
    }
  }
}

// A motor without effect changes nothing, and none makes the motion of first order.
TEST_F(RobotContact, AGantrySlidesWithAnyMotor) {
  const std::string limit = R"(<limit lower="-9" upper="9" effort="0" velocity="9"/>)";
  const std::string urdf =
      "<link name=\"base\"/>" + test::massive("x", 0.5, "0 0 0", {0.01, 0.01, 0.01}) +
      test::massive("z", 2.5, "0 0 0.1", {0.05, 0.05, 0.05}, "", box_at("0 0 0", "0.4 0.4 0.2")) +
      test::connected("jx", "prismatic", "base", "x", "1 0 0", "0 0 0", limit) +
      test::connected("jz", "prismatic", "x", "z", "0 0 1", "0 0 0", limit);
  const auto slid = [&](const std::string& motors, double step) {
    const std::string robot = R"("state": {"jz": )" + number_text(0.1 + kNear) +
                              R"(}, "dynamics": {"base": "fixed", "velocities": {"jx": 2},
                                                 "motors": {)" +
                              motors + "}}";
    return run(urdf, 0.0, robot, 0.2, 0.5, step).back().robots[0].positions[0];
  };
  const double weight = 2.5 * test::kPull;
  for (const double step : {0.01, 0.0025}) {
    for (const auto& [motors, push, press] : std::vector<std::tuple<std::string, double, double>>{
             {"", 0.0, 0.0},
             {R"("jz": {"torque": 0})", 0.0, 0.0},
             {R"("jx": {"torque": 3})", 3.0, 0.0},
             {R"("jz": {"torque": -5})", 0.0, 5.0},
             {R"("jz": {"velocity": -1, "effort": 5})", 0.0, 5.0}}) {
      const double right = 1.0 + 0.125 / 3.0 * (push - 0.2 * (weight + press));
      EXPECT_NEAR(slid(motors, step), right, 1e-6) << motors << step;
    }
  }
}

// At rest the torque alone moves the arm, so that no other speed tells how far contacts reach.
TEST_F(RobotContact, ATorquePressesAnArmWithAllOfItself) {
  const std::string urdf =
      "<link name=\"base\"/>" +
      test::massive("arm", 1.0, "0.25 0 0", {0.01, 0.01, 0.01}, "", ball_at("0.5 0 0")) +
      test::connected("j", "continuous", "base", "arm", "0 1 0", "0 0 0");
  for (const double torque : {5.0, 0.5, -2.0}) {
    const std::string robot = R"("dynamics": {"base": "fixed", "motors": {"j": {"torque": )" +
                              number_text(torque) + "}}}";
    for (const double step : {0.02, 0.01, 0.001}) {
      const std::vector<RunStep> steps = run(urdf, -kRadius - kNear, robot, 0.0, 0.2, step);
      const double right = (torque + 0.25 * test::kPull) / 0.5;
      EXPECT_NEAR(upward_force(steps.back()), right, 2e-6 * right) << torque << " " << step;
      EXPECT_NEAR(steps.back().robots[0].velocities[0], 0.0, 1e-7) << torque << " " << step;
    }
  }
}

}  // namespace
}  // namespace firstcontact
