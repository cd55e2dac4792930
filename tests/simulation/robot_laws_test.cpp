// The laws of robots without contacts: orders in the step, energy and momenta.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <firstcontact/record/write_run.h>
#include <firstcontact/simulation_model/detail/joint_law.h>

#include "simulation/double_pendulum.h"
#include "simulation/simulated_run.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using test::connected;
using test::double_pendulum;
using test::kC1;
using test::kC2;
using test::kI2;
using test::kLength;
using test::kM1;
using test::kM2;
using test::kPull;
using test::massive;
using test::number_text;
using test::pendulum_bias;
using test::pendulum_mass;
using test::Swing;

/// A folder with the URDF file of a test.
class RobotLaws : public testing::Test {
 protected:
  RobotLaws()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("firstcontact_laws_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~RobotLaws() override { std::filesystem::remove_all(folder_); }

  /// @param robot  keys of the robot, @param simulation  those of the simulation
  Simulator made(const std::string& urdf, const std::string& robot,
                 const std::string& simulation) const {
    std::ofstream(folder_ / "robot.urdf") << "<robot name=\"r\">" << urdf << "</robot>";
    const std::string text = R"({"firstcontact": 1, "bodies": [], "robots": [{"name": "r",
        "urdf": ")" + (folder_ / "robot.urdf").string() +
                             R"(", )" + robot + R"(}], "simulation": {)" + simulation + "}}";
    ShapeCache cache;
    return Simulator(load_scene(parse_scene(text, "test.json"), cache));
  }

 private:
  std::filesystem::path folder_;
};

// --- Orders: a double pendulum against Runge and Kutta's rule on its closed equations ------------

using Torques = std::function<Vector2d(double, const Swing&)>;

/// By Runge and Kutta's rule in steps of 0.1 ms. Where the second joint is led, `led` gives its
/// acceleration.
Swing integrated(Swing s, double duration, const Torques& torques,
                 const std::function<double(double)>& led = {}) {
  const auto acceleration = [&](double t, const Swing& now) -> Vector2d {
    const Matrix2d M = pendulum_mass(now.q[1]);
    const Vector2d forces = torques(t, now) - pendulum_bias(now);
    if (!led) {
      return M.llt().solve(forces);
    }
    const double a2 = led(t);
    return {(forces[0] - M(0, 1) * a2) / M(0, 0), a2};
  };
  const int count = static_cast<int>(std::round(duration / 1e-4));
  const double h = duration / count;
  for (int k = 0; k < count; ++k) {
    const double t = k * h;
    const Vector2d a1 = acceleration(t, s);
    const Swing s2{s.q + 0.5 * h * s.v, s.v + 0.5 * h * a1};
    const Vector2d a2 = acceleration(t + 0.5 * h, s2);
    const Swing s3{s.q + 0.5 * h * s2.v, s.v + 0.5 * h * a2};
    const Vector2d a3 = acceleration(t + 0.5 * h, s3);
    const Swing s4{s.q + h * s3.v, s.v + h * a3};
    const Vector2d a4 = acceleration(t + h, s4);
    s = {s.q + h / 6.0 * (s.v + 2.0 * s2.v + 2.0 * s3.v + s4.v),
         s.v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)};
  }
  return s;
}

/// A law of a double pendulum that starts at (1.2, 0.8).
struct LawCase {
  std::string name;
  std::string first = "";  // Of the joints, in the URDF.
  std::string second = "";
  std::string dynamics = R"("base": "fixed")";
  Torques torques = [](double, const Swing&) -> Vector2d { return Vector2d::Zero(); };
  std::function<double(double)> led = {};
  Vector2d v = Vector2d::Zero();
  double duration = 3.0;
  double greatest = 1e-5;  // [rad]  Error at 10 ms.
};

