/// @file
/// A robot of a simulation: its mechanism, and what drives, brakes and stops its joints.

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
  std::size_t number;  ///< Of the scene.
  Mechanism mechanism;
  std::vector<JointLaw> laws;
  MechanismState start;

  /// Whether any joint has a motor, limits, damping or friction.
  [[nodiscard]] bool is_driven() const;

  /// Whether its joints take and give no energy in a motion: nothing brakes or drives them, and
  /// none is at its limits.
  [[nodiscard]] bool is_passive(const Eigen::VectorXd& positions) const;

  /// How many motors there are, and how many of them no effort bounds: they answer impacts.
  [[nodiscard]] std::size_t motor_count() const;
  [[nodiscard]] std::size_t rigid_motor_count() const;

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
