/// @file
/// Bodies that move under forces and contacts, and never interpenetrate.

#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/record/run.h>
#include <firstcontact/scene/simulation.h>

namespace firstcontact {

struct LoadedScene;

/// A simulation of a scene, advanced step by step.
///
/// Within a step the in-between motion of every body is known, and every pair is proven apart over
/// all of it. When a step's events are spent, it ends at the last time proven free: time is lost,
/// never a distance. Or a script that would crush something waits (JamRule). The run is the same
/// every time on one kind of processor.
///
/// In free flight under constant forces the motion is exact, except for rotation, which is of
/// second order in the step. In contact the motion is of second order, too. It is of first order
/// where a contact begins, ends or sticks within a step, or motors hold a robot nearly still.
///
/// Method: a step begins with free velocities and Gauss' principle at the contacts. The first
/// contact over all pairs ends this motion. All bodies are placed there, the impact is projected,
/// and the rest of the step follows. Bodies that cannot influence each other within a step advance
/// separately.
class FIRSTCONTACT_API Simulator {
 public:
  /// Prepares the simulation of a scene.
  ///
  /// @param loaded  with a simulation; the scene's margins keep pairs that much farther apart
  /// @throws std::invalid_argument  there is no simulation; there are deforming bodies; two bodies
  ///         meet at the start (names them); a body's mass cannot be found; a robot cannot be
  ///         simulated (gives the reason); the contact distance is larger than the smallest free
  ///         body, or too small to be proven
  explicit Simulator(const LoadedScene& loaded);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  [[nodiscard]] const RunHeader& header() const;
  /// The scene with links of robots as bodies, the warnings of reading, and the counts of pairs
  /// that are held apart.
  [[nodiscard]] const LoadedScene& loaded() const;
  [[nodiscard]] double time() const;             ///< [s]  Simulated time so far.
  [[nodiscard]] std::size_t step_count() const;  ///< Number of steps so far.

  /// The states of every body of the scene, then of the link bodies (LinksAsBodies).
  ///
  /// The velocities of fixed and scripted bodies are those of the last step.
  [[nodiscard]] const std::vector<RigidState>& states() const;

  /// Moves a free body elsewhere, or gives it other velocities.
  ///
  /// Where it throws, nothing is changed.
  ///
  /// @throws std::invalid_argument if the body is not free or a link, a number is not finite or
  ///         beyond 1e60, the quaternion is zero, the body would meet another one, or a tie would
  ///         be torn
  void set_state(std::size_t body, const RigidState& state);

  /// The states of all robots that have dynamics.
  [[nodiscard]] const std::vector<MechanismState>& robot_states() const;

  /// Puts a robot elsewhere, or gives it other velocities.
  ///
  /// Where it throws, nothing is changed.
  ///
  /// @param robot  among those that have dynamics
  /// @throws std::invalid_argument if the sizes are not those of the robot, a number is not finite,
  ///         a quaternion is zero, a joint would be beyond its limits, a link would meet a body, or
  ///         a tie would be torn
  void set_robot_state(std::size_t robot, const MechanismState& state);

  /// Adds a force and a torque to those on a free body or a link body, for the next step alone.
  ///
  /// They are constant over the step. Forces of several calls add up.
  ///
  /// @param force    [N]    World axes.
  /// @param torque   [N m]  World axes.
  /// @param p_WP     [m]    The point that the force acts on, which adds a torque; the centre of
  ///                        mass where none is given.
  /// @throws std::invalid_argument if the body is neither free nor of a robot with dynamics, or a
  ///         number is not finite or beyond 1e60
  void apply_force(std::size_t body, const Eigen::Vector3d& force,
                   const Eigen::Vector3d& torque = Eigen::Vector3d::Zero(),
                   const std::optional<Eigen::Vector3d>& p_WP = {});

  /// Gives a joint of a robot a motor, in place of its present one, from the next step on.
  ///
  /// @param robot  among those that have dynamics
  /// @param joint  the name of a joint of one coordinate
  /// @param motor  with a target; times are those of the simulation
  /// @throws std::invalid_argument  there is no such robot or joint; the motor has no target; a
  ///         number is not finite, or negative where it must not be; times do not increase
  void set_motor(std::size_t robot, std::string_view joint, const JointMotor& motor);

  /// The motor of a joint; none where it has none. Throws as set_motor().
  [[nodiscard]] std::optional<JointMotor> motor(std::size_t robot, std::string_view joint) const;

  /// Changes gravity [m/s^2] from the next step on. Potential energies are those of the new field.
  ///
  /// @throws std::invalid_argument if a number is not finite or beyond 1e60
  void set_gravity(const Eigen::Vector3d& gravity);

  /// Changes the given values of the surface of a body, from the next step on.
  ///
  /// @throws std::invalid_argument if there is no such body, or a number is out of its range
  void set_surface(std::size_t body, const Surface& surface);

  /// Changes the given values of the surface of a pair, in place of those of the two surfaces.
  ///
  /// @throws std::invalid_argument if there is no such body, or a number is out of its range; for a
  ///         velocity, which pairs do not have
  void set_pair_surface(const BodyPair& bodies, const Surface& surface);

  /// Limits the threads that advance islands of bodies. The bits of a run do not depend on it.
  ///
  /// @param threads  0 for one on each core, as without this call
  /// @throws std::invalid_argument if it is negative
  void set_threads(int threads);

  /// Goes on after a step of a run with the same header.
  ///
  /// On the same kind of processor it goes on bit for bit as the run did. A record has no commands.
  /// The caller sets motors, gravity and surfaces before this call, as they wake sleeping bodies.
  /// Forces are applied after it.
  ///
  /// @throws std::invalid_argument if the step moves other bodies or joints than this scene does
  void resume(const RunStep& step);

  /// Advances by the scene's step, or as far as could be proven.
  ///
  /// Where it was stopped, or throws, nothing has changed.
  ///
  /// @returns nothing if it was stopped
  [[nodiscard]] std::optional<RunStep> step(const std::stop_token& stop = {});

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace firstcontact
