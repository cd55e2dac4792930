/// @file
/// The data with which a step of a simulation begins.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/simulation_model/detail/move.h>

namespace firstcontact::detail {

struct SimulationModel;

/// The data with which a step begins, for every body.
struct StepStart {
  double time = 0.0;                    ///< [s]  Since the simulation began.
  double h = 0.0;                       ///< [s]  Planned duration of the step.
  std::vector<RigidState> states = {};  ///< Velocities of free bodies.
  std::vector<Move> scripted = {};      ///< Moves over the step; zero except for scripted bodies.
  std::vector<MechanismState> robots = {};
  std::vector<bool> rests = {};  ///< For every body: whether it was at rest in the step before.
  std::vector<bool> waits = {};  ///< For every body: whether its script stands still over the step.
  std::vector<bool> waited = {};  ///< Likewise, in the step before.
  bool begins_step = true;        ///< False for a later part of a step in which scripts bend.
};

/// The pose of a scripted or fixed body, a share of the step after its begin.
[[nodiscard]] Pose scripted_pose(const SimulationModel& model, const StepStart& start,
                                 std::size_t body, double share);

}  // namespace firstcontact::detail
