// Stiff springs beside joints: what brings joints together gives springs no energy.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "island/tie_laws.h"
#include "simulation/simulated_run.h"
#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using test::body;
using test::box;
using test::energy_of;
using test::number_text;
using test::numbers;
using test::Random;
using test::simulator;
using test::tie_settings;

std::string text_of(const Vector3d& v) { return numbers({v.x(), v.y(), v.z()}); }

/// Bodies that move apart from each other, and their ties.
struct TiedBodies {
  std::string bodies;
  std::string ties;
  double energy = 0.0;  // [J]  Kinetic energy before joints take some of it.

  [[nodiscard]] Simulator simulator_with(double h) const {
    return simulator(bodies, tie_settings(h, ties, false));
  }
};

/// Cubes a metre apart. Each hangs on one before it by a joint, and two are on a spring.
TiedBodies random_bodies(Random& random) {
  TiedBodies made;
  const int n = random.chance(0.5) ? 2 : 3;
  for (int i = 0; i < n; ++i) {
    const double size = random.uniform(0.1, 0.3);
    const double mass = random.logarithmic(0.3, 3.0);
    const Vector3d v = random.vector(0.0, 0.5);
    const Vector3d w = random.vector(0.0, 3.0);
    made.energy += 0.5 * mass * (v.squaredNorm() + size * size / 6.0 * w.squaredNorm());
    const std::string name(1, static_cast<char>('a' + i));
    made.bodies +=
        (i == 0 ? "" : ", ") +
        body(name, box(text_of(Vector3d::Constant(size))), numbers({1.0 * i, 0, 0}),
             R"(, "dynamics": {"mass": )" + number_text(mass) + R"(, "linear_velocity": )" +
                 text_of(v) + R"(, "angular_velocity": )" + text_of(w) + "}");
  }
  const auto point = [&] { return text_of(random.vector(0.0, 0.4)); };
  for (int i = 1; i < n; ++i) {
    const bool is_hinge = random.chance(0.5);
    made.ties += R"({"type": ")" + std::string(is_hinge ? "hinge" : "pin") +
                 R"(", "bodies": ["a", ")" + std::string(1, static_cast<char>('a' + i)) +
                 R"("], "points": [)" + point() + ", null]" +
                 (is_hinge ? R"(, "axis": )" + text_of(random.direction()) : "") + "}, ";
  }
  const std::string first = point();
  made.ties +=
      R"({"type": "spring", "bodies": ["a", ")" + std::string(1, static_cast<char>('a' + n - 1)) +
      R"("], "points": [)" + first + ", " + point() + R"(], "stiffness": )" +
      number_text(random.logarithmic(1e5, 1e10)) +
      (random.chance(0.3) ? R"(, "damping": )" + number_text(random.logarithmic(1.0, 1e4)) : "") +
      "}";
  return made;
}

// They made up to ten thousand times the energy in their first step.
TEST(SpringBesideJoint, AddsNoEnergy) {
  Random random(11);
  for (int i = 0; i < 60; ++i) {
    const TiedBodies made = random_bodies(random);
    Simulator s = made.simulator_with(0.01);
    double before = made.energy;
    for (int k = 0; k < 40; ++k) {
      const RunStep step = s.step().value();
      ASSERT_EQ(step.time_lost, 0.0) << i << " " << k;
      ASSERT_LE(energy_of(step), made.energy * (1.0 + 1e-9)) << i << " " << k << made.ties;
      ASSERT_LE(energy_of(step), before + 1e-2 * made.energy) << i << " " << k << made.ties;
      before = energy_of(step);
    }
  }
}

// The same with any stiffness: three boxes of a kilogram.
TEST(SpringBesideJoint, ThreeBoxesKeepTheirEnergy) {
  const std::string bodies =
      body("a", box("[0.5, 0.3, 0.2]"), "[0, 0, 0]",
           R"(, "dynamics": {"mass": 1, "angular_velocity": [0.9, 3, 1.5]})") +
      ", " +
      body("b", box("[0.3, 0.3, 0.4]"), "[1, 0, 0]",
           R"(, "dynamics": {"mass": 1, "angular_velocity": [3, -0.6, 0.3],
                             "linear_velocity": [0, 0.5, 0.2]})") +
      ", " +
      body("c", box("[0.2, 0.2, 0.2]"), "[0, 0, 0.6]",
           R"(, "dynamics": {"mass": 1, "linear_velocity": [0.3, 0.2, 0]})");
  for (const double stiffness : {1e6, 1e7, 1e8, 1e9, 1e10}) {
    Simulator s = simulator(bodies, tie_settings(0.01,
                                                 R"({"type": "spring", "bodies": ["a", "b"],
                                 "points": [[0.1, 0.2, 0], [-0.1, 0, 0.2]], "stiffness": )" +
                                                     number_text(stiffness) +
                                                     R"(}, {"type": "hinge", "bodies": ["a", "c"],
                                 "points": [[0, 0, 0.3], null], "axis": [1, 2, 3]})",
                                                 false));
    for (int k = 0; k < 200; ++k) {
      ASSERT_LE(energy_of(s.step().value()), 0.4531) << stiffness << " " << k;
    }
  }
}

}  // namespace
}  // namespace firstcontact
