/// @file
/// Bodies that move under forces and contacts, and never interpenetrate.

#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/math/export.h>
#include <firstcontact/record/run.h>
#include <firstcontact/robot/mechanism.h>

namespace firstcontact {

struct LoadedScene;

/// A simulation of a scene, advanced step by step.
///
/// Within a step the in-between motion of every body is known, and every pair is proven apart over
/// all of it. When a step's events are spent, it ends at the last time proven free: time is lost,
/// never a distance. The same on every run on one kind of processor.
///
/// Motion between contacts is exact in free flight under constant forces (but for turning, which is
/// of second order in the step); contacts make it of first order.
///
/// Method: free velocities, Gauss' principle at the contacts, first contact over all pairs,
/// everything placed there, the impact projected, and on with the rest of the step. Bodies that
/// cannot influence each other within a step advance apart.
class FIRSTCONTACT_API Simulator {
 public:
  /// Prepares the simulation of a scene.
  ///
  /// @param loaded  with a simulation; the scene's margins keep pairs that much farther apart
  /// @throws std::invalid_argument if there is no simulation, there are deforming bodies, two
  ///         bodies meet at the start (names them), a body's mass cannot be found, a robot cannot
  ///         be simulated (gives the reason), or the contact distance is larger than the smallest
  ///         free body or too small to be proven
  explicit Simulator(const LoadedScene& loaded);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  [[nodiscard]] const RunHeader& header() const;
  /// The scene with links of robots as bodies, the warnings of reading, and the counts of pairs
  /// held apart.
  [[nodiscard]] const LoadedScene& loaded() const;
  [[nodiscard]] double time() const;             ///< [s]  Simulated so far.
  [[nodiscard]] std::size_t step_count() const;  ///< Steps taken.

  /// The states of every body of the scene, then of the pieces of links (LinksAsBodies).
  ///
  /// The velocities of fixed and scripted bodies are those of the last step.
  [[nodiscard]] const std::vector<RigidState>& states() const;

  /// Moves a free body elsewhere, or gives it other velocities.
  ///
  /// @throws std::invalid_argument if the body is not free or a link, a number is not finite, the
  ///         quaternion is zero, or the body would meet another one: then nothing is changed
  void set_state(std::size_t body, const RigidState& state);

  /// The states of all robots that have dynamics.
  [[nodiscard]] const std::vector<MechanismState>& robot_states() const;

  /// Puts a robot elsewhere, or gives it other velocities.
  ///
  /// @param robot  among those that have dynamics
  /// @throws std::invalid_argument if the sizes are not those of the robot, a number is not finite,
  ///         a quaternion is zero, or a link would meet a body: then nothing is changed
  void set_robot_state(std::size_t robot, const MechanismState& state);

  /// Goes on after a step of a run with the same header.
  ///
  /// On the same kind of processor it goes on bit for bit as the run did.
  ///
  /// @throws std::invalid_argument if the step is not of such a run
  void resume(const RunStep& step);

  /// Advances by the scene's step, or as far as could be proven.
  ///
  /// @returns  nothing if it was stopped: then nothing has changed
  [[nodiscard]] std::optional<RunStep> step(const std::stop_token& stop = {});

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace firstcontact
