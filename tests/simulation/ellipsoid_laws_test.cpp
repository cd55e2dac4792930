// Ellipsoids on a floor against the equation of their motion, and what becomes of their energy.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/record/run_step.h>

#include "simulation/simulated_run.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;  // [m/s^2]

/// An ellipsoid that rocks without slipping about y on a floor.
struct Rocking {
  Vector3d radii = {0.1, 0.08, 0.05};  // [m]
  double moment = 0.0;                 // [m^2]  Over the mass, about y.
  double lean = 0.3;                   // [rad]

  Rocking() { moment = (radii.x() * radii.x() + radii.z() * radii.z()) / 5.0; }

  [[nodiscard]] double height(double q) const {
    return std::hypot(radii.x() * std::sin(q), radii.z() * std::cos(q));
  }

  /// Computes q'' from q and w = q': 2 T = (moment + h^2 + h'^2) w^2, and the potential is g h.
  [[nodiscard]] double acceleration(double q, double w) const {
    const double h = height(q);
    const double squares = radii.x() * radii.x() - radii.z() * radii.z();
    const double slope = squares * std::sin(q) * std::cos(q) / h;
    const double bend = (squares * std::cos(2.0 * q) - slope * slope) / h;
    const double inertia = moment + h * h + slope * slope;
    return -(w * w * slope * (h + bend) + kGravity * slope) / inertia;
  }

