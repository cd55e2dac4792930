/// @file
/// A robot of a simulation: its mechanism, and the drives, brakes and stops of its joints.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/robot/robot_description.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation_model/detail/joint_law.h>

namespace firstcontact {
struct LinksAsBodies;
struct LoadedScene;
}  // namespace firstcontact

namespace firstcontact::detail {

struct SimRobot {
  std::string name;
  std::size_t number;  ///< Index in the scene.
  Mechanism mechanism;
  std::vector<JointLaw> laws;
  MechanismState start;

  /// Whether any joint has a motor, limits, damping or friction.
  [[nodiscard]] bool is_driven() const;

  /// Whether its joints take and give no energy in a motion.
  ///
  /// Then nothing brakes or drives them, and none is at its limits.
  [[nodiscard]] bool is_passive(const Eigen::VectorXd& positions) const;

  /// The number of motors.
  [[nodiscard]] std::size_t motor_count() const;
  /// The number of motors that no effort bounds; they answer impacts.
  [[nodiscard]] std::size_t rigid_motor_count() const;

  /// The stops that keep displacements [rad or m], instead of velocities, within limits.
  [[nodiscard]] std::vector<JointDrive> stops(const MechanismState& state,
                                              std::size_t mechanism_number) const;

  /// [-]  The share of a plan that may be followed before a coordinate leaves its limits.
  [[nodiscard]] double share_within_limits(const MechanismState& from,
                                           const Eigen::VectorXd& to) const;

  /// The drives of an impact, which takes no time, so that no bounded effort acts.
  ///
  /// Motors without bound keep their velocity; these come first. Joints at their limits stop there.
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
