/// @file
/// Settings, exact motions and convergence orders that tests of bodies on ties share.

#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact::test {

/// Writes the keys of a simulation.
inline std::string tie_settings(double step, const std::string& ties, bool has_gravity = true) {
  return R"("duration": 100, "step": )" + number_text(step) + R"(, "contact_distance": 1e-4)" +
         (has_gravity ? "" : R"(, "gravity": [0, 0, 0])") + R"(, "ties": [)" + ties + "]";
}

inline double energy_of(const RunStep& step) { return step.kinetic_energy + step.potential_energy; }

inline std::size_t steps_until(double time, double h) {
  return static_cast<std::size_t>(std::lround(time / h));
}

/// Integrates y' = f(y) over a time, by the Runge-Kutta method in many steps.
template <class Vector, class Rate>
Vector followed(Vector y, double time, const Rate& f) {
  constexpr int kSteps = 20000;
  const double h = time / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const Vector a = f(y);
    const Vector b = f(Vector(y + 0.5 * h * a));
    const Vector c = f(Vector(y + 0.5 * h * b));
    const Vector d = f(Vector(y + h * c));
    y += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return y;
}

/// Expects that the errors in steps of h, h / 2, h / 4 and h / 8 fall by at least this factor each.
inline void expect_order(double h, const std::function<double(double)>& error_with,
                         double factor = 3.5) {
  double before = 0.0;
  for (int halving = 0; halving < 4; ++halving) {
    const double error = error_with(h);
    if (halving > 0) {
      EXPECT_GE(before, factor * error) << "in steps of " << h << ", error " << error;
    }
    before = error;
    h *= 0.5;
  }
}

}  // namespace firstcontact::test