std::vector<LawCase> law_cases() {
  const auto damped = [](double d) -> Torques {
    return [d](double, const Swing& s) -> Vector2d { return -d * s.v; };
  };
  const std::string damping = R"(<dynamics damping="0.05"/>)";
  const std::string slight = R"(<dynamics damping="1e-12"/>)";
  std::vector<LawCase> cases;
  cases.push_back({.name = "free"});
  cases.push_back({.name = "motor of torque 0",
                   .dynamics = R"("base": "fixed", "motors": {"j2": {"torque": 0}})"});
  cases.push_back({.name = "slight damping", .first = slight, .second = slight});
  for (const double d : {0.05, 0.5}) {
    const std::string dampers = "<dynamics damping=\"" + number_text(d) + "\"/>";
    cases.push_back({.name = "damping " + number_text(d),
                     .first = dampers,
                     .second = dampers,
                     .torques = damped(d),
                     .greatest = 2e-6});
  }
  cases.push_back({.name = "torque over time",
                   .dynamics = R"("base": "fixed", "motors": {"j1": {"torque": [[0, 0], [4, 2]]}})",
                   .torques = [](double t, const Swing&) -> Vector2d {
                     return {0.5 * t, 0.0};
                   },
                   .duration = 2.0,
                   .greatest = 1e-4});
  cases.push_back(
      {.name = "spring",
       .dynamics = R"("base": "fixed", "motors": {"j2": {"position": 0.3, "stiffness": 3}})",
       .torques = [](double, const Swing& s) -> Vector2d {
         return {0.0, 3.0 * (0.3 - s.q[1])};
       },
       .duration = 2.0,
       .greatest = 0.015});
  cases.push_back({.name = "spring and damper that follow a ramp",
                   .first = damping,
                   .dynamics = R"("base": "fixed", "motors": {"j2":
                       {"position": [[0, 0.8], [4, 2.8]], "stiffness": 5, "damping": 0.2}})",
                   .torques = [](double t, const Swing& s) -> Vector2d {
                     return {-0.05 * s.v[0], 5.0 * (0.8 + 0.5 * t - s.q[1]) + 0.2 * (0.5 - s.v[1])};
                   },
                   .greatest = 1e-3});
  cases.push_back({.name = "friction",
                   .second = R"(<dynamics friction="0.1"/>)",
                   .dynamics = R"("base": "fixed", "velocities": {"j2": 25})",
                   .torques = [](double, const Swing&) -> Vector2d {
                     return {0.0, -0.1};
                   },
                   .v = {0.0, 25.0},
                   .duration = 0.4,
                   .greatest = 1e-4});
  cases.push_back({.name = "a joint that turns evenly",
                   .dynamics = R"("base": "fixed", "velocities": {"j2": 1.5},
                       "motors": {"j2": {"velocity": 1.5}})",
                   .led = [](double) { return 0.0; },
                   .v = {0.0, 1.5},
                   .greatest = 1e-4});
  cases.push_back({.name = "a joint that turns faster and faster",
                   .dynamics = R"("base": "fixed",
                       "motors": {"j2": {"velocity": [[0, 0], [4, 8]]}})",
                   .led = [](double) { return 2.0; },
                   .greatest = 1e-4});
  return cases;
}

TEST_F(RobotLaws, AreOfSecondOrderInTheStep) {
  for (const LawCase& law : law_cases()) {
    const Swing truth = integrated({{1.2, 0.8}, law.v}, law.duration, law.torques, law.led);
    std::vector<double> errors;
    for (int halved = 0; halved < test::rounds(4, 2); ++halved) {
      const double step = 0.01 / (1 << halved);
      Simulator s = made(double_pendulum(law.first, law.second),
                         R"("state": {"j1": 1.2, "j2": 0.8}, "dynamics": {)" + law.dynamics + "}",
                         R"("step": )" + number_text(step));
      const auto count = static_cast<std::size_t>(std::round(law.duration / step));
      const RunRobot last = test::run(s, count).back().robots[0];
      errors.push_back(
          (Vector2d(last.positions[0], last.positions[1]) - truth.q).cwiseAbs().maxCoeff());
    }
    EXPECT_LE(errors[0], law.greatest) << law.name;
    for (std::size_t k = 1; k < errors.size(); ++k) {
      EXPECT_LE(errors[k], 0.27 * errors[k - 1] + 2e-6) << law.name << " " << k;
    }
  }
}

