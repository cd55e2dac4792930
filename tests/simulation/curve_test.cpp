// Contacts on polygons that stand for circles go round as those do, however small the contact
// distance: rings on pins, balls in tubes, discs on their rims.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using test::ball;
using test::body;
using test::numbers;
using test::run;
using test::settings;
using test::simulator;
using test::verify;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// A tube about z of rectangular section, with polygons of n sides.
std::string tube(int n, double inner, double outer, double length) {
  const std::array<std::array<double, 2>, 4> section{{{inner, -0.5 * length},
                                                      {outer, -0.5 * length},
                                                      {outer, 0.5 * length},
                                                      {inner, 0.5 * length}}};
  std::ostringstream vertices;
  std::ostringstream triangles;
  vertices.precision(17);
  for (int k = 0; k < n; ++k) {
    for (int s = 0; s < 4; ++s) {
      const auto& [r, z] = section[static_cast<std::size_t>(s)];
      vertices << (k + s > 0 ? ", [" : "[") << r * std::cos(kTurn * k / n) << ", "
               << r * std::sin(kTurn * k / n) << ", " << z << "]";
      const int a = 4 * k + s;
      const int b = 4 * k + (s + 1) % 4;
      const int c = 4 * ((k + 1) % n) + (s + 1) % 4;
      const int d = 4 * ((k + 1) % n) + s;
      triangles << (k + s > 0 ? ", [" : "[") << a << ", " << d << ", " << c << "], [" << a << ", "
                << c << ", " << b << "]";
    }
  }
  return R"({"vertices": [)" + vertices.str() + R"(], "triangles": [)" + triangles.str() + "]}";
}

const std::string kAboutY = "[1.5707963267948966, 0, 0]";  // Turns z to -y.

std::string turned_to_y(const std::string& name, const std::string& shape,
                        const std::vector<double>& position, const std::string& more) {
  return R"({"name": ")" + name + R"(", "shape": )" + shape + R"(, "pose": {"position": )" +
         numbers(position) + R"(, "rpy": )" + kAboutY + "}" + more + "}";
}

/// The greatest change of energy in a run, and what verify says of it.
struct Kept {
  double worst = 0.0;  // [J]
  double swing = 0.0;  // [J]  The greatest kinetic energy.
  bool is_proven = false;
};

Kept kept_energy(Simulator simulator, std::size_t steps) {
  const std::vector<RunStep> made = run(simulator, steps);
  Kept kept;
  const double first = made.front().kinetic_energy + made.front().potential_energy;
  for (const RunStep& step : made) {
    kept.swing = std::max(kept.swing, step.kinetic_energy);
    kept.worst =
        std::max(kept.worst, std::abs(step.kinetic_energy + step.potential_energy - first));
  }
  kept.is_proven = verify(simulator.header(), made).verdict == ProofVerdict::proven;
  return kept;
}

// A ring hangs on a pin and swings from 60 degrees. A step goes over up to eight of its sides.
TEST(Curve, ARingOnAPinKeepsItsSwing) {
  for (const int sides : {64, 180, 360}) {
    for (const double step : {0.01, 0.005}) {
      constexpr double kGap = 1e-5;
      const double away = 0.48 * std::cos(0.5 * kTurn / sides) - 0.02 - kGap - 0.5e-4;
      const double lean = kTurn / 6.0;
      const Kept kept = kept_energy(
          simulator(turned_to_y("pin", R"({"capsule": {"radius": 0.02, "length": 0.5}})",
                                {0.0, 0.0, 0.0}, "") +
                        ", " +
                        turned_to_y("ring", tube(sides, 0.48, 0.52, 0.05),
                                    {away * std::sin(lean), 0.0, -away * std::cos(lean)},
                                    R"(, "dynamics": {"density": 1000, "locked_translation":
                                    [false, true, false], "locked_rotation": [true, false, true]})"),
                    settings(step, 0.0, kGap)),
          static_cast<std::size_t>(std::lround(1.0 / step)));
      EXPECT_LT(kept.worst, 0.01 * kept.swing) << sides << " " << step;
      EXPECT_TRUE(kept.is_proven) << sides << " " << step;
    }
  }
}

