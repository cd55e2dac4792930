// Ties of bodies that are almost point masses: they turn with their arms, and turning them takes
// almost no force.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "island/tie_laws.h"
#include "simulation/simulated_run.h"
#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::body;
using test::number_text;
using test::numbers;
using test::Random;
using test::run;
using test::simulator;
using test::tie_settings;

constexpr double kPull = 9.81;  // [m/s^2]  Of gravity.

/// A ball on an arm from the origin, one radian off the vertical.
struct Pendulum {
  std::string type = "pin";
  double arm = 1.0;      // [m]
  double ratio = 1e-9;   // [-]  Moment of inertia by mass and arm squared.
  double heading = 0.0;  // [rad]  Turn of its plane about the vertical.

  [[nodiscard]] Vector3d place(double angle) const {
    return arm * Vector3d(std::sin(angle) * std::cos(heading), std::sin(angle) * std::sin(heading),
                          -std::cos(angle));
  }
  [[nodiscard]] Simulator simulator_with(double h) const {
    const double inertia = ratio * arm * arm;
    const Vector3d at = place(1.0);
    const std::string axis =
        type == "hinge" ? R"(, "axis": )" + numbers({-std::sin(heading), std::cos(heading), 0.0})
                        : "";
    return simulator(
        body("a", test::ball("0.05"), numbers({at.x(), at.y(), at.z()}),
             R"(, "dynamics": {"mass": 1, "inertia": [)" + numbers({inertia, 0.0, 0.0}) + ", " +
                 numbers({0.0, inertia, 0.0}) + ", " + numbers({0.0, 0.0, inertia}) + "]}"),
        tie_settings(h, R"({"type": ")" + type +
                            R"(", "bodies": [null, "a"], "points": [[0, 0, 0], null])" + axis +
                            "}"));
  }
  /// [m]  Where it is after a time.
  [[nodiscard]] Vector3d after(double time) const {
    const double rate = kPull / (arm * (1.0 + ratio));
    const Vector2d end = test::followed(Vector2d(1.0, 0.0), time, [&](const Vector2d& y) {
      return Vector2d(y[1], -rate * std::sin(y[0]));
    });
    return place(end[0]);
  }
};

// Balls of less than 1e-7 lost all time, or tore off without a word.
TEST(PointMassTie, SwingsAsAPendulum) {
  Random random(7);
  for (int i = 0; i < 24; ++i) {
    const Pendulum pendulum{.type = i % 2 == 0 ? "pin" : "hinge",
                            .arm = random.logarithmic(0.3, 3.0),
                            .ratio = random.logarithmic(1e-10, 1e-5),
                            .heading = random.uniform(0.0, 2.0 * std::numbers::pi)};
    Simulator s = pendulum.simulator_with(0.01);
    for (const RunStep& step : run(s, 100)) {
      ASSERT_EQ(step.time_lost, 0.0) << pendulum.type << " " << pendulum.ratio;
      ASSERT_NEAR(step.bodies[0].X_WB.position.norm(), pendulum.arm, 2e-9) << pendulum.ratio;
    }
    EXPECT_LE((s.states()[0].X_WB.position - pendulum.after(1.0)).norm(), 3e-4 * pendulum.arm)
        << pendulum.type << " " << pendulum.ratio << " " << pendulum.arm;
  }
}

TEST(PointMassTie, IsOfSecondOrder) {
  for (const std::string type : {"pin", "hinge"}) {
    const Pendulum pendulum{.type = type};
    const Vector3d right = pendulum.after(1.0);
    test::expect_order(0.005, [&](double h) {
      Simulator s = pendulum.simulator_with(h);
      run(s, test::steps_until(1.0, h));
      return (s.states()[0].X_WB.position - right).norm();
    });
  }
}

// A bead of half a millimetre goes round on an arm of a metre, and turns with it.
TEST(PointMassTie, ABeadGoesRoundOnALevel) {
  const double angle = 0.6;
  const double rate = std::sqrt(kPull / std::cos(angle));
  const double radius = std::sin(angle);
  Simulator s =
      simulator(body("bead", test::ball("0.0005"), numbers({radius, 0.0, -std::cos(angle)}),
                     R"(, "dynamics": {"density": 8000, "linear_velocity": )" +
                         numbers({0.0, rate * radius, 0.0}) + R"(, "angular_velocity": )" +
                         numbers({0.0, 0.0, rate}) + "}"),
                tie_settings(0.005, R"({"type": "pin", "bodies": [null, "bead"],
                              "points": [[0, 0, 0], null]})"));
  for (const RunStep& step : run(s, 400)) {
    const Vector3d& p = step.bodies[0].X_WB.position;
    ASSERT_NEAR(p.z(), -std::cos(angle), 1e-4) << step.index;
    ASSERT_NEAR(p.norm(), 1.0, 1e-9) << step.index;
  }
}

}  // namespace
}  // namespace firstcontact