// --- Springs
// ---------------------------------------------------------------------------------------

/// Sliders of 1 kg one after the other.
std::string sliders(int count) {
  std::string urdf = "<link name=\"l0\"/>";
  for (int k = 1; k <= count; ++k) {
    const std::string n = std::to_string(k);
    urdf += massive("l" + n, 1.0, "0 0 0", {0.01, 0.01, 0.01});
    urdf += connected("s" + n, "prismatic", "l" + std::to_string(k - 1), "l" + n, "1 0 0", "0 0 0",
                      R"(<limit lower="-9" upper="9" effort="0" velocity="0"/>)");
  }
  return urdf;
}

/// [J]  With springs of a stiffness [N/m or N m/rad] that pull all joints to 0.
double energy_with_springs(const RunStep& step, double stiffness) {
  double sum = step.kinetic_energy + step.potential_energy;
  for (const double q : step.robots[0].positions) {
    sum += 0.5 * stiffness * q * q;
  }
  return sum;
}

// 20 steps a period, 100 periods.
TEST_F(RobotLaws, SpringsWithoutDampersKeepTheirEnergy) {
  const double step = 2.0 * std::numbers::pi / 10.0 / 20.0;
  const std::string springs = R"("base": "fixed",
      "motors": {"*": {"position": 0, "stiffness": 100, "damping": 0}})";
  Simulator one = made(sliders(1), R"("state": {"s1": 0.1}, "dynamics": {)" + springs + "}",
                       R"("gravity": [0, 0, 0], "step": )" + number_text(step));
  double farthest = 0.0;
  for (const RunStep& at : test::run(one, 2000)) {
    ASSERT_NEAR(energy_with_springs(at, 100.0), 0.5, 0.5e-9) << at.index;
    farthest = at.index > 1900 ? std::max(farthest, std::abs(at.robots[0].positions[0])) : 0.0;
  }
  EXPECT_NEAR(farthest, 0.1, 0.1 * 0.02);
  Simulator three =
      made(sliders(3), R"("state": {"s1": 0.1, "s3": -0.05}, "dynamics": {)" + springs + "}",
           R"("gravity": [0, 0, 0], "step": )" + number_text(0.5 * step));
  const double energy = 0.5 * 100.0 * (0.01 + 0.0025);
  for (const RunStep& at : test::run(three, 2000)) {
    ASSERT_NEAR(energy_with_springs(at, 100.0), energy, 1e-9 * energy) << at.index;
  }
}