// The other way round: a ball, and a pin of 200 sides, slide in a fixed tube.
TEST(Curve, WhatSlidesInATubeKeepsItsEnergy) {
  const std::string pin = tube(200, 0.01, 0.05, 0.1);
  for (const std::string& slider : {ball("0.05"), pin}) {
    for (const double step : {0.01, 0.005, 0.0025}) {
      constexpr double kGap = 2e-5;
      const double away = 0.3 * std::cos(0.5 * kTurn / 240) - 0.05 - 1e-4;
      const double lean = 0.9;
      const Kept kept = kept_energy(
          simulator(turned_to_y("tube", tube(240, 0.3, 0.35, 1.0), {0.0, 0.0, 0.0}, "") + ", " +
                        turned_to_y("slider", slider,
                                    {away * std::sin(lean), 0.0, -away * std::cos(lean)},
                                    R"(, "dynamics": {"density": 1000})"),
                    settings(step, 0.0, kGap)),
          static_cast<std::size_t>(std::lround(1.0 / step)));
      EXPECT_LT(kept.worst, 0.01 * kept.swing) << step << slider.substr(0, 20);
      EXPECT_TRUE(kept.is_proven) << step;
    }
  }
}

// A disc rolls round on its rim without friction, its centre at rest (H. K. Moffatt, "Euler's disk
// and its finite-time singularity", Nature 404, 2000): a thin disc of radius R that leans by a goes
// round at the rate W, W^2 = 4 g / (R sin a), and turns about the line to its lowest point at
// W sin a. A step goes over up to twenty-five of its sides.
TEST(Curve, ADiscThatRollsOnItsRimKeepsItsEnergy) {
  constexpr double kRadius = 0.05;
  constexpr double kLean = 0.25;
  constexpr double kGap = 1e-6;
  const double I1 = 0.25 * kRadius * kRadius;  // [m^2]  Over the mass.
  const double rate = std::sqrt(9.81 / (I1 / kRadius * std::sin(kLean)));
  for (const double step : {0.01, 0.004, 0.001, 0.0005}) {
    const double height = kRadius * std::sin(kLean) + 5e-4 * std::cos(kLean) + 5e-6;
    std::ostringstream dynamics;
    dynamics.precision(17);
    dynamics << R"(, "dynamics": {"mass": 0.05, "centre_of_mass": [0, 0, 0], "inertia": [[)"
             << 0.05 * I1 << ", 0, 0], [0, " << 0.05 * I1 << ", 0], [0, 0, " << 0.1 * I1
             << R"(]], "angular_velocity": [)" << -rate * std::sin(kLean) * std::cos(kLean)
             << ", 0, " << rate * std::sin(kLean) * std::sin(kLean) << "]}";
    const Kept kept =
        kept_energy(simulator(test::kFloor + R"(, {"name": "disc", "shape": )" +
                                  tube(256, 0.01, kRadius, 1e-3) + R"(, "pose": {"position": )" +
                                  numbers({0.0, 0.0, height}) + R"(, "rpy": [0, 0.25, 0]})" +
                                  dynamics.str() + "}",
                              settings(step, 0.0, kGap)),
                    static_cast<std::size_t>(std::lround(0.3 / step)));
    EXPECT_LT(kept.worst, (step > 2e-3 ? 0.06 : 4e-3) * kept.swing) << step;
    EXPECT_TRUE(kept.is_proven) << step;
  }
}

/// [J]  The most that a coin of 64 corners gains above the lowest energy before, and its energy.
std::array<double, 2> most_gained(double lean, double friction, double rate, double step) {
  std::ostringstream pose;
  pose.precision(17);
  pose << R"({"position": [0, 0, )" << 0.0102 + 0.1 * std::sin(lean) << R"(], "rpy": [)" << lean
       << ", 0, 0]}";
  Simulator s = simulator(test::kFloor + R"(, {"name": "coin", "shape": )" +
                              tube(64, 0.01, 0.1, 0.02) + R"(, "pose": )" + pose.str() +
                              R"(, "dynamics": {"density": 1000, "angular_velocity": [0, )" +
                              std::to_string(rate) + ", 0]}}",
                          settings(step, friction, 1e-4));
  double lowest = std::numeric_limits<double>::infinity();
  std::array<double, 2> most{0.0, 0.0};
  for (const RunStep& at : run(s, static_cast<std::size_t>(std::lround(1.0 / step)))) {
    const double energy = at.kinetic_energy + at.potential_energy;
    lowest = std::min(lowest, energy);
    most = {std::max(most[0], energy - lowest), std::max(most[1], energy)};
  }
  return most;
}

