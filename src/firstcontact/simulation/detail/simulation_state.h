/// @file
/// What a simulation knows between two steps.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/record/run_step.h>

namespace firstcontact::detail {

/// All that a step begins with, and that a recorded step has: a run that is resumed goes on alike.
struct SimulationState {
  std::vector<RigidState> states = {};  ///< Of each body.
  std::vector<MechanismState> robots = {};
  std::vector<bool> rests = {};           ///< Of each body: found at rest in the last step.
  std::vector<double> behind = {};        ///< [s]  Of each body: so much its script is.
  std::vector<RunContact> contacts = {};  ///< Of the last step, sorted.
  double contacts_lasted = 0.0;           ///< [s]  For which they acted.
  std::vector<RunTie> ties = {};          ///< Of the last step.
  double time = 0.0;                      ///< [s]
  bool is_stuck = false;                  ///< The last step was lost, or nearly all of it.
  std::size_t count = 0;                  ///< Of steps.
};

}  // namespace firstcontact::detail