// Masses and gravity change with the positions: energy is not exact, but it does not drift.
TEST_F(RobotLaws, SpringsOfAnArmKeepTheirEnergy) {
  for (const double stiffness : {5.0, 100.0}) {
    const double quick = std::sqrt(stiffness / kI2 / 0.5);  // [rad/s]  About the fastest mode.
    const double step = 2.0 * std::numbers::pi / quick / 20.0;
    Simulator s = made(double_pendulum("", ""),
                       R"("state": {"j1": 0.3, "j2": -0.4}, "dynamics": {"base": "fixed", "motors":
                           {"*": {"position": 0, "stiffness": )" +
                           number_text(stiffness) + "}}}",
                       R"("step": )" + number_text(step));
    const double rest =
        -kPull * (kM1 * kC1 + kM2 * (kLength + kC2));  // [J]  Of the arm that hangs.
    const double begin =
        0.5 * stiffness * (0.09 + 0.16) +
        kPull * (kM1 * kC1 * (1 - std::cos(0.3)) +
                 kM2 * (kLength * (1 - std::cos(0.3)) + kC2 * (1 - std::cos(0.1))));
    double low = begin;
    double high = begin;
    double mean = 0.0;
    for (const RunStep& at : test::run(s, 2000)) {
      const double energy = energy_with_springs(at, stiffness) - rest;
      low = std::min(low, energy);
      high = std::max(high, energy);
      mean += at.index > 1800 ? energy / 200.0 : 0.0;
    }
    EXPECT_NEAR(mean, begin, 1e-3 * begin) << stiffness;
    EXPECT_GE(low, 0.995 * begin);
    EXPECT_LE(high, 1.005 * begin);
  }
}

// Whatever the step: what it cannot follow is damped.
TEST_F(RobotLaws, StiffSpringsAreStable) {
  for (const double stiffness : {1e3, 1e5, 1e7, 1e9}) {
    for (const double damping : {0.0, 10.0, 1e4}) {
      for (const double step : {0.02, 0.005, 0.001}) {
        Simulator s =
            made(double_pendulum("", ""),
                 R"("state": {"j1": 0.3, "j2": -0.4}, "dynamics": {"base": "fixed",
                             "velocities": {"j1": 2}, "motors": {"*": {"position": 0.1,
                             "stiffness": )" +
                     number_text(stiffness) + R"(, "damping": )" + number_text(damping) + "}}}",
                 R"("step": )" + number_text(step));
        const double allowed = 0.5 * stiffness * (0.04 + 0.25) + 20.0;
        for (const RunStep& at : test::run(s, 300)) {
          double energy = at.kinetic_energy;
          for (const double q : at.robots[0].positions) {
            energy += 0.5 * stiffness * (q - 0.1) * (q - 0.1);
          }
          ASSERT_LE(energy, 1.1 * allowed)
              << stiffness << " " << damping << " " << step << " " << at.index;
        }
      }
    }
  }
}

// A damper alone: v = exp(-d t / m), at any step.
TEST_F(RobotLaws, DampersDecayExactly) {
  for (const double damping : {0.5, 5.0, 49.0, 50.0, 51.0, 5000.0}) {
    const std::string urdf =
        "<link name=\"base\"/>" + massive("sled", 1.0, "0 0 0", {0.01, 0.01, 0.01}) +
        connected("rail", "prismatic", "base", "sled", "1 0 0", "0 0 0",
                  R"(<limit lower="-9" upper="9" effort="0" velocity="0"/><dynamics damping=")" +
                      number_text(damping) + "\"/>");
    Simulator s = made(urdf, R"("dynamics": {"base": "fixed", "velocities": {"rail": 3}})",
                       R"("gravity": [0, 0, 0], "step": 0.01)");
    for (const RunStep& at : test::run(s, 20)) {
      const double left = std::exp(-damping * at.time);
      ASSERT_NEAR(at.robots[0].velocities[0], 3.0 * left, 1e-8) << damping << " " << at.index;
      ASSERT_NEAR(at.robots[0].positions[0], 3.0 / damping * (1.0 - left), 1e-8) << damping;
    }
  }
}

/// A sled of 0.2 kg on a rail, whose motor pulls it to 0 with 100 N/m against a damper [N s/m].
std::string damped_sled(double upper) {
  return "<link name=\"base\"/>" + massive("sled", 0.2, "0 0 0", {0.01, 0.01, 0.01}) +
         connected(
             "rail", "prismatic", "base", "sled", "1 0 0", "0 0 0",
             R"(<limit lower="-9" effort="0" velocity="0" upper=")" + number_text(upper) + "\"/>");
}

std::string motor_of_sled(double position, double damping) {
  return R"("dynamics": {"base": "fixed", "motors": {"rail": {"position": )" +
         number_text(position) + R"(, "stiffness": 100, "damping": )" + number_text(damping) +
         "}}}";
}

// A strong damper, whose own decay is over within a step, lets a spring creep.
TEST_F(RobotLaws, CreepAgainstStrongDampersToSecondOrder) {
  constexpr double kEnd = 0.5;             // [s]
  constexpr double kSquare = 100.0 / 0.2;  // [1/s^2]  Stiffness by mass.
  for (const double damping : {50.0, 200.0, 1000.0}) {
    // Both rates of decay of a damped spring, from rest at 0.3 m.
    const double half = 0.5 * damping / 0.2;
    const double fast = half + std::sqrt(half * half - kSquare);
    const double slow = kSquare / fast;
    const double right =
        0.3 * (fast * std::exp(-slow * kEnd) - slow * std::exp(-fast * kEnd)) / (fast - slow);
    for (const double step : {0.02, 0.01, 0.005, 0.0025}) {
      Simulator s =
          made(damped_sled(9.0), R"("state": {"rail": 0.3}, )" + motor_of_sled(0.0, damping),
               R"("gravity": [0, 0, 0], "step": )" + number_text(step));
      const auto count = static_cast<std::size_t>(std::lround(kEnd / step));
      EXPECT_NEAR(test::run(s, count).back().robots[0].positions[0], right, step * step)
          << damping << " " << step;
    }
  }
}

