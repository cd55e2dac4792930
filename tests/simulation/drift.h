/// @file
/// Displacement of a simulation's bodies from their start.

#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/simulated_run.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact::test {

/// [m]  Gap at which the bodies of structures rest; they start there.
inline constexpr double kGap = 1e-5;

struct Drift {
  double moved = 0.0;      ///< [m]  Greatest displacement of a centre of mass.
  double turned = 0.0;     ///< [rad]
  double time_lost = 0.0;  ///< [s]
  bool all_sleep = true;   ///< Whether all bodies that can move sleep at the end.
};

/// Simulates for a duration [s], and verifies the run.
inline Drift drift(Simulator& simulator, double duration) {
  const RunHeader& header = simulator.header();
  const std::vector<RigidState> begin = simulator.states();
  const std::vector<RunStep> steps = run(
      simulator, static_cast<std::size_t>(std::lround(duration / header.scene.simulation->step)));
  Drift drift;
  for (const RunStep& step : steps) {
    drift.time_lost += step.time_lost;
  }
  for (const RunBody& body : steps.back().bodies) {
    drift.all_sleep = drift.all_sleep && body.rests;
  }
  for (std::size_t b = 0; b < begin.size(); ++b) {
    const Pose& from = begin[b].X_WB;
    const Pose& to = simulator.states()[b].X_WB;
    const Eigen::Vector3d& p_BC = header.centres_of_mass[b];
    const Eigen::Vector3d way =
        to.position + to.rotation * p_BC - (from.position + from.rotation * p_BC);
    drift.moved = std::max(drift.moved, way.norm());
    drift.turned = std::max(drift.turned, to.rotation.angularDistance(from.rotation));
  }
  EXPECT_EQ(verify(header, steps).verdict, ProofVerdict::proven);
  return drift;
}

/// Expects that bodies at rest move by less than a tenth of their gaps.
inline void expect_rest(const Drift& drift) {
  EXPECT_EQ(drift.time_lost, 0.0);
  EXPECT_LE(drift.moved, 0.1 * kGap);
  EXPECT_LE(drift.turned, 1e-5);
}

}  // namespace firstcontact::test
