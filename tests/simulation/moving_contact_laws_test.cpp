// Contacts that go over both bodies: faces that rock on round bodies, boxes that tip over edges,
// loaded balls and coins that roll, and friction whose direction turns. Beside exact motions.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
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
using test::verify;

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kGap = 1e-5;      // [m]

/// Integrates y' = f(y) by Runge and Kutta's method of order 4.
template <std::size_t N, class Rate>
std::array<double, N> integrated(std::array<double, N> y, double duration, const Rate& rate) {
  constexpr int kSteps = 4000;
  const double h = duration / kSteps;
  const auto at = [&](const std::array<double, N>& k, double share) {
    std::array<double, N> there = y;
    for (std::size_t i = 0; i < N; ++i) {
      there[i] += share * k[i];
    }
    return there;
  };
  for (int step = 0; step < kSteps; ++step) {
    const auto k1 = rate(y);
    const auto k2 = rate(at(k1, 0.5 * h));
    const auto k3 = rate(at(k2, 0.5 * h));
    const auto k4 = rate(at(k3, h));
    for (std::size_t i = 0; i < N; ++i) {
      y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
  }
  return y;
}

double energy(const RunStep& step) { return step.kinetic_energy + step.potential_energy; }

std::vector<RunStep> run_for(Simulator& s, double duration, double step) {
  return run(s, static_cast<std::size_t>(std::lround(duration / step)));
}

/// A body whose pose turns about y by an angle.
std::string leaning(const std::string& name, const std::string& shape, const Vector3d& position,
                    double angle, const std::string& more) {
  return R"({"name": ")" + name + R"(", "shape": )" + shape + R"(, "pose": {"position": )" +
         numbers({position.x(), position.y(), position.z()}) + R"(, "quaternion_wxyz": )" +
         numbers({std::cos(0.5 * angle), 0.0, std::sin(0.5 * angle), 0.0}) + "}" + more + "}";
}

/// [m]  How far a block that slides across a slope is from its place after a second.
///
/// @param friction  [-]
/// @param speed     [m/s]  across the slope, at the start
double off_across_slope(const std::string& shape, double height, double friction, double speed,
                        double step) {
  constexpr double kSlope = 0.3;
  const double along = kGravity * std::sin(kSlope);
  const double pressing = kGravity * std::cos(kSlope);
  Simulator s = simulator(
      body("floor", box("[99, 99, 1]"), "[0, 0, -0.5]") + ", " +
          body("block", shape, numbers({0.0, 0.0, height + kGap}),
               R"(, "dynamics": {"locked_rotation": [true, true, true], "linear_velocity": )" +
                   numbers({0.0, speed, 0.0}) + "}"),
      settings(step, friction, kGap) + R"(, "gravity": )" + numbers({along, 0.0, -pressing}));
  const auto steps = run_for(s, 1.0, step);
  EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven);
  const auto right = integrated<4>({0.0, 0.0, 0.0, speed}, 1.0, [&](const auto& y) {
    const double slip = std::hypot(y[2], y[3]);
    const double by = slip > 0.0 ? friction * pressing / slip : 0.0;
    return std::array<double, 4>{y[2], y[3], along - by * y[2], -by * y[3]};
  });
  const Vector3d& p = steps.back().bodies[0].X_WB.position;
  return std::hypot(p.x() - right[0], p.y() - right[1]);
}

// Friction opposed the slip at the end of a step: 3.7 mm off at 10 ms, of first order.
TEST(SlidingLaws, FrictionTurnsWithTheSlip) {
  for (const auto& [shape, height] :
       {std::pair{box("[0.2, 0.2, 0.05]"), 0.025}, std::pair{ball("0.1"), 0.1},
        std::pair{box("[0.02, 0.3, 0.3]"), 0.15}}) {
    for (const auto& [friction, speed] :
         {std::pair{0.1, 1.5}, std::pair{0.2, 3.0}, std::pair{0.1, 5.0}}) {
      const double at_20_ms = off_across_slope(shape, height, friction, speed, 0.02);
      const double at_10_ms = off_across_slope(shape, height, friction, speed, 0.01);
      const double at_5_ms = off_across_slope(shape, height, friction, speed, 0.005);
      EXPECT_LE(at_20_ms, 2e-4) << shape << friction;
      EXPECT_LE(at_10_ms, 0.3 * at_20_ms) << shape << friction;
      EXPECT_LE(at_5_ms, 0.3 * at_10_ms) << shape << friction;
    }
  }
}

struct Rocking {
  double off = 0.0;   // [rad]  From the exact lean after a second.
  double gain = 0.0;  // [J]    Most energy above that at the start.
};