// Creep and the decay of a damper end at a limit, and not beyond it. The end rule solves for that
// to about 1e-12 m a step.
TEST_F(RobotLaws, CreepNoFartherThanTheLimit) {
  for (const double damping : {20.0, 50.0, 1000.0}) {
    Simulator s = made(damped_sled(0.01), R"("state": {"rail": 0}, )" + motor_of_sled(0.3, damping),
                       R"("gravity": [0, 0, 0], "step": 0.01)");
    double last = 0.0;
    for (const RunStep& at : test::run(s, 100)) {
      last = at.robots[0].positions[0];
      ASSERT_LE(last - 0.01, 1e-9) << damping << " " << at.index;
    }
    EXPECT_NEAR(last, 0.01, 1e-9) << damping;
  }
}

// The bound that tells slow motions from decays: a decay loses at least 2 weight - 1 in a span.
TEST(FittedWeights, TellWhatADecayLosesAtLeast) {
  for (double z = 1e-6; z < 1e6; z *= 1.5) {
    EXPECT_GE(-std::expm1(-z), (2.0 * detail::fitted_weight(z) - 1.0) * (1.0 - 1e-12)) << z;
  }
}

// --- Momenta
// -----------------------------------------------------------------------------------------

/// A torso with two arms of two links each.
std::string torso(bool has_geometry, const std::string& more = "") {
  const auto size = [&](const char* text) { return std::string(has_geometry ? text : ""); };
  std::string urdf = massive("torso", 4.0, "0 0 0", {0.05, 0.06, 0.03}, size("0.3 0.2 0.4"));
  for (const std::string side : {"l", "r"}) {
    const std::string sign = side == "l" ? "" : "-";
    urdf +=
        massive(side + "u", 1.0, "0 " + sign + "0.2 0", {0.01, 0.002, 0.01}, size("0.05 0.3 0.05"));
    urdf += massive(side + "f", 0.6, "0 " + sign + "0.15 0", {0.006, 0.001, 0.006},
                    size("0.04 0.2 0.04"));
    urdf += connected(side + "1", "continuous", "torso", side + "u", "1 0 0",
                      "0 " + sign + "0.15 0.1", more);
    urdf += connected(side + "2", "continuous", side + "u", side + "f", "0 0 1",
                      "0 " + sign + "0.4 0", more);
  }
  return urdf;
}

/// Momenta stay as they are after the first step.
void expect_same_momenta(const std::vector<RunStep>& steps, const Vector3d& linear,
                         const std::string& name) {
  const double size = 1.0 + linear.norm();
  for (const RunStep& step : steps) {
    ASSERT_LE((step.linear_momentum - linear).norm(), 1e-10 * size) << name << " " << step.index;
    ASSERT_LE((step.angular_momentum - steps[0].angular_momentum).norm(), 1e-10 * size)
        << name << " " << step.index;
  }
}

