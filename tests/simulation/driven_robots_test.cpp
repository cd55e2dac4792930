// Robots that are dropped, and what robots carry.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"
#include "support/data_dir.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::run;

const std::string kWithoutTorque = R"(, "motors": {"*": {"torque": 0}})";

struct Fall {
  std::filesystem::path urdf;
  std::string base;
  std::string dynamics;
};

/// [J]  The most that a robot gains in a step of a second in which it falls onto a floor.
double greatest_gain(const Fall& fall, const std::string& motors, double restitution) {
  const std::string text =
      R"({"firstcontact": 1, "bodies": [)" +
      test::body("floor", test::box("[20, 20, 0.2]"), "[0, 0, -0.1]") +
      R"(], "robots": [{"name": "r", "urdf": ")" + fall.urdf.string() + R"(", "base": )" +
      fall.base + R"(, "dynamics": {"base": "free", "density": 2000, "restitution": )" +
      test::number_text(restitution) + ", " + fall.dynamics + motors +
      R"(}}], "pairs": {"ignore": [["r", "r"]]}, "simulation": {"step": 0.01, "friction": 0.2}})";
  ShapeCache cache;
  Simulator simulator(load_scene(parse_scene(text, "test.json"), cache));
  const std::vector<RunStep> steps = run(simulator, 100);
  double gain = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < steps.size(); ++k) {
    EXPECT_EQ(steps[k].time_lost, 0.0) << k;
    const auto energy = [&](std::size_t at) {
      return steps[at].kinetic_energy + steps[at].potential_energy;
    };
    gain = k == 0 ? gain : std::max(gain, energy(k) - energy(k - 1));
  }
  EXPECT_EQ(test::verify(simulator.header(), steps).verdict, ProofVerdict::proven);
  return gain;
}

// Links are on the chords of their ways where an impact ends a plan. To be where their joints have
// them at once would be a speed: up to 1e9 J, or jams for ever.
TEST(DroppedRobots, GainNoEnergyAndLoseNoTime) {
  const Fall arm{FIRSTCONTACT_SOURCE_DIR
                 "/data/robots/moveit_resources_panda_description/urdf/panda.urdf",
                 R"({"position": [0, 0, 1.2], "rpy": [-2.1430430338526216, -1.5700314719924477,
          -0.7105624956901071]})",
                 R"("angular_velocity": [-2.2308243038511555, -2.7787715214406776,
          0.09822434897313272], "linear_velocity": [0.5, 0, -1])"};
  EXPECT_LT(greatest_gain(arm, "", 0.0), 1e-5);
  EXPECT_LT(greatest_gain(arm, kWithoutTorque, 0.0), 1e-5);
}

TEST(DroppedRobots, BounceWithMotorsAndWithout) {
  const std::filesystem::path data = test::data_dir();
  if (data.empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const Fall hand{data /
                      "robots/example-robot-data/robots/allegro_hand_description/urdf/"
                      "allegro_right_hand.urdf",
                  R"({"position": [0, 0, 0.5], "rpy": [-2.1067917322605085, 1.1350475240932507,
                      2.9803608872202236]})",
                  R"("angular_velocity": [-1.0013660019120243, 2.4196452652472407,
                      0.5327530774637419], "linear_velocity": [0.5, 0, -1])"};
  for (const std::string& motors :
       {std::string(), kWithoutTorque,
        std::string(R"(, "motors": {"*": {"position": 0, "stiffness": 5, "damping": 0.1}})")}) {
    EXPECT_LT(greatest_gain(hand, motors, 0.9), 1e-5) << motors;
  }
}

