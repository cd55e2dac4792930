// A spring beside the centres of mass of two free bodies, from soft to stiff for the step.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "island/tie_laws.h"
#include "simulation/simulated_run.h"

namespace firstcontact {
namespace {

using test::body;
using test::box;
using test::energy_of;
using test::number_text;
using test::simulator;
using test::tie_settings;

/// Two spinning boxes, whose spring is longer than at rest by about 0.2 m.
Simulator boxes_on_a_spring(double h, double stiffness, double damping) {
  const std::string bodies = body("a", box("[0.2, 0.3, 0.4]"), "[0, 0, 0]",
                                  R"(, "dynamics": {"mass": 1, "linear_velocity": [0, 0.2, 0],
                             "angular_velocity": [3, 6, 9]})") +
                             ", " +
                             body("b", box("[0.5, 0.1, 0.2]"), "[1, 0, 0]",
                                  R"(, "dynamics": {"mass": 2, "linear_velocity": [0, -0.1, 0],
                             "angular_velocity": [-6, 3, 0]})");
  return simulator(bodies, tie_settings(h,
                                        R"({"type": "spring", "bodies": ["a", "b"],
                             "points": [[0.1, 0.15, 0.2], [-0.25, 0.05, 0.1]], "length": 0.4,
                             "stiffness": )" +
                                            number_text(stiffness) + R"(, "damping": )" +
                                            number_text(damping) + "}",
                                        false));
}

/// How much energy two seconds add, as a share of the energy after the first step.
struct Gain {
  double of_a_step = 0.0;  // [-]  The greatest.
  double in_all = 0.0;     // [-]  The greatest since the start.
};

Gain gain_of(double h, double stiffness, double damping) {
  Simulator s = boxes_on_a_spring(h, stiffness, damping);
  const double start = energy_of(s.step().value());
  double before = start;
  Gain gain;
  for (std::size_t k = 1; k < test::steps_until(2.0, h); ++k) {
    const RunStep step = s.step().value();
    EXPECT_EQ(step.time_lost, 0.0);
    gain.of_a_step = std::max(gain.of_a_step, (energy_of(step) - before) / start);
    gain.in_all = std::max(gain.in_all, energy_of(step) / start - 1.0);
    before = energy_of(step);
  }
  return gain;
}

// docs/simulation.md quotes these bounds.
TEST(FreeSpring, GainsLittleEnergyInAnyStep) {
  for (const double h : {2.5e-3, 10e-3, 30e-3}) {
    for (const double stiffness : {30.0, 300.0, 3'000.0, 30'000.0}) {
      for (const double damping : {0.0, 5.0, 50.0}) {
        const Gain gain = gain_of(h, stiffness, damping);
        EXPECT_LE(gain.of_a_step, damping > 0.0 ? 5e-4 : 4e-3) << h << " " << stiffness;
        EXPECT_LE(gain.in_all, damping > 0.0 ? 0.0 : 3e-3) << h << " " << stiffness;
      }
    }
  }
}

}  // namespace
}  // namespace firstcontact