TEST_F(RobotLaws, KeepTheMomentaOfWhatFloats) {
  const std::vector<std::string> motors{
      "",
      R"("motors": {"l1": {"torque": 0.2}, "r1": {"torque": [[0, -0.1], [1, 0.3]]}},)",
      R"("motors": {"*": {"position": 0.4, "stiffness": 30, "damping": 0.1}},)",
      R"("motors": {"*": {"position": 0}},)",
      R"("motors": {"*": {"velocity": 0.7}},)",
      R"("motors": {"l1": {"velocity": 5, "effort": 0.3}, "r2": {"position": [[0, 0], [1, 1]]}},)"};
  for (const bool has_geometry : {false, true}) {
    for (const std::string& more : {std::string(), std::string("<dynamics damping=\"0.1\"/>"),
                                    std::string("<dynamics friction=\"0.05\"/>")}) {
      for (const std::string& motor : motors) {
        Simulator s = made(torso(has_geometry, more),
                           R"("dynamics": {"base": "free", )" + motor +
                               R"("linear_velocity": [0.1, 0.2, 0.3],
                                  "angular_velocity": [0.4, -0.8, 1.1],
                                  "velocities": {"l2": 0.6}})",
                           R"("gravity": [0, 0, 0], "step": 0.01)");
        // The first step may change velocities at once; momenta are those of the start.
        const Vector3d linear = s.step().value().linear_momentum;
        expect_same_momenta(test::run(s, 100), linear, motor + more);
      }
    }
  }
}

TEST_F(RobotLaws, LetWhatFloatsFall) {
  Simulator s = made(torso(true), R"("dynamics": {"base": "free",
      "motors": {"l1": {"position": 0.5, "stiffness": 30}}, "angular_velocity": [1, 2, 3]})",
                     R"("step": 0.01)");
  const double mass = 4.0 + 2.0 * 1.6;
  const RunStep first = s.step().value();
  for (const RunStep& step : test::run(s, 100)) {
    const Vector3d fallen(0.0, 0.0, -kPull * mass * (step.time - first.time));
    ASSERT_LE((step.linear_momentum - first.linear_momentum - fallen).norm(), 1e-10 * mass * kPull);
  }
}

// Held joints make it one rigid body. It has 12 J.
TEST_F(RobotLaws, KeepTheEnergyOfHeldRobotsThatTumble) {
  std::vector<double> errors;
  for (const double step : {0.01, 0.005, 0.0025}) {
    Simulator s = made(torso(true), R"("dynamics": {"base": "free",
        "motors": {"*": {"position": 0}}, "angular_velocity": [1, 2, 3]})",
                       R"("gravity": [0, 0, 0], "step": )" + number_text(step));
    const auto steps = test::run(s, static_cast<std::size_t>(std::round(4.0 / step)));
    // Moments of the torso, and of arms that stretch along y from 0.1 m above its centre.
    const double along = 2.0 * (0.002 + 0.001 + 1.6 * 0.01);
    const double across = 2.0 * (0.016 + 1.0 * 0.35 * 0.35 + 0.6 * 0.7 * 0.7);
    const double x = 0.05 + across + 2.0 * 1.6 * 0.01;
    const double energy = 0.5 * (x + 4.0 * (0.06 + along) + 9.0 * (0.03 + across));
    double worst = 0.0;
    for (const RunStep& at : steps) {
      worst = std::max(worst, std::abs(at.kinetic_energy - energy));
    }
    errors.push_back(worst);
    expect_same_momenta(steps, steps[0].linear_momentum, "held");
  }
  // Of 1e-11 by its sub-steps of fourth order, which turn by less at any of these steps.
  for (const double error : errors) {
    EXPECT_LE(error, 2e-9);
  }
}

// A motor that nothing bounds presses a link on the base: inner forces, however great.
TEST_F(RobotLaws, KeepMomentaWhereARobotPressesOnItself) {
  const std::string limits = R"(<limit lower="-1" upper="1" effort="0" velocity="0"/>)";
  const std::string pressing = massive("base", 2.0, "0 0 0", {0.02, 0.02, 0.02}, "0.2 0.2 0.2") +
                               massive("a", 1.0, "0.3 0 0", {0.01, 0.01, 0.01}) +
                               massive("b", 1.0, "0.4 0 0", {0.01, 0.01, 0.01}, "0.2 0.2 0.2") +
                               connected("j1", "prismatic", "base", "a", "1 0 0", "0 0 0", limits) +
                               connected("j2", "prismatic", "a", "b", "1 0 0", "0 0 0", limits);
  for (const std::string motors :
       {R"("j1": {"position": 0}, "j2": {"velocity": -0.5})",
        R"("j1": {"position": 0}, "j2": {"position": [[0, 0], [1, -0.5]]})",
        R"("j1": {"position": 0, "effort": 20}, "j2": {"velocity": -0.5, "effort": 20})",
        R"("j1": {"position": 0, "stiffness": 1e5}, "j2": {"torque": -50})"}) {
    Simulator s = made(pressing,
                       R"("dynamics": {"base": "free", "motors": {)" + motors +
                           R"(}, "linear_velocity": [1, 0, 0],
                                        "angular_velocity": [0, 0, 1]})",
                       R"("gravity": [0, 0, 0], "step": 0.01)");
    const auto steps = test::run(s, test::rounds(150, 40));  // They meet after 20.
    expect_same_momenta(steps, steps[0].linear_momentum, motors);
    for (const RunStep& step : steps) {
      ASSERT_EQ(step.time_lost, 0.0) << motors << step.index;
    }
    EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << motors;
  }
}

