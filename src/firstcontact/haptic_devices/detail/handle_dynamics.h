/// @file
/// The motion of a handle that a hand holds, between two ticks.

#pragma once

#include <Eigen/Core>

#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

/// The law of a handle: one spring, damper and inertia with friction, equal along all directions or
/// about all axes.
struct HandleLaw {
  double inertia = 1.0;    ///< [kg], [kg m^2]             > 0.
  double stiffness = 0.0;  ///< [N/m], [N m/rad]           Stiffness of the hand.
  /// [N s/m], [N m s/rad]  Damping of the hand, against the rate of the target.
  double hand_damping = 0;
  double most = 0.0;      ///< [N], [N m]                 Greatest force of the spring.
  double damping = 0.0;   ///< [N s/m], [N m s/rad]       Damping of the mechanism, against rest.
  double friction = 0.0;  ///< [N], [N m]                 Coulomb friction of the mechanism.
};

/// Energies since the begin [J].
struct HandleEnergy {
  double command_work = 0.0;  ///< Done by the commanded force on the handle.
  double hand_work = 0.0;     ///< Done by the hand.
  double dissipated = 0.0;    ///< Taken by the damping and the friction of the mechanism.
};

/// Computes the new rate after one sub-step, and the energies of the step.
///
/// The rule is that of Verlet: half a step of place, a step of rate, half a step of place. Damping
/// acts on the mean of the rates before and after. Friction acts last: it reduces the rate that all
/// other forces give, at most to rest. So friction holds a handle still up to its limit. With D =
/// displacement = (old rate + new rate) h / 2 the change of kinetic energy is exactly command . D +
/// hand . D - dissipated.
///
/// @param deviation    [m], [rad]  target less the place in the middle of the step
/// @param target_rate  [m/s], [rad/s]
/// @param command      [N], [N m]
/// @param h            [s]  > 0
[[nodiscard]] inline Eigen::Vector3d new_rate(const HandleLaw& law, const Eigen::Vector3d& rate,
                                              const Eigen::Vector3d& deviation,
                                              const Eigen::Vector3d& target_rate,
                                              const Eigen::Vector3d& command, double h,
                                              HandleEnergy& energy) noexcept {
  Eigen::Vector3d spring = law.stiffness * deviation;
  const double length = spring.norm();
  if (length > law.most) {
    spring *= law.most / length;
  }
  const double c = law.hand_damping + law.damping;
  const Eigen::Vector3d force = spring + law.hand_damping * target_rate + command;
  const Eigen::Vector3d smooth =
      ((law.inertia - 0.5 * h * c) * rate + h * force) / (law.inertia + 0.5 * h * c);
  const double speed = smooth.norm();
  const double taken = h * law.friction / law.inertia;
  Eigen::Vector3d result = speed > taken ? Eigen::Vector3d((1.0 - taken / speed) * smooth)
                                         : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const Eigen::Vector3d damped = 0.5 * (rate + smooth);
  const Eigen::Vector3d displacement = 0.5 * h * (rate + result);
  energy.command_work += command.dot(displacement);
  energy.hand_work += (spring + law.hand_damping * (target_rate - damped)).dot(displacement);
  energy.dissipated += law.damping * damped.dot(displacement) +
                       law.inertia / h * (smooth - result).dot(displacement);
  return result;
}

}  // namespace firstcontact::detail