/// What rocks: a body of 1 kg whose long axis is x once it has turned about y.
struct Rocker {
  std::string shape;
  double turned = 0.0;     // [rad]     About y.
  double inertia = 0.0;    // [kg m^2]  About y.
  std::string about_axes;  // Keys of its dynamics that follow the mass.
};

const Rocker kPlank{box("[1, 0.4, 0.08]"), 0.0, (1.0 + 0.08 * 0.08) / 12.0, ""};
const std::string kOfRod = R"(, "inertia": [[0.08, 0, 0], [0, 0.08, 0], [0, 0, 0.0008]])";
const Rocker kRod{R"({"capsule": {"radius": 0.04, "length": 1}})", 0.5 * std::numbers::pi, 0.08,
                  kOfRod};
const Rocker kRoller{R"({"cylinder": {"radius": 0.04, "length": 1}})", 0.5 * std::numbers::pi, 0.08,
                     kOfRod};

/// A plank or a rod, 0.04 m from its axis to its side, rocks on a fixed body of radius 0.3 m whose
/// axis is y.
///
/// Law, by the contact's way R phi over the plank: (R^2 phi^2 + h^2 + I) phi'' + R^2 phi phi'^2 +
/// g (R phi cos phi - h sin phi) = 0, with the radius R of the contact and its height h below the
/// plank's centre.
Rocking rocking(const Rocker& rocker, const std::string& base, double step) {
  constexpr double kRadius = 0.3;
  constexpr double kHalf = 0.04;
  constexpr double kLean = 0.3;
  const double R = kRadius + kGap;
  const Vector3d place((R + kHalf) * std::sin(kLean) - R * kLean * std::cos(kLean), 0.0,
                       (R + kHalf) * std::cos(kLean) + R * kLean * std::sin(kLean));
  const std::string below = R"({"name": "base", "shape": )" + base +
                            R"(, "pose": {"rotation_vector": [1.5707963267948966, 0, 0]}})";
  Simulator s = simulator(below + ", " +
                              leaning("rocker", rocker.shape, place, rocker.turned + kLean,
                                      R"(, "dynamics": {"mass": 1)" + rocker.about_axes + "}"),
                          settings(step, 1.0, kGap));
  const auto steps = run_for(s, 1.0, step);
  if (step == 0.01) {
    EXPECT_EQ(verify(s.header(), steps).verdict, ProofVerdict::proven) << base;
  }
  const double r = kRadius + 0.5 * kGap;
  const double h = kHalf + 0.5 * kGap;
  const auto right = integrated<2>({kLean, 0.0}, 1.0, [&](const auto& y) {
    const double pull = kGravity * (r * y[0] * std::cos(y[0]) - h * std::sin(y[0]));
    return std::array<double, 2>{y[1], -(r * r * y[0] * y[1] * y[1] + pull) /
                                           (r * r * y[0] * y[0] + h * h + rocker.inertia)};
  });
  const Vector3d along(std::cos(rocker.turned), 0.0, std::sin(rocker.turned));
  const Vector3d x = steps.back().bodies[0].X_WB.rotation * along;
  Rocking made{.off = std::abs(std::atan2(-x.z(), x.x()) - right[0])};
  for (const RunStep& at : steps) {
    made.gain = std::max(made.gain, energy(at) - energy(steps[0]));
  }
  return made;
}

// The contact stayed at its point of the plank: 2.7e-3 rad off at 5 ms, and of 0.115 J the swing
// gained 9.5e-3 J.
TEST(RollingLaws, APlankRocksOnARoundBody) {
  for (const std::string base :
       {R"({"sphere": {"radius": 0.3}})", R"({"capsule": {"radius": 0.3, "length": 0.6}})",
        R"({"cylinder": {"radius": 0.3, "length": 0.6}})"}) {
    const Rocking at_20_ms = rocking(kPlank, base, 0.02);
    const Rocking at_10_ms = rocking(kPlank, base, 0.01);
    const Rocking at_5_ms = rocking(kPlank, base, 0.005);
    EXPECT_LE(at_20_ms.off, 1.5e-3) << base;
    EXPECT_LE(at_10_ms.off, 0.35 * at_20_ms.off) << base;
    EXPECT_LE(at_5_ms.off, 1.5e-4) << base;
    EXPECT_LE(std::max({at_20_ms.gain, at_10_ms.gain, at_5_ms.gain}), 1e-4) << base;
  }
}

// Two cylinders that cross: the contact goes along both axes.
TEST(RollingLaws, ARodRocksAcrossARoundBody) {
  for (const std::string base :
       {R"({"sphere": {"radius": 0.3}})", R"({"capsule": {"radius": 0.3, "length": 0.6}})",
        R"({"cylinder": {"radius": 0.3, "length": 0.6}})"}) {
    for (const Rocker& rod : {kRod, kRoller}) {
      const Rocking at_20_ms = rocking(rod, base, 0.02);
      const Rocking at_10_ms = rocking(rod, base, 0.01);
      EXPECT_LE(at_20_ms.off, 1.5e-3) << base << rod.shape;
      EXPECT_LE(at_10_ms.off, 0.35 * at_20_ms.off) << base << rod.shape;
      EXPECT_LE(std::max(at_20_ms.gain, at_10_ms.gain), 1e-4) << base << rod.shape;
    }
  }
}

