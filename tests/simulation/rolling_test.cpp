// Balls and rollers on an incline, which is a floor under tilted gravity.

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "simulation/drift.h"

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

constexpr double kRadius = 0.1;  // [m]
constexpr double kGap = 1e-6;    // [m]
constexpr double kSlope = 20.0 * std::numbers::pi / 180.0;
constexpr double kGravity = 9.81;  // [m/s^2]
const std::string kLane = body("floor", box("[99, 9, 1]"), "[0, 0, -0.5]");
const std::string kHeight = numbers({0.0, 0.0, kRadius + kGap});

std::string incline(double step, double friction) {
  return settings(step, friction, kGap) + R"(, "gravity": )" +
         numbers({kGravity * std::sin(kSlope), 0.0, -kGravity * std::cos(kSlope)});
}

/// A roller of radius kRadius about y, for a second: its place is as far off as the gap makes the
/// radius at which it rolls uncertain, whatever the step.
///
/// @param inertia  [-]  about y, over the mass and the square of the radius
void expect_rolling(const std::string& shape, const std::string& turned, double inertia) {
  const double way = 0.5 * kGravity * std::sin(kSlope) / (1.0 + inertia);
  for (const double step : {0.02, 0.01, 0.005}) {
    Simulator s =
        simulator(kLane + R"(, {"name": "roller", "shape": )" + shape +
                      R"(, "pose": {"position": )" + kHeight + turned + R"(}, "dynamics": {}})",
                  incline(step, 0.3));
    const auto steps = static_cast<std::size_t>(std::lround(1.0 / step));
    const RunBody end = run(s, steps).back().bodies[0];
    const double speed = end.linear_velocity.x();
    EXPECT_NEAR(end.X_WB.position.x(), way, kGap / kRadius * way) << step;
    EXPECT_NEAR(speed, 2.0 * way, kGap / kRadius * 2.0 * way) << step;
    EXPECT_NEAR(kRadius * end.angular_velocity.y(), speed, kGap / kRadius * speed) << step;
  }
}

TEST(Rolling, BallOnAnIncline) { expect_rolling(ball(std::to_string(kRadius)), "", 2.0 / 5.0); }

TEST(Rolling, CapsuleOnAnIncline) {
  constexpr double kLength = 0.3;
  const double cylinder = kRadius * kRadius * kLength;  // Volumes over pi.
  const double caps = 4.0 / 3.0 * kRadius * kRadius * kRadius;
  expect_rolling(R"({"capsule": {"radius": 0.1, "length": 0.3}})",
                 R"(, "rpy": [1.5707963267948966, 0, 0])",
                 (0.5 * cylinder + 0.4 * caps) / (cylinder + caps));
}

// Where the slope is steeper than 7/2 of the friction, a ball slips: a = g (sin - mu cos), and it
// turns by 5/2 mu g cos / r.
TEST(Rolling, BallSlipsWhereItIsTooSteep) {
  const double friction = 0.05;
  Simulator s = simulator(kLane + "," + body("ball", ball("0.1"), kHeight, R"(, "dynamics": {})"),
                          incline(0.01, friction));
  const RunBody end = run(s, 100).back().bodies[0];
  const double normal = kGravity * std::cos(kSlope);
  EXPECT_NEAR(end.linear_velocity.x(), kGravity * std::sin(kSlope) - friction * normal, 1e-4);
  EXPECT_NEAR(end.angular_velocity.y(), 2.5 * friction * normal / kRadius, 1e-3);
}

// A ball that is pushed without spin rolls with 5/7 of its speed, whatever the friction.
TEST(Rolling, SlidingBallEndsWithFiveSevenths) {
  for (const double friction : {0.1, 0.4}) {
    Simulator s = simulator(
        kLane + "," +
            body("ball", ball("0.1"), kHeight, R"(, "dynamics": {"linear_velocity": [2, 0, 0]})"),
        settings(0.01, friction, kGap));
    const RunBody end = run(s, 100).back().bodies[0];
    EXPECT_NEAR(end.linear_velocity.x(), 10.0 / 7.0, 1e-4) << friction;
    EXPECT_NEAR(end.angular_velocity.y(), 10.0 / 7.0 / kRadius, 1e-3) << friction;
  }
}

/// A flat floor of 20 by 20 squares of 0.2 m, each cut in two.
std::string cut_floor() {
  std::string vertices;
  std::string triangles;
  const auto add = [](std::string& list, const std::vector<double>& row) {
    list += (list.empty() ? "" : ", ") + numbers(row);
  };
  for (int x = 0; x <= 20; ++x) {
    for (int y = 0; y <= 20; ++y) {
      add(vertices, {-2.0 + 0.2 * x, -2.0 + 0.2 * y, 0.0});
    }
  }
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      const double a = 21 * x + y;
      add(triangles, {a, a + 21, a + 1});
      add(triangles, {a + 1, a + 21, a + 22});
    }
  }
  return body("floor", R"({"vertices": [)" + vertices + R"(], "triangles": [)" + triangles + "]}",
              "[0, 0, 0]");
}

// It fell about an edge for a step where it was just above it.
TEST(Sliding, ABallDoesNotFeelHowItsFloorIsCut) {
  const std::string floor = cut_floor();
  for (const double distance : {1e-3, 1e-4}) {
    for (const double step : {0.01, 0.005, 0.0025}) {
      for (const Vector3d& v : {Vector3d(1.0, 0.3, 0.0), Vector3d(1.0, 0.0, 0.0),
                                Vector3d(0.7, -0.7, 0.0), Vector3d(-0.4, 1.1, 0.0)}) {
        Simulator s = simulator(
            floor + ", " +
                body("ball", ball("0.1"), numbers({-0.1, -0.05, 0.1 + 0.5 * distance}),
                     R"(, "dynamics": {"linear_velocity": )" + numbers({v.x(), v.y(), 0.0}) + "}"),
            settings(step, 0.0, distance));
        for (const RunStep& at : run(s, static_cast<std::size_t>(std::lround(0.8 / step)))) {
          ASSERT_LE((at.bodies[0].linear_velocity - v).norm(), 1e-6) << step << " " << at.time;
        }
      }
    }
  }
}

}  // namespace
}  // namespace firstcontact
