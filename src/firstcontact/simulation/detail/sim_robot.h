/// @file
/// A robot of a simulation: its mechanism, and what drives, brakes and stops its joints.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/robot/mechanism.h>
#include <firstcontact/robot/robot_description.h>
#include <firstcontact/scene/simulation.h>

namespace firstcontact {
struct LinksAsBodies;
struct LoadedScene;
}  // namespace firstcontact

namespace firstcontact::detail {

/// The law of one coordinate, besides gravity, inertia and contacts.
struct JointLaw {
  Eigen::Index position = 0;  ///< Of the mechanism's positions,
  Eigen::Index velocity = 0;  ///< and velocities.
  JointLimits limits = {};
  double damping = 0.0;   ///< [N m s/rad or N s/m]
  double friction = 0.0;  ///< [N m or N]
  std::optional<JointMotor> motor = {};
};

struct SimRobot {
  std::string name;
  std::size_t number;  ///< Of the scene.
  Mechanism mechanism;
  std::vector<JointLaw> laws;
  MechanismState start;

  /// Whether any joint has a motor, limits, damping or friction.
  [[nodiscard]] bool is_driven() const;

  /// How many motors there are, and how many of them no effort bounds: they answer impacts.
  [[nodiscard]] std::size_t motor_count() const;
  [[nodiscard]] std::size_t rigid_motor_count() const;

  /// The drives of a span of time, by Euler's implicit rule; those of motors come first.
  ///
  /// The end of the span decides how far springs reach, how fast dampers move, and where limits
  /// stop.
  ///
  /// @param origin     positions from which the velocities u at the end lead to origin + span u
  /// @param mechanism  its number in the contact problem
  /// @param from       [s]  since the simulation began
  /// @param span       [s]  > 0
  [[nodiscard]] std::vector<JointDrive> drives(const MechanismState& state,
                                               const Eigen::VectorXd& origin, std::size_t mechanism,
                                               double from, double span) const;

  /// The stops that keep displacements [rad or m] in place of velocities within limits.
  [[nodiscard]] std::vector<JointDrive> stops(const MechanismState& state,
                                              std::size_t mechanism_number) const;

  /// [-]  How far the positions of a plan may be followed before a coordinate leaves its limits.
  [[nodiscard]] double share_within_limits(const MechanismState& from,
                                           const Eigen::VectorXd& to) const;

  /// The drives of an impact, which takes no time: what no bounded effort answers. Joints at their
  /// limits stop there, and motors without bound keep their velocity; these come first.
  [[nodiscard]] std::vector<JointDrive> drives_at_impact(const MechanismState& state,
                                                         std::size_t mechanism) const;
};

/// The robots of a scene that have dynamics.
///
/// @param loaded  the scene of which `linked` was made
/// @throws std::invalid_argument  names the robot and its joint or link
[[nodiscard]] std::vector<SimRobot> make_sim_robots(const LoadedScene& loaded,
                                                    const LinksAsBodies& linked);

}  // namespace firstcontact::detail