/// A robot of one joint, the body that it carries, and the position of its joint.
class Carried : public testing::Test {
 protected:
  Carried()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("firstcontact_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~Carried() override { std::filesystem::remove_all(folder_); }

  std::vector<RunStep> run_of(const std::string& joint, const std::string& tray,
                              const std::string& motor, const Vector3d& block, double step,
                              double contact_distance = 1e-5) const {
    const std::string inertial =
        R"(<inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
           </inertial>)";
    std::ofstream(folder_ / "robot.urdf")
        << R"(<robot name="r"><link name="base">)" << inertial << R"(</link><link name="tray">)"
        << inertial << R"(<collision><geometry><box size=")" << tray
        << R"("/></geometry></collision></link><joint name="j" )" << joint
        << R"(<parent link="base"/><child link="tray"/></joint></robot>)";
    const std::string text =
        R"({"firstcontact": 1, "bodies": [)" +
        test::body("block", test::box("[0.2, 0.2, 0.1]"),
                   test::numbers({block.x(), block.y(), block.z()}),
                   R"(, "dynamics": {"mass": 1})") +
        R"(], "robots": [{"name": "r", "urdf": ")" + (folder_ / "robot.urdf").string() +
        R"(", "dynamics": {"base": "fixed", "motors": {"j": )" + motor +
        R"(}}}], "simulation": {)" + test::settings(step, 1.0, contact_distance) + "}}";
    ShapeCache cache;
    Simulator simulator(load_scene(parse_scene(text, "test.json"), cache));
    const std::vector<RunStep> steps = run(simulator, static_cast<std::size_t>(1.0 / step + 0.5));
    EXPECT_EQ(test::verify(simulator.header(), steps).verdict, ProofVerdict::proven) << motor;
    return steps;
  }

 private:
  std::filesystem::path folder_;
};

// Friction is five times what it needs. By the mean of its velocities the block slipped by half of
// the step times the velocity of the tray: 10 mm. It still did at contact distances of a tenth of
// a millimetre and more.
TEST_F(Carried, StaysOnATrayThatAMotorDrives) {
  const std::string joint = R"(type="continuous"><axis xyz="0 0 1"/>)";
  const std::string slider =
      R"(type="prismatic"><axis xyz="1 0 0"/>
         <limit lower="-9" upper="9" effort="0" velocity="0"/>)";
  std::string positions = "[[0, 0]";
  for (int k = 1; k <= 400; ++k) {
    const double t = 0.0025 * k;
    positions += ", " + test::numbers({t, t * t});
  }
  positions += "]";
  const std::string rows = R"({"position": )" + positions + "}";
  for (const double near : {1e-5, 1e-4, 5e-4}) {
    for (const std::string& motor : {std::string(R"({"torque": 12})"), rows}) {
      const std::vector<RunStep> steps =
          run_of(slider, "1 1 0.1", motor, {0.0, 0.0, 0.1 + near}, 0.01, near);
      const double slip =
          steps.back().bodies.front().X_WB.position.x() - steps.back().robots[0].positions[0];
      EXPECT_LT(std::abs(slip), 1e-8) << motor << near;
    }
    // On a turntable, of second order: 0.3 m from the axis, up to 2 rad/s.
    for (const double step : {0.01, 0.005}) {
      const std::vector<RunStep> steps =
          run_of(joint, "2 2 0.1", rows, {0.3, 0.0, 0.1 + near}, step, near);
      const double angle = steps.back().robots[0].positions[0];
      const Vector3d right(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.0);
      Vector3d slip = steps.back().bodies.front().X_WB.position - right;
      slip.z() = 0.0;
      EXPECT_LT(slip.norm(), 1.5 * step * step) << step << near;
    }
  }
}

// A pulse of 1 ms in a step of 10 ms acts with its impulse.
TEST_F(Carried, IsMovedByTheWholeOfATorqueInTime) {
  const std::string slider =
      R"(type="prismatic"><axis xyz="1 0 0"/>
         <limit lower="-9" upper="9" effort="0" velocity="0"/>)";
  for (const double step : {0.02, 0.01, 0.005}) {
    const std::vector<RunStep> steps =
        run_of(slider, "1 1 0.1", R"({"torque": [[0, 0], [0.012, 0], [0.013, 1000], [0.014, 0]]})",
               {0.0, 0.0, 9.0}, step);
    EXPECT_NEAR(steps.back().robots[0].velocities[0], 0.2, 1e-9) << step;
  }
}

}  // namespace
}  // namespace firstcontact
