/// @file
/// What a step of a simulation begins with.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/simulation_model/detail/move.h>

namespace firstcontact::detail {

struct SimulationModel;

/// What a step of a simulation begins with, for every body.
struct StepStart {
  double time = 0.0;                    ///< [s]  Since the simulation began.
  double h = 0.0;                       ///< [s]  How long the step is to last.
  std::vector<RigidState> states = {};  ///< Velocities of free bodies.
  std::vector<Move> scripted = {};      ///< Over the step; zero but for scripted bodies.
  std::vector<MechanismState> robots = {};
  std::vector<bool> rests = {};   ///< Of every body: found at rest in the step before.
  std::vector<bool> waits = {};   ///< Of every body: its script stands still over the step.
  std::vector<bool> waited = {};  ///< Likewise, in the step before.
  bool begins_step = true;        ///< Or it is a later part of a step in which scripts bend.
};

/// Where a scripted or fixed body is, a share of the step after its begin.
[[nodiscard]] Pose scripted_pose(const SimulationModel& model, const StepStart& start,
                                 std::size_t body, double share);

}  // namespace firstcontact::detail