  /// [rad]  By the classical rule of Runge and Kutta.
  [[nodiscard]] double after(double duration) const {
    constexpr int kParts = 20000;
    const double h = duration / kParts;
    double q = lean;
    double w = 0.0;
    for (int k = 0; k < kParts; ++k) {
      const double a1 = acceleration(q, w);
      const double a2 = acceleration(q + 0.5 * h * w, w + 0.5 * h * a1);
      const double a3 = acceleration(q + 0.5 * h * (w + 0.5 * h * a1), w + 0.5 * h * a2);
      const double a4 = acceleration(q + h * (w + 0.5 * h * a2), w + h * a3);
      q += h * w + h * h / 6.0 * (a1 + a2 + a3);
      w += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    return q;
  }

  /// [rad]  As simulated.
  [[nodiscard]] double simulated(double duration, double step) const {
    constexpr double kGap = 1e-6;  // [m]
    Simulator s = test::simulator(
        test::kFloor + R"(, {"name": "egg", "shape": {"ellipsoid": {"radii": [0.1, 0.08, 0.05]}},
            "pose": {"position": )" +
            test::numbers({0.0, 0.0, height(lean) + kGap}) + R"(, "quaternion_wxyz": )" +
            test::numbers({std::cos(0.5 * lean), 0.0, std::sin(0.5 * lean), 0.0}) +
            R"(}, "dynamics": {"mass": 1, "centre_of_mass": [0, 0, 0], "inertia": [[1, 0, 0], [0, )" +
            std::to_string(moment) + R"(, 0], [0, 0, 1]]}})",
        test::settings(step, 2.0, kGap));
    const auto steps = static_cast<std::size_t>(std::lround(duration / step));
    const Vector3d up = test::run(s, steps).back().bodies[0].X_WB.rotation * Vector3d::UnitZ();
    return std::atan2(up.x(), up.z());
  }
};

// Larger steps are made of shorter plans, so the error grows by less than its bound.
TEST(Ellipsoids, RockToSecondOrderInTheStep) {
  const Rocking egg;
  const double right = egg.after(1.0);
  for (const double step : {0.01, 0.005, 0.0025, 0.00125}) {
    EXPECT_LE(std::abs(egg.simulated(1.0, step) - right), 70.0 * step * step) << step;
  }
}

/// [rad]  The angle from upright of what rolls down on the outside of a round of 0.3 m, from rest
/// at 0.3 rad.
///
/// @param radius   [m]  of what rolls
/// @param inertia  [-]  its moment of inertia, by mass and radius
double rolled_down(double radius, double inertia, double duration) {
  constexpr int kParts = 20000;
  const double h = duration / kParts;
  const double factor = kGravity / ((0.3 + radius) * (1.0 + inertia));
  double q = 0.3;
  double w = 0.0;
  for (int k = 0; k < kParts; ++k) {  // Each half of the leapfrog is exact enough at these parts.
    w += 0.5 * h * factor * std::sin(q);
    q += h * w;
    w += 0.5 * h * factor * std::sin(q);
  }
  return q;
}

// The side of a cylinder bends away below the egg. As a plane it would hold its normal in a step.
TEST(Ellipsoids, RollDownTheSideOfACylinder) {
  constexpr double kGap = 1e-6;  // [m]
  constexpr double kEnd = 0.3;   // [s]
  const Vector3d place = (0.38 + kGap) * Vector3d(std::sin(0.3), 0.0, std::cos(0.3));
  const double right = rolled_down(0.08, 0.4, kEnd);
  for (const double step : {0.01, 0.005, 0.0025}) {
    Simulator s = test::simulator(
        R"({"name": "drum", "shape": {"cylinder": {"radius": 0.3, "length": 1}},
            "pose": {"rotation_vector": [1.5707963267948966, 0, 0]}},
           {"name": "egg", "shape": {"ellipsoid": {"radii": [0.08, 0.2, 0.08]}},
            "pose": {"position": )" +
            test::numbers({place.x(), place.y(), place.z()}) + R"(}, "dynamics": {"mass": 1}})",
        test::settings(step, 2.0, kGap));
    const std::vector<RunStep> steps =
        test::run(s, static_cast<std::size_t>(std::lround(kEnd / step)));
    const Vector3d end = steps.back().bodies[0].X_WB.position;
    EXPECT_NEAR(std::atan2(end.x(), end.z()), right, 20.0 * step * step) << step;
    EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << step;
  }
}

// An egg that spins on a floor gains no energy, however fast it is.
TEST(Ellipsoids, ThatSpinGainNoEnergy) {
  for (const std::string spin : {"[3, 8, 20]", "[40, 5, 10]", "[5, 30, 30]"}) {
    Simulator s = test::simulator(
        test::kFloor + R"(, {"name": "egg", "shape": {"ellipsoid": {"radii": [0.06, 0.05, 0.04]}},
            "pose": {"position": [0, 0, 0.07]}, "dynamics": {"mass": 1, "angular_velocity": )" +
            spin + "}}",
        test::settings(0.005, 0.3, 1e-5));
    const std::vector<RunStep> steps = test::run(s, 400);
    double least = std::numeric_limits<double>::infinity();
    for (const RunStep& step : steps) {
      const double energy = step.kinetic_energy + step.potential_energy;
      EXPECT_LE(energy, least + 2e-3) << spin << " " << step.time;
      least = std::min(least, energy);
    }
    EXPECT_EQ(test::verify(s.header(), steps).verdict, ProofVerdict::proven) << spin;
  }
}

/// The energy of a body of 1 kg over 0.7 s.
struct Energies {
  double begin = 0.0;  // [J]
  double end = 0.0;    // [J]
  double gain = 0.0;   // [J]  From the least before on.
};

/// An ellipsoid that begins to lean about y on a floor.
Energies energies_of(const std::vector<double>& radii, double lean, double step,
                     const std::string& velocity, double friction) {
  constexpr double kGap = 1e-4;  // [m]
  const double height = std::hypot(radii[0] * std::sin(lean), radii[2] * std::cos(lean));
  Simulator s = test::simulator(
      test::kFloor + R"(, {"name": "lens", "shape": {"ellipsoid": {"radii": )" +
          test::numbers(radii) + R"(, "enclosure_error": 1e-4}}, "pose": {"position": )" +
          test::numbers({0.0, 0.0, height + kGap}) + R"(, "rpy": )" +
          test::numbers({0.0, lean, 0.0}) + R"(}, "dynamics": {"mass": 1, "angular_velocity": )" +
          velocity + "}}",
      test::settings(step, friction, kGap));
  const std::vector<RunStep> steps =
      test::run(s, static_cast<std::size_t>(std::lround(0.7 / step)));
  const auto past_the_first_flat_side = steps.begin() + std::lround(0.2 / step);
  EXPECT_EQ(test::verify(s.header(), {steps.begin(), past_the_first_flat_side}).verdict,
            ProofVerdict::proven);
  const auto energy_of = [](const RunStep& at) { return at.kinetic_energy + at.potential_energy; };
  Energies found{.begin = energy_of(steps[0]), .end = energy_of(steps.back())};
  double least = found.begin;
  for (const RunStep& at : steps) {
    found.gain = std::max(found.gain, energy_of(at) - least);
    least = std::min(least, energy_of(at));
  }
  return found;
}

/// [J]  A lift by the contact distance.
constexpr double kLift = kGravity * 1e-4;

// The contact runs over the flat side of a lens of 20:1 within half of a step. Without friction
// the lens rocks for ever, and presses the floor all the time.
TEST(Ellipsoids, KeepTheirEnergyOverAFlatSide) {
  for (const std::vector<double>& radii : {std::vector<double>{0.1, 0.1, 0.005},
                                           {0.1, 0.1, 0.01},
                                           {0.1, 0.1, 0.02},
                                           {0.2, 0.02, 0.02}}) {
    for (const double step : {0.01, 0.005}) {
      const Energies found = energies_of(radii, 1.0, step, "[0, 0, 0]", 0.0);
      EXPECT_LE(found.gain, kLift) << radii[2] << " " << step;
      EXPECT_GE(found.end, found.begin - 60.0 * step * step) << radii[2] << " " << step;
    }
  }
}

// Nor do they gain any where they slide and spin.
TEST(Ellipsoids, FlatOnesGainNoEnergy) {
  EXPECT_LE(energies_of({0.1, 0.1, 0.005}, 0.5, 0.01, "[0, 0, 15]", 0.0).gain, kLift);
  EXPECT_LE(energies_of({0.1, 0.1, 0.005}, 0.5, 0.01, "[3, 20, 5]", 0.3).gain, kLift);
}

// Three lenses that soft springs tie to each other roll over their flat sides at different times:
// one of them alone may gain a lift in a step.
TEST(Ellipsoids, FewThatMoveTogetherGainNoEnergy) {
  std::string bodies = test::kFloor;
  std::string ties;
  for (int k = 0; k < 3; ++k) {
    const double lean = 1.0 - 0.13 * k;
    const double height = 1.003 * std::hypot(0.1 * std::sin(lean), 0.005 * std::cos(lean)) + 2e-4;
    const std::string name = "lens" + std::to_string(k);
    bodies += R"(, {"name": ")" + name + R"(", "shape": {"ellipsoid": {"radii": [0.1, 0.1, 0.005],
        "enclosure_error": 1e-4}}, "pose": {"position": )" +
              test::numbers({0.0, 0.5 * k, height}) + R"(, "rpy": )" +
              test::numbers({0.0, lean, 0.0}) + R"(}, "dynamics": {"mass": 1}})";
    if (k > 0) {
      ties += std::string(k > 1 ? ", " : "") + R"({"type": "spring", "bodies": ["lens)" +
              std::to_string(k - 1) + R"(", ")" + name +
              R"("], "points": [[0, 0, 0], [0, 0, 0]], "length": 0.5, "stiffness": 0.01})";
    }
  }
  Simulator s =
      test::simulator(bodies, test::settings(0.01, 0.0, 1e-4) + R"(, "ties": [)" + ties + "]");
  double least = std::numeric_limits<double>::infinity();
  for (const RunStep& at : test::run(s, 50)) {
    const double energy = at.kinetic_energy + at.potential_energy;
    EXPECT_LE(energy, least + 3.0 * kLift) << at.time;
    least = std::min(least, energy);
  }
  EXPECT_GE(least, 2.251 - 0.05);
}

}  // namespace
}  // namespace firstcontact::detail