/// The lean of a box without friction that tips over the edge of a table, after 0.3 s.
double tipped(double width, double step) {
  Simulator s =
      simulator(body("table", box("[4, 1, 1]"), "[-2, 0, -0.5]") + ", " +
                    body("box", box(numbers({1.0, width, 0.1})), numbers({0.02, 0.0, 0.05 + kGap}),
                         R"(, "dynamics": {"mass": 1, "linear_velocity": [0.4, 0, 0]})"),
                settings(step, 0.0, kGap));
  const Vector3d x = run_for(s, 0.3, step).back().bodies[0].X_WB.rotation * Vector3d::UnitX();
  return std::atan2(-x.z(), x.x());
}

// The edges of a narrow box cross that of the table, and the contact goes along both. It stayed at
// its points: 6.9e-3 rad beside a wide box at 10 ms, 3.5e-3 rad at 5 ms.
TEST(RollingLaws, ANarrowBoxTipsOverAnEdgeAsAWideOne) {
  for (const double step : {0.02, 0.01, 0.005}) {
    const double wide = tipped(1.6, step);
    EXPECT_GT(wide, 0.05);
    for (const double width : {0.1, 0.2, 0.7}) {
      EXPECT_NEAR(tipped(width, step), wide, 1e-4) << width << " " << step;
    }
  }
}

// A roll was taken for a stop of sliding where friction could have stopped it twice: 7 % of the
// energy was lost in a second at a friction of 1, nothing at 0.5.
TEST(RollingLaws, ALoadedBallRollsAlikeAtAnyFriction) {
  for (const double step : {0.01, 0.005}) {
    Vector3d first = Vector3d::Zero();
    for (const double friction : {0.5, 1.0, 2.0, 5.0}) {
      Simulator s = simulator(test::kFloor + ", " +
                                  body("ball", ball("0.1"), "[0, 0, 0.1001]",
                                       R"(, "dynamics": {"mass": 1, "centre_of_mass":
                                       [-0.0498747, 0, -0.0035369], "inertia":
                                       [[0.002, 0, 0], [0, 0.002, 0], [0, 0, 0.002]]})"),
                              settings(step, friction, 1e-4));
      const auto steps = run_for(s, 1.0, step);
      for (const RunStep& at : steps) {
        EXPECT_NEAR(energy(at), energy(steps[0]), 1e-3) << friction << " " << at.index;
      }
      const Vector3d& p = steps.back().bodies[0].X_WB.position;
      first = friction == 0.5 ? p : first;
      EXPECT_LE((p - first).norm(), 1e-4) << friction << " " << step;
    }
  }
}

/// A coin of radius 0.1 m rolls in a circle of 0.4 m, leaning by 1.1 rad: a steady motion.
std::vector<RunStep> rolling_coin(double friction, double step) {
  Simulator s =
      simulator(test::kFloor +
                    R"(, {"name": "coin", "shape": {"cylinder": {"radius": 0.1, "length": 0.01}},
          "pose": {"position": [0.3590964246577495, 0, 0.09148871661327145],
                   "quaternion_wxyz": [0.8525245220595057, 0, 0.5226872289306592, 0]},
          "dynamics": {"mass": 1, "linear_velocity": [0, 1.021022842921469, 0],
                       "angular_velocity": [-10.13591904480497, 0, -2.315548431359092],
                       "centre_of_mass": [0, 0, 0], "inertia":
                       [[0.00250833333, 0, 0], [0, 0.00250833333, 0], [0, 0, 0.005]]}})",
                settings(step, friction, 1e-4));
  return run_for(s, 1.0, step);
}

// The same fault took 6.3 % of a coin's energy, and 0.21 m of its way.
TEST(RollingLaws, ACoinRollsInItsCircleAtAnyFriction) {
  for (const double step : {0.012, 0.01, 0.006}) {
    for (const double friction : {0.5, 1.0, 3.0}) {
      const auto steps = rolling_coin(friction, step);
      EXPECT_NEAR(energy(steps.back()), energy(steps[0]), 2e-4) << friction << " " << step;
      const Vector3d& p = steps.back().bodies[0].X_WB.position;
      EXPECT_NEAR(std::hypot(p.x(), p.y()), 0.3591, 2e-3) << friction << " " << step;
    }
  }
}

}  // namespace
}  // namespace firstcontact
