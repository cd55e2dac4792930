#include <firstcontact/simulation_model/detail/wrong_commands.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <firstcontact/math/number_text.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/sim_robot.h>

namespace firstcontact::detail {
namespace {

std::string wrong_target(const std::vector<TimedNumber>& target) {
  if (target.empty()) {
    return "expected a target";
  }
  for (std::size_t k = 0; k < target.size(); ++k) {
    if (!std::isfinite(target[k].number) || !std::isfinite(target[k].time)) {
      return "a target must be finite";
    }
    if (k > 0 && !(target[k - 1].time < target[k].time)) {
      return "the times of a target must increase";
    }
  }
  return {};
}

}  // namespace

bool is_rotation(const Eigen::Vector4d& q) { return q.norm() > 0.0 && std::isfinite(q.norm()); }

std::string wrong_state(const Mechanism& mechanism, const MechanismState& state) {
  if (state.positions.size() != mechanism.position_count() ||
      state.velocities.size() != mechanism.size() || !state.positions.allFinite() ||
      !state.velocities.allFinite()) {
    return "expected " + std::to_string(mechanism.position_count()) + " positions and " +
           std::to_string(mechanism.size()) + " velocities, all finite";
  }
  for (const MechanismJoint& joint : mechanism.joints()) {
    const std::optional<Eigen::Index> at = joint.quaternion();
    if (at && !is_rotation(state.positions.segment<4>(*at))) {
      return "positions " + std::to_string(*at) + " to " + std::to_string(*at + 3) +
             " are a quaternion, which must not be zero";
    }
  }
  return {};
}

std::string beyond_limits(const SimRobot& robot, const Eigen::VectorXd& positions) {
  for (const JointLaw& law : robot.laws) {
    const double q = positions[law.position];
    if (q < law.limits.lower.value_or(q) - kMostBeyondLimit ||
        q > law.limits.upper.value_or(q) + kMostBeyondLimit) {
      const auto text = [](const std::optional<double>& limit) {
        return limit ? detail::shortest(*limit) : std::string("none");
      };
      return "positions[" + std::to_string(law.position) + "] is " + detail::shortest(q) +
             ", beyond the limits of its joint: lower " + text(law.limits.lower) + ", upper " +
             text(law.limits.upper);
    }
  }
  return {};
}

std::string wrong_surface(const Surface& surface) {
  if (!(surface.friction.value_or(0.0) >= 0.0) || !std::isfinite(surface.friction.value_or(0.0))) {
    return "friction must be >= 0 and finite";
  }
  const double restitution = surface.restitution.value_or(0.0);
  if (!(restitution >= 0.0 && restitution <= 1.0)) {
    return "restitution must be in [0, 1]";
  }
  if (surface.velocity && !surface.velocity->allFinite()) {
    return "velocity must be finite";
  }
  return {};
}

std::string wrong_motor(const JointMotor& motor) {
  if (std::string wrong = wrong_target(motor.target); !wrong.empty()) {
    return wrong;
  }
  const bool is_spring = motor.kind == JointMotor::Kind::position && motor.stiffness;
  if (motor.stiffness && !is_spring) {
    return "stiffness is for a position";
  }
  if (is_spring && !(*motor.stiffness > 0.0 && std::isfinite(*motor.stiffness))) {
    return "stiffness must be > 0 and finite";
  }
  if (!(motor.damping >= 0.0 && std::isfinite(motor.damping))) {
    return "damping must be >= 0 and finite";
  }
  if (motor.damping > 0.0 && !is_spring) {
    return "damping needs a position with stiffness";
  }
  if (motor.effort && !(*motor.effort >= 0.0 && std::isfinite(*motor.effort))) {
    return "effort must be >= 0 and finite";
  }
  return {};
}

}  // namespace firstcontact::detail
