/// @file
/// Mass and motion of one rigid body: its kinetic metric, energy, momentum and free flight.

#pragma once

#include <array>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The mass and the rotational inertia of a body, and its locked axes. These are axes of the world.
struct Inertia {
  double mass = 1.0;                                        ///< [kg]  > 0
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();           ///< [m]  Centre of mass.
  Eigen::Matrix3d about_C_B = Eigen::Matrix3d::Identity();  ///< [kg m^2]  Body axes; definite.
  std::array<bool, 3> locked_translation{};
  std::array<bool, 3> locked_rotation{};
};

/// The pose and the velocity of a body.
struct RigidState {
  Pose X_WB;
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();  ///< [m/s]  Velocity of the centre of mass.
  Eigen::Vector3d w_WB = Eigen::Vector3d::Zero();  ///< [rad/s]  Angular velocity.
};

/// The inverse of the kinetic metric on velocities (v_WC, w_WB), in world axes.
///
/// Locked directions have inverse mass 0. A body that nothing moves has zeros only.
struct InverseInertia {
  Eigen::Vector3d mass = Eigen::Vector3d::Zero();      ///< [1/kg]  Diagonal.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();  ///< [1/(kg m^2)]
};

/// [m]  The centre of mass in the world, p_WC.
[[nodiscard]] FIRSTCONTACT_API Eigen::Vector3d centre_of_mass(const Inertia& inertia,
                                                              const Pose& X_WB);

/// [kg m^2]  The rotational inertia about C, in world axes.
[[nodiscard]] FIRSTCONTACT_API Eigen::Matrix3d rotational_inertia(const Inertia& inertia,
                                                                  const Pose& X_WB);

/// The inverse inertia of a body at a pose, in world axes.
[[nodiscard]] FIRSTCONTACT_API InverseInertia inverse_inertia(const Inertia& inertia,
                                                              const Pose& X_WB);

/// [J]  The kinetic energy of a body.
[[nodiscard]] FIRSTCONTACT_API double kinetic_energy(const Inertia& inertia,
                                                     const RigidState& state);

/// Whether at least one axis of rotation is locked.
[[nodiscard]] FIRSTCONTACT_API bool is_locked(const Inertia& inertia);

/// Whether every axis is a principal one, to 1e-9 of the moments. Then no gyroscopic moment acts.
[[nodiscard]] FIRSTCONTACT_API bool is_isotropic(const Inertia& inertia);

/// [rad/s]  The angular velocity of a body after a turn that carries the velocity along.
///
/// In the body's axes it is unchanged, and so is the kinetic energy. The difference of two
/// velocities of the same orientation changes the energy as it would before the turn. Where axes
/// are locked or all axes are principal ones, the velocity is unchanged in the world.
[[nodiscard]] FIRSTCONTACT_API Eigen::Vector3d turned_along(const Inertia& inertia,
                                                            const Eigen::Vector3d& w_WB,
                                                            const Eigen::Vector3d& rotation_vector);

/// [rad/s^2]  The angular acceleration without torque, by gyroscopic moments alone.
///
/// Euler's equation gives it, I dw/dt = (I w) x w. It is 0 where locked axes keep the velocity
/// fixed.
[[nodiscard]] FIRSTCONTACT_API double tumbling_acceleration(const Inertia& inertia,
                                                            const RigidState& state);

/// The turn of a body over a time without contacts.
struct FreeTurn {
  /// [rad]  The turn over the whole time.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB = Eigen::Vector3d::Zero();  ///< [rad/s]  The angular velocity at its end.
};

/// Computes how a body turns over a time without contacts.
///
/// The angular momentum and the energy are kept to rounding, but for the work of the torque. Where
/// axes are locked, the error of the energy is of second order.
///
/// The answer is one rotation at a constant rate from the first orientation to the last. Among the
/// rotations between the two, it is the one nearest to the mean angular velocity. Where axes are
/// locked, the body turns by that mean, which has no component about locked axes.
///
/// Method: sub-steps of at most 0.04 rad. Where no axis is locked, each has three steps of the
/// implicit midpoint rule for the angular velocity in the body's axes, and is of fourth order
/// without a torque (H. Yoshida, "Construction of higher order symplectic integrators", Physics
/// Letters A 150 (1990)). Where axes are locked, it has one step. The rule keeps the length of the
/// momentum; a turn of the body keeps its direction (M. Austin, P. Krishnaprasad, L.-S. Wang,
/// "Almost Poisson integration of rigid body systems", Journal of Computational Physics 107
/// (1993)). There are at most 10,240 sub-steps: a body that spins faster goes on about the same
/// axis.
///
/// @param torque_W  [N m]  constant, about C
/// @param dt        [s]
[[nodiscard]] FIRSTCONTACT_API FreeTurn free_turn(const Inertia& inertia, const RigidState& state,
                                                  const Eigen::Vector3d& torque_W, double dt);

}  // namespace firstcontact
