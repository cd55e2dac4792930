/// @file
/// The state of a simulation between two steps.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/record/run_step.h>

namespace firstcontact::detail {

/// The data with which a step begins. A recorded step has all of them, so that a resumed run goes
/// on alike.
struct SimulationState {
  std::vector<RigidState> states = {};  ///< One for each body.
  std::vector<MechanismState> robots = {};
  std::vector<bool> rests = {};     ///< For each body: whether it was at rest in the last step.
  std::vector<double> behind = {};  ///< [s]  For each body the time by which its script is behind.
  std::vector<RunContact> contacts = {};  ///< Contacts of the last step, sorted.
  double contacts_lasted = 0.0;           ///< [s]  Time for which they acted.
  std::vector<RunTie> ties = {};          ///< Ties of the last step.
  double time = 0.0;                      ///< [s]
  bool is_stuck = false;                  ///< Whether the last step was lost, or nearly all of it.
  std::size_t count = 0;                  ///< Number of steps.
};

}  // namespace firstcontact::detail
