// Bodies that spin on what they touch: gyroscopic moments act on what contacts change, too. Tops on
// balls as tips, beside Lagrange's equations.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::numbers;
using test::run;
using test::settings;
using test::simulator;

constexpr double kMassOfTop = 0.3;  // [kg]
constexpr double kArm = 0.1;        // [m]  From the centre of the tip to the centre of mass.

struct Top {
  std::array<double, 3> moments{5e-4, 5e-4, 6e-4};  // [kg m^2]  The last one about the axis.
  double spin = 60.0;                               // [rad/s]
  double lean = 0.3;                                // [rad]  About y.
  double friction = 0.0;
};

/// A ball of 2 cm on a floor, with its centre of mass above it.
Simulator simulation_of(const Top& top, double step, double contact_distance) {
  const std::string body =
      R"({"name": "top", "shape": {"sphere": {"radius": 0.02}}, "pose": {"position": )" +
      numbers({0.0, 0.0, 0.02 + contact_distance}) + R"(, "rpy": )" +
      numbers({0.0, top.lean, 0.0}) + R"(}, "dynamics": {"mass": )" + std::to_string(kMassOfTop) +
      R"(, "centre_of_mass": [0, 0, 0.1], "inertia": [)" + numbers({top.moments[0], 0.0, 0.0}) +
      ", " + numbers({0.0, top.moments[1], 0.0}) + ", " + numbers({0.0, 0.0, top.moments[2]}) +
      R"(], "angular_velocity": )" +
      numbers({top.spin * std::sin(top.lean), 0.0, top.spin * std::cos(top.lean)}) + "}}";
  return simulator(test::kFloor + ", " + body, settings(step, top.friction, contact_distance));
}

/// The axis of a symmetric top whose tip slides without friction: its centre of mass goes up and
/// down alone. Lagrange's equations for the angles of Euler, by the rule of Runge and Kutta.
Vector3d right_axis(const Top& top, double time) {
  const double across = top.moments[0];
  const double about_axis = top.moments[2] * top.spin;
  const double about_z = about_axis * std::cos(top.lean);
  const auto rates = [&](const Vector3d& at) -> Vector3d {  // Lean, its rate, angle about z.
    const double s = std::sin(at[0]);
    const double c = std::cos(at[0]);
    const double w = at[1];
    const double round = (about_z - about_axis * c) / (across * s * s);
    const double push = (across * round * round * c - about_axis * round +
                         kMassOfTop * 9.81 * kArm - kMassOfTop * kArm * kArm * w * w * c) *
                        s;
    return {w, push / (across + kMassOfTop * kArm * kArm * s * s), round};
  };
  constexpr int kParts = 20000;
  const double h = time / kParts;
  Vector3d at(top.lean, 0.0, 0.0);
  for (int k = 0; k < kParts; ++k) {
    const Vector3d a = rates(at);
    const Vector3d b = rates(at + 0.5 * h * a);
    const Vector3d c = rates(at + 0.5 * h * b);
    const Vector3d d = rates(at + h * c);
    at += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return {std::sin(at[0]) * std::cos(at[2]), std::sin(at[0]) * std::sin(at[2]), std::cos(at[0])};
}

TEST(SpinningContact, ATopPrecessesAsLagrangeHasIt) {
  for (const Top& top :
       {Top{}, Top{.spin = 150.0}, Top{.moments = {6e-4, 6e-4, 3e-4}, .spin = 90.0},
        Top{.spin = 60.0, .lean = 1.0}}) {
    const Vector3d right = right_axis(top, 0.5);
    for (const double step : {0.005, 0.0025, 0.00125}) {
      Simulator s = simulation_of(top, step, 1e-5);
      const std::vector<RunStep> steps = run(s, static_cast<std::size_t>(std::lround(0.5 / step)));
      const Vector3d axis = steps.back().bodies[0].X_WB.rotation * Vector3d::UnitZ();
      const double turned = top.spin * step;
      EXPECT_LT((axis - right).norm(), 0.15 * turned * turned) << top.spin << " " << step;
    }
  }
}

// Of no symmetry, though it does not lift off: the energy and the angular momentum about z are
// constant.
TEST(SpinningContact, AnUnevenTopKeepsEnergyAndMomentum) {
  const Top top{.moments = {5e-4, 5.3e-4, 7e-4}, .spin = 50.0};
  for (const double step : {0.005, 0.0025, 0.00125}) {
    Simulator s = simulation_of(top, step, 1e-5);
    double energy = 0.0;
    double momentum = 0.0;
    const std::vector<RunStep> steps = run(s, static_cast<std::size_t>(std::lround(1.0 / step)));
    for (const RunStep& at : steps) {
      energy = std::max(energy, std::abs(at.kinetic_energy + at.potential_energy -
                                         steps[0].kinetic_energy - steps[0].potential_energy));
      momentum =
          std::max(momentum, std::abs(at.angular_momentum.z() - steps[0].angular_momentum.z()));
    }
    const double turned = top.spin * step;
    EXPECT_LT(energy, 0.02 * turned * turned * steps[0].kinetic_energy) << step;
    EXPECT_LT(momentum, 3e-3 * turned * turned * steps[0].angular_momentum.norm()) << step;
  }
}

// Fast spins part a step into plans: what a contact carried in all of them is recorded.
TEST(SpinningContact, ImpulsesAreOfTheWholeStep) {
  for (const double spin : {60.0, 100.0001, 300.0}) {
    Simulator s = simulation_of({.spin = spin}, 0.005, 1e-4);
    double impulse = 0.0;  // [N s]
    for (const RunStep& at : run(s, 100)) {
      for (const RunContact& contact : at.contacts) {
        impulse += std::abs(contact.impulse.z());
      }
    }
    EXPECT_NEAR(impulse, kMassOfTop * 9.81 * 0.5, 0.03 * kMassOfTop * 9.81 * 0.5) << spin;
  }
}

// At 0.4 rad a plan the midpoint rule is off by less than a thousandth of the energy.
TEST(SpinningContact, FrictionAddsNoMoreThanTheErrorOfTheRule) {
  for (const double friction : {0.1, 0.5}) {
    for (const double step : {0.01, 0.0025}) {
      Simulator s = simulation_of({.spin = 80.0, .friction = friction}, step, 1e-4);
      double lowest = std::numeric_limits<double>::infinity();
      for (const RunStep& at : run(s, static_cast<std::size_t>(std::lround(0.5 / step)))) {
        const double energy = at.kinetic_energy + at.potential_energy;
        EXPECT_LT(energy, lowest + 1e-3 * energy) << friction << " " << step;
        lowest = std::min(lowest, energy);
      }
    }
  }
}

}  // namespace
}  // namespace firstcontact