// A motor that nothing bounds presses one arm on the other, against its limit. It caught up what it
// was behind within the shortest plans: 1e9 J came from that. Jams end otherwise on each processor,
// with steps of up to 5.3 J.
TEST_F(RobotLaws, CatchUpInAStepWhatJamsKeptFromMotors) {
  const std::string limits = R"(<limit lower="-2" upper="2" effort="0" velocity="0"/>)";
  const std::string arms =
      massive("body", 2.0, "0 0 0", {0.02, 0.03, 0.04}, "0.2 0.2 0.2") +
      massive("a", 0.5, "0 0 -0.2", {0.006, 0.006, 0.001}, "0.05 0.05 0.3") +
      massive("b", 0.5, "0 0 -0.2", {0.006, 0.006, 0.001}, "0.05 0.05 0.3") +
      massive("c", 0.3, "0 0 -0.15", {0.003, 0.003, 0.001}, "0.05 0.05 0.2") +
      connected("j1", "revolute", "body", "a", "0 1 0", "0.1 0 -0.12", limits) +
      connected("j2", "revolute", "body", "b", "0 1 0", "-0.1 0 -0.12", limits) +
      connected("j3", "revolute", "a", "c", "1 0 0", "0 0 -0.4", limits);
  Simulator s = made(arms,
                     R"("dynamics": {"base": "free", "linear_velocity": [0.3, 0, 0],
                          "angular_velocity": [0.5, 1, 2], "velocities": {"j1": 3, "j2": -2, "j3": 1},
                          "motors": {"j1": {"position": [[0, 0], [0.5, 1.5], [2, -1]]},
                                     "j3": {"position": [[0, 0], [2, 1]]}}})",
                     R"("gravity": [0, 0, 0], "step": 0.005)");
  const auto steps = test::run(s, 185);
  for (const RunStep& step : steps) {
    ASSERT_LE(step.kinetic_energy, 10.0) << step.index;
    ASSERT_EQ(step.time_lost, 0.0) << step.index;
  }
  EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven);
}

TEST_F(RobotLaws, KeepMomentaWhereFrictionHoldsARobotAgainstItself) {
  for (const double step : {0.01, 0.0025}) {
    Simulator s = made(torso(true), R"("dynamics": {"base": "free",
        "linear_velocity": [0.1, 0.2, 0.3], "motors": {"l1": {"torque": 0.2},
        "r1": {"torque": -0.1},
        "l2": {"torque": [[0, 0.1], [1, -0.1], [2, 0.1], [10, -0.1]]}}})",
                       R"("gravity": [0, 0, 0], "step": )" + number_text(step));
    const auto steps = test::run(s, static_cast<std::size_t>(std::round(3.0 / step)));
    expect_same_momenta(steps, steps[0].linear_momentum, number_text(step));
    EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven);
  }
}

// --- Masses
// ------------------------------------------------------------------------------------------

