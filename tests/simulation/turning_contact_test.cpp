// Contacts that turn with their bodies: what lies on a turntable stays, what slides on a ball keeps
// its energy; errors fall with the square of the step.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::ball;
using test::body;
using test::box;
using test::numbers;
using test::run;
using test::settings;
using test::simulator;

/// A low block on a table that turns at a rate [rad/s] for a second, 0.5 m from its axis.
RunBody on_turntable(double rate, double step) {
  const std::string table =
      R"({"name": "table", "shape": {"box": {"size": [3, 3, 0.1]}}, "motion": {"type":
      "constant_velocity", "from": {"position": [0, 0, -0.05]}, "rotation_vector": )" +
      numbers({0.0, 0.0, rate}) + "}}";
  const std::string block =
      body("block", box("[0.1, 0.1, 0.04]"), "[0.5, 0, 0.0201]",
           R"(, "dynamics": {"linear_velocity": )" + numbers({0.0, 0.5 * rate, 0.0}) +
               R"(, "angular_velocity": )" + numbers({0.0, 0.0, rate}) + "}");
  Simulator s = simulator(table + ", " + block, R"("duration": 1, )" + settings(step, 5.0, 1e-4));
  return run(s, static_cast<std::size_t>(std::lround(1.0 / step))).back().bodies[1];
}

TEST(TurningContact, ABlockStaysOnATurntable) {
  for (const double rate : {0.5, 2.0, 6.0}) {
    for (const double step : {0.02, 0.01, 0.005}) {
      const RunBody end = on_turntable(rate, step);
      const Vector3d& p = end.X_WB.position;
      const double turned = rate * step;
      EXPECT_NEAR(std::hypot(p.x(), p.y()), 0.5, 0.05 * rate * std::pow(turned, 3) + 1e-9)
          << rate << " " << step;
      const double behind = std::remainder(rate - std::atan2(p.y(), p.x()), 2.0 * std::numbers::pi);
      EXPECT_NEAR(behind, 0.0, 0.1 * rate * turned * turned) << rate << " " << step;
      EXPECT_NEAR(end.linear_velocity.norm(), 0.5 * rate, 0.1 * rate * turned * turned);
      EXPECT_NEAR(p.z(), 0.0201, 2e-6);
    }
  }
}

// The contact goes with the ball over the table, and the table is faster farther out: the ball
// rolls in a circle at two sevenths of the table's rate. With a point of the table it spiralled
// inwards, 23 mm in a turn at 10 ms.
TEST(TurningContact, ABallRollsInACircleOnATurntable) {
  constexpr double kRate = 2.0 * 2.0 / 7.0;  // [rad/s]  Of the circle, on a table at 2 rad/s.
  constexpr double kSpeed = 0.3;
  constexpr double kAround = kSpeed / kRate;
  const std::string table = R"({"name": "table", "shape": {"box": {"size": [4, 4, 0.1]}},
      "motion": {"type": "constant_velocity", "from": {"position": [0, 0, -0.05]},
                 "rotation_vector": [0, 0, 6]}, "surface": {"friction": 1}})";
  // It rolls at the start: the table is at rest at its centre.
  const std::string rolling = body("ball", ball("0.05"), "[0, 0, 0.050001]",
                                   R"(, "dynamics": {"linear_velocity": [0.3, 0, 0],
                                       "angular_velocity": [0, 6, 0]})");
  for (const double step : {0.02, 0.01, 0.005}) {
    Simulator s =
        simulator(table + ", " + rolling, R"("duration": 3, )" + settings(step, 1.0, 1e-6));
    const RunBody end = run(s, static_cast<std::size_t>(std::lround(3.0 / step))).back().bodies[1];
    const double turned = 3.0 * kRate;
    const Vector3d right(kAround * std::sin(turned), kAround * (1.0 - std::cos(turned)), 0.050001);
    EXPECT_LT((end.X_WB.position - right).norm(), 1.5 * step * step + 2e-5) << step;
    EXPECT_NEAR(end.linear_velocity.norm(), kSpeed, 0.5 * step * step) << step;
  }
}

