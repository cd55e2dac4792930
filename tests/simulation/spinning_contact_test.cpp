// Bodies that spin on what they touch: gyroscopic moments act on what contacts change, too. Tops on
// balls as tips, beside Lagrange's equations.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"
#include "simulation/top.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::kMassOfTop;
using test::right_axis;
using test::run;
using test::settings;
using test::simulator;
using test::Top;

Simulator simulation_of(const Top& top, double step, double contact_distance) {
  return simulator(test::kFloor + ", " + test::top_body(top, contact_distance),
                   settings(step, top.friction, contact_distance));
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

// Where a face is cut into triangles is no matter: not even where the tip crosses a cut.
TEST(SpinningContact, ATopDoesNotFeelHowItsFloorIsCut) {
  const Top top{.moments = {6e-4, 6e-4, 3e-4}, .spin = 90.0};
  const auto place = [&](const std::string& floor) {
    Simulator s =
        simulator(floor + ", " + test::top_body(top, 1e-5), settings(0.005, top.friction, 1e-5));
    return run(s, 100).back().bodies[0].X_WB.position;
  };
  const Vector3d on_floor = place(test::kFloor);
  for (const std::string shift : {"[0.3, -0.5, -0.5]", "[0.001, 0.003, -0.5]"}) {
    const Vector3d found = place(test::body("floor", test::box("[9, 9, 1]"), shift));
    EXPECT_LE((found - on_floor).norm(), 1e-7) << shift;
  }
}

// The top has no symmetry, but does not lift off: its energy and its angular momentum about z are
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

/// [rad/s]  The spin of a body that lies on a floor and spun at 3 rad/s, after 0.05 s.
double slowed(const std::string& shape, const std::string& floor) {
  Simulator s =
      simulator(floor + ", " +
                    test::body("puck", shape, "[0, 0, 0.050015]",
                               R"(, "dynamics": {"mass": 1, "angular_velocity": [0, 0, 3]})"),
                settings(0.01, 0.2, 1e-5));
  return run(s, 5).back().bodies[0].angular_velocity.z();
}

/// A mesh of squares of 0.1 m whose corners are beside the origin.
std::string floor_of_squares() {
  constexpr int kCount = 20;
  std::string vertices;
  std::string triangles;
  for (int i = 0; i <= kCount; ++i) {
    for (int k = 0; k <= kCount; ++k) {
      vertices +=
          (vertices.empty() ? "" : ", ") + test::numbers({0.1 * i - 0.98, 0.1 * k - 0.97, 0.0});
      const int corner = i * (kCount + 1) + k;
      if (i < kCount && k < kCount) {
        triangles +=
            (triangles.empty() ? "" : ", ") +
            test::numbers({1.0 * corner, 1.0 * (corner + kCount + 1), corner + 1.0}) + ", " +
            test::numbers({corner + 1.0, 1.0 * (corner + kCount + 1), 1.0 * (corner + kCount + 2)});
      }
    }
  }
  return R"({"name": "floor", "shape": {"vertices": [)" + vertices + R"(], "triangles": [)" +
         triangles + "]}}";
}

// The corners of the overlap alone carry a body. The middle of a cap is a vertex of its fan, and a
// floor may have vertices below the body: a load on these would have no arm.
TEST(SpinningContact, FrictionDoesNotFeelHowFacesAreCut) {
  constexpr double kArm = 0.2;
  const double stop = 0.2 * 9.81 * kArm * 0.05;  // [N m s]
  for (const std::string& floor : {test::kFloor, floor_of_squares()}) {
    const double disc = slowed(R"({"cylinder": {"radius": 0.2, "length": 0.1}})", floor);
    EXPECT_NEAR(disc, 3.0 - stop / (0.5 * kArm * kArm), 2e-3);
    const double side = kArm * std::sqrt(2.0);
    const double block = slowed(test::box(test::numbers({side, side, 0.1})), floor);
    EXPECT_NEAR(block, 3.0 - stop / (side * side / 6.0), 2e-3);
  }
}

}  // namespace
}  // namespace firstcontact
