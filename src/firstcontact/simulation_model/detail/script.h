/// @file
/// What the scripted bodies of a simulation do in a step.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/motion/detail/straight_parts.h>
#include <firstcontact/simulation_model/detail/move.h>

namespace firstcontact {
struct LoadedScene;
}  // namespace firstcontact

namespace firstcontact::detail {

struct SimulationModel;

/// The motions of scripted bodies, over parts of steps in which they are straight.
///
/// A piece of a run moves the body's origin on a line. Where a script bends away from that by more
/// than half the contact distance, the step is taken in parts.
class Script {
 public:
  /// @param loaded  outlives this
  Script(const LoadedScene& loaded, const SimulationModel& model);

  /// [s]  How long each part of a step lasts: one, where all scripts are straight.
  ///
  /// @param time  [s]  at which the step begins
  /// @throws std::invalid_argument  if a script moves too wildly for the step
  [[nodiscard]] std::vector<double> parts(double time) const;

  /// What each body does in a part; nothing but for scripted ones.
  ///
  /// @param states  at the begin; bodies that are off their script return to it
  [[nodiscard]] std::vector<Move> moves(const std::vector<RigidState>& states, double time,
                                        double length) const;

 private:
  [[nodiscard]] double share(double time) const;

  const LoadedScene& loaded_;
  double tolerance_;  // [m]
  double step_;       // [s]
  std::vector<std::size_t> bodies_;
  std::vector<ScriptedMotion> motions_;  // Of each of them.
};

}  // namespace firstcontact::detail