// What a belt carries on a table that turns goes straight out as the table sees it. The belt's
// direction of the begin of a step led it, so it lagged by a step: 5e-3 m at 10 ms.
TEST(TurningContact, ABeltOnATurntableCarriesABlockOutwards) {
  const std::string table =
      R"({"name": "table", "shape": {"box": {"size": [3, 3, 0.1]}}, "surface": {"velocity":
      [0.5, 0, 0]}, "motion": {"type": "constant_velocity", "from": {"position": [0, 0, -0.05]},
      "rotation_vector": [0, 0, 1]}})";
  const std::string block =
      body("block", box("[0.1, 0.1, 0.04]"), "[0, 0, 0.0201]",
           R"(, "dynamics": {"linear_velocity": [0.5, 0, 0], "angular_velocity": [0, 0, 1]})");
  for (const double step : {0.02, 0.01, 0.005, 0.0025}) {
    Simulator s = simulator(table + ", " + block, R"("duration": 1, )" + settings(step, 5.0, 1e-4));
    run(s, static_cast<std::size_t>(std::lround(1.0 / step)));
    const Vector3d right(0.5 * std::cos(1.0), 0.5 * std::sin(1.0), 0.0201);
    EXPECT_LE((s.states()[1].X_WB.position - right).norm(), 0.2 * step * step) << step;
  }
}

TEST(TurningContact, ABlockTipsWhereTheTurntableIsTooFast) {
  // A cube at 6 rad/s and 0.5 m: 18 m/s^2 sideways lift it over its edge, as 9.81 m/s^2 hold it.
  const std::string table =
      R"({"name": "table", "shape": {"box": {"size": [3, 3, 0.1]}}, "motion": {"type":
      "constant_velocity", "from": {"position": [0, 0, -0.05]}, "rotation_vector": [0, 0, 3]}})";
  Simulator s = simulator(
      table + ", " +
          body("cube", box("[0.1, 0.1, 0.1]"), "[0.5, 0, 0.0501]",
               R"(, "dynamics": {"linear_velocity": [0, 3, 0], "angular_velocity": [0, 0, 6]})"),
      R"("duration": 0.5, )" + settings(0.01, 5.0, 1e-4));
  const RunBody end = run(s, 10).back().bodies[1];
  EXPECT_GT(end.X_WB.position.z(), 0.055);
}

TEST(TurningContact, ABlockStaysOnAPlateThatTilts) {
  const std::string plate =
      R"({"name": "plate", "shape": {"box": {"size": [2, 1, 0.1]}}, "motion": {"type": "screw",
      "from": {"position": [0, 0, -0.05]}, "axis_point": [0, 0, -0.05], "axis_direction": [0, 1, 0],
      "angle": 0.5}})";
  for (const double step : {0.02, 0.01, 0.005}) {
    Simulator s = simulator(plate + ", " +
                                body("block", box("[0.1, 0.1, 0.1]"), "[0.6, 0, 0.0501]",
                                     R"(, "dynamics": {"linear_velocity": [0.02525, 0, -0.15],
                                   "angular_velocity": [0, 0.25, 0]})"),
                            R"("duration": 2, )" + settings(step, 0.8, 1e-4));
    const RunBody end = run(s, static_cast<std::size_t>(std::lround(2.0 / step))).back().bodies[1];
    const Vector3d from_axis = end.X_WB.position + Vector3d(0.0, 0.0, 0.05);
    const double along = std::cos(0.5) * from_axis.x() - std::sin(0.5) * from_axis.z();
    EXPECT_NEAR(along, 0.6, 0.4 * step * step + 1e-6) << step;
  }
}

/// [J/kg]  The greatest change of the energy of a ball that slides without friction on a ball below
/// it, from 0.2 to 0.7 rad from the top.
double energy_lost_on_a_ball(double step) {
  constexpr double kDistance = 1.0;  // [m]  Between the centres.
  constexpr double kApart = 1e-4;
  const double x = kDistance * std::sin(0.2);
  const double z = kDistance * std::cos(0.2);
  const double speed = std::sqrt(2.0 * 9.81 * kDistance * (1.0 - std::cos(0.2)));
  Simulator s =
      simulator(body("below", ball("0.7999"), "[0, 0, 0]") + ", " +
                    body("ball", ball("0.2"), numbers({x, 0.0, z}),
                         R"(, "dynamics": {"linear_velocity": )" +
                             numbers({speed * std::cos(0.2), 0.0, -speed * std::sin(0.2)}) + "}"),
                settings(step, 0.0, kApart));
  double worst = 0.0;
  for (;;) {
    const RunBody at = s.step().value().bodies[0];
    const Vector3d& p = at.X_WB.position;
    if (std::atan2(p.x(), p.z()) > 0.7) {
      return worst;
    }
    const double energy = 0.5 * at.linear_velocity.squaredNorm() + 9.81 * (p.z() - kDistance);
    worst = std::max(worst, std::abs(energy));
  }
}

TEST(TurningContact, ABallSlidesOffABallWithItsEnergy) {
  for (const double step : {0.01, 0.005, 0.0025, 0.00125}) {
    EXPECT_LT(energy_lost_on_a_ball(step), 10.0 * step * step) << step;
  }
}

}  // namespace
}  // namespace firstcontact
