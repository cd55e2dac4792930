/// @file
/// The record of a simulation: what it begins with, and its steps.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/record/run_step.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// The origin of a run.
enum class RunKind {
  simulation,  ///< Forces moved its bodies.
  haptics,     ///< Devices moved its tools, which have no energies and impulses.
};

/// The beginning of a run: its scene, the version, the digest of its input, and its masses.
struct RunHeader {
  Scene scene;  ///< The scene with its simulation, resolved: `contact_distance` is given. Its
                ///< text_digest is that of the simulated text.
  std::string version;
  std::string input_digest;  ///< SHA-256 of everything read, in hexadecimal; may be empty.
  std::vector<double> masses =
      {};  ///< [kg]  One for every body; 0 for a body that is neither free nor a link. Link bodies
           ///< have theirs if their robot has dynamics, also on a base that is held.
  std::vector<Eigen::Vector3d> centres_of_mass =
      {};  ///< [m]  p_BC of every body; pivots of the pieces.
  RunKind kind = RunKind::simulation;
};

}  // namespace firstcontact
