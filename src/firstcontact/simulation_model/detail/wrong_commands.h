/// @file
/// Refusals of commands that a program may not give to a simulation.

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

/// The reason why a mechanism cannot be in a state; empty if it can.
[[nodiscard]] std::string wrong_state(const Mechanism& mechanism, const MechanismState& state);

/// The joint that positions would place beyond its limits, by more than a simulation does; empty if
/// there is none.
[[nodiscard]] std::string beyond_limits(const SimRobot& robot, const Eigen::VectorXd& positions);

/// The first defect of a surface; empty if there is none.
[[nodiscard]] std::string wrong_surface(const Surface& surface);

/// The first defect of a motor; empty if there is none.
[[nodiscard]] std::string wrong_motor(const JointMotor& motor);

}  // namespace firstcontact::detail