/// Three hinges z, y, z with no mass between them.
const std::string kWrist = massive("base", 1.0, "0 0 0", {0.01, 0.01, 0.01}) +
                           "<link name=\"w1\"/><link name=\"w2\"/>" +
                           massive("hand", 0.5, "0 0 0.1", {0.001, 0.002, 0.003}, "0.05 0.05 0.1") +
                           connected("r1", "continuous", "base", "w1", "0 0 1", "0 0 0") +
                           connected("r2", "continuous", "w1", "w2", "0 1 0", "0 0 0") +
                           connected("r3", "continuous", "w2", "hand", "0 0 1", "0 0 0");

TEST_F(RobotLaws, NeedMassOnlyWhereARobotStarts) {
  Simulator s = made(kWrist, R"("state": {"r2": 0.7}, "dynamics": {"base": "fixed",
      "motors": {"*": {"velocity": 0.5}}})",
                     R"("gravity": [0, 0, 0], "step": 0.005)");
  const RunRobot last = test::run(s, 200).back().robots[0];
  EXPECT_NEAR(last.positions[0], 0.5, 1e-9);
  EXPECT_NEAR(last.positions[1], 1.2, 1e-9);
  EXPECT_NEAR(last.positions[2], 0.5, 1e-9);
  const auto complaint = [&](const std::function<void()>& act) -> std::string {
    try {
      act();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(complaint([&] {
              (void)made(kWrist, R"("dynamics": {"base": "fixed"})", "");
            }).find("together move no mass where it starts"),
            std::string::npos);
  MechanismState straight = s.robot_states()[0];
  straight.positions.setZero();
  EXPECT_NE(complaint([&] { s.set_robot_state(0, straight); }).find("move no mass"),
            std::string::npos);
  EXPECT_EQ(s.robot_states()[0].positions[1], last.positions[1]);
}

// Motors lead the wrist through the place where its axes align.
TEST_F(RobotLaws, LeadAWristThroughItsSingularPlace) {
  Simulator s = made(kWrist, R"("state": {"r2": 0.5}, "dynamics": {"base": "fixed",
      "velocities": {"r2": -0.5}, "motors": {"*": {"velocity": -0.5}}})",
                     R"("gravity": [0, 0, 0], "step": 0.005)");
  const RunStep last = test::run(s, 400).back();
  EXPECT_NEAR(last.robots[0].positions[1], -0.5, 1e-6);
  EXPECT_TRUE(std::isfinite(last.kinetic_energy));
}

TEST_F(RobotLaws, NeedNoGeometry) {
  std::vector<std::vector<RunStep>> runs;
  for (const bool has_geometry : {false, true}) {
    Simulator s = made(torso(has_geometry), R"("dynamics": {"base": "free", "motors":
        {"l1": {"torque": 0.1}}, "angular_velocity": [0.3, 0.2, 0.4]})",
                       R"("gravity": [0, 0, 0], "step": 0.01)");
    runs.push_back(test::run(s, 50));
    EXPECT_EQ(test::verify(s.header(), runs.back()).verdict, ProofVerdict::proven) << has_geometry;
  }
  EXPECT_EQ(runs[0].back().robots[0].positions, runs[1].back().robots[0].positions);
  EXPECT_EQ(runs[0].back().robots[0].velocities, runs[1].back().robots[0].velocities);
  EXPECT_TRUE(runs[0].back().bodies.empty());
}

TEST_F(RobotLaws, GoOnBitForBit) {
  const std::string robot = R"("dynamics": {"base": "free", "motors": {"l1": {"torque": 0.2},
      "l2": {"position": 0.5, "stiffness": 10}, "r1": {"velocity": 1}},
      "angular_velocity": [0.3, 0.2, 0.4]})";
  const std::string settings = R"("gravity": [0, 0, -1], "step": 0.01)";
  Simulator whole = made(torso(false, "<dynamics friction=\"0.01\"/>"), robot, settings);
  const auto steps = test::run(whole, 60);
  Simulator resumed = made(torso(false, "<dynamics friction=\"0.01\"/>"), robot, settings);
  resumed.resume(steps[39]);
  for (std::size_t k = 40; k < steps.size(); ++k) {
    ASSERT_EQ(write_run_step(resumed.step().value()), write_run_step(steps[k])) << k;
  }
}

}  // namespace
}  // namespace firstcontact