// The lowest point of a coin that settles runs round faster and faster. Nothing may drive it.
TEST(Curve, ACoinThatSettlesGainsNothing) {
  for (const auto& [lean, friction, rate, step] :
       {std::array{0.05, 0.3, 1.0, 0.005}, std::array{0.05, 0.0, 1.0, 0.005},
        std::array{0.05, 0.3, 3.0, 0.005}, std::array{0.1, 0.5, 2.0, 0.005},
        std::array{0.3, 0.5, 2.0, 0.005}, std::array{0.3, 0.0, 2.0, 0.002}}) {
    const auto& [gained, energy] = most_gained(lean, friction, rate, step);
    EXPECT_LT(gained, 2e-3 * energy) << lean << " " << friction << " " << rate << " " << step;
  }
}

// A cone lies on its side and rolls round its tip, which stays where it is: it goes on for ever.
// Its tip is a corner of its mesh, and its base a circle.
TEST(Curve, AConeThatRollsRoundItsTipGoesOn) {
  constexpr double kRadius = 0.1;
  constexpr double kLength = 0.3;
  constexpr double kGap = 1e-4;
  const double half = std::atan2(kRadius, kLength);       // [rad]  Of the opening.
  const double height = 0.75 * kLength * std::sin(half);  // [m]  Of the centre of mass.
  // The base leads along -x, the tip along x; the line on the floor is the momentary axis.
  const double middle = 0.5 * kLength * std::sin(half);  // [m]  Of the origin, halfway up the axis.
  const double rate = 4.0;                               // [rad/s]
  Simulator s = simulator(
      test::kFloor + R"(, {"name": "cone", "shape": {"cone": {"radius": 0.1, "length": 0.3}},
          "pose": {"position": )" +
          numbers({0.0, 0.0, middle + kGap + 1e-5}) + R"(, "rpy": )" +
          numbers({0.0, 0.5 * std::numbers::pi + half, 0.0}) +
          R"(}, "dynamics": {"density": 1000, "angular_velocity": )" + numbers({rate, 0.0, 0.0}) +
          R"(, "linear_velocity": )" + numbers({0.0, -rate * height, 0.0}) + "}}",
      settings(0.01, 0.8, kGap));
  const std::vector<RunStep> steps = run(s, 300);
  const double begin = steps[9].kinetic_energy;
  for (const RunStep& at : steps) {
    EXPECT_NEAR(at.kinetic_energy, begin, 1e-3 * begin) << at.time;
  }
}

// A ball lands on the rim of a fixed disc, its centre beyond the end, and slides off.
TEST(Curve, ABallBesideARimSlidesOff) {
  Simulator s = simulator(
      turned_to_y("disc", tube(64, 0.02, 0.1, 0.04), {0.0, 0.0, 0.0}, "") + ", " +
          body("ball", ball("0.1"), "[0, 0.028, 0.21]", R"(, "dynamics": {"density": 1000})"),
      settings(0.005, 0.0, 1e-4));
  const std::vector<RunStep> steps = run(s, 80);
  const double first = steps.front().kinetic_energy + steps.front().potential_energy;
  for (const RunStep& at : steps) {
    EXPECT_LT(at.kinetic_energy + at.potential_energy, first * (1.0 + 1e-3));
  }
  EXPECT_GT(steps.back().bodies[0].linear_velocity.y(), 0.3);
  EXPECT_LT(steps.back().bodies[0].X_WB.position.z(), 0.15);
}

}  // namespace
}  // namespace firstcontact
