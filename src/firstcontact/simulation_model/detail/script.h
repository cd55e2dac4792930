/// @file
/// The motions of the scripted bodies of a simulation in a step.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/motion/detail/straight_parts.h>
#include <firstcontact/simulation_model/detail/move.h>

namespace firstcontact {
struct LinksAsBodies;
struct LoadedScene;
}  // namespace firstcontact

namespace firstcontact::detail {

struct SimulationModel;

/// The motions of scripted bodies, over parts of steps in which they are straight.
///
/// A piece of a run moves the body's origin on a line. Where a script bends away from that by more
/// than half the contact distance, the step is taken in parts. A body waits where it would crush an
/// obstacle. Its script is then behind, and goes on later.
class Script {
 public:
  /// @param linked  outlives this object
  Script(const LinksAsBodies& linked, const SimulationModel& model);

  /// [s]  The duration of each part of a step; one part where all scripts are straight.
  ///
  /// @param time    [s]  at which the step begins
  /// @param behind  [s]  time by which the script of each body is behind
  /// @throws std::invalid_argument  if a script moves too wildly for the step
  [[nodiscard]] std::vector<double> parts(double time, const std::vector<double>& behind) const;

  /// The move of each body in a part; zero except for scripted bodies that do not wait.
  ///
  /// @param states  at the begin; bodies that are off their script return to it
  /// @param behind  [s]  time by which the script of each body is behind
  /// @param waits   for each body whether it stands still
  [[nodiscard]] std::vector<Move> moves(const std::vector<RigidState>& states, double time,
                                        double length, const std::vector<double>& behind,
                                        const std::vector<bool>& waits) const;

  /// Lets moving scripted bodies wait in the rest of a step, all links of a robot together.
  ///
  /// @param bodies  in any order
  /// @param moves   moves of the part
  /// @returns whether any of them moved
  bool wait(const std::vector<std::size_t>& bodies, const std::vector<Move>& moves,
            std::vector<bool>& waits) const;

  /// Lets scripts go on that came back, in the last step, to the places where their bodies had to
  /// wait.
  ///
  /// So a press opens when its script has it open.
  ///
  /// @param behind  [s]  at `time`; becomes less where a script came back
  void return_to(const std::vector<RigidState>& states, double time,
                 std::vector<double>& behind) const;

 private:
  [[nodiscard]] double share(double time) const;
  [[nodiscard]] std::vector<double> parts_of(const std::vector<ScriptedMotion>& motions,
                                             double time) const;
  [[nodiscard]] double distance_at(std::size_t mover, const std::vector<RigidState>& states,
                                   double time) const;
  [[nodiscard]] std::optional<double> came_by(std::size_t mover,
                                              const std::vector<RigidState>& states, double stopped,
                                              double time) const;

  const LoadedScene& loaded_;
  double tolerance_;  // [m]
  double step_;       // [s]
  std::vector<std::size_t> bodies_;
  std::vector<ScriptedMotion> motions_;  // For each of them.
  std::vector<std::size_t> movers_;  // For each of them its mover; bodies of the same mover move
                                     // together.
};

}  // namespace firstcontact::detail
