/// @file
/// What a program may not ask of a simulation.

#pragma once

#include <string>

#include <Eigen/Core>

namespace firstcontact {
class Mechanism;
struct JointMotor;
struct MechanismState;
struct Surface;
}  // namespace firstcontact

namespace firstcontact::detail {

struct SimRobot;

/// Whether a quaternion can be made a unit one.
[[nodiscard]] bool is_rotation(const Eigen::Vector4d& q);

/// What keeps a mechanism from being in a state; empty if nothing does.
[[nodiscard]] std::string wrong_state(const Mechanism& mechanism, const MechanismState& state);

/// Which joint positions would place beyond its limits, by more than a simulation does; empty if
/// they place none.
[[nodiscard]] std::string beyond_limits(const SimRobot& robot, const Eigen::VectorXd& positions);

/// The first thing that is wrong with a surface; empty if nothing is.
[[nodiscard]] std::string wrong_surface(const Surface& surface);

/// The first thing that is wrong with a motor; empty if nothing is.
[[nodiscard]] std::string wrong_motor(const JointMotor& motor);

}  // namespace firstcontact::detail
