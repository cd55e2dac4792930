/// @file
/// The part of a scene, beyond motion, that lets its bodies move under forces.

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/scene/tie.h>

namespace firstcontact {

/// A force and a torque on a body from one time to another; several add up.
struct TimedForce {
  double from = 0.0;                                 ///< [s]
  double to = 0.0;                                   ///< [s]  > from; may be infinite.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]   World axes, at the centre of mass.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] World axes.
};

/// A body that forces and contacts move.
///
/// Its motion in the scene is fixed: the pose that it starts from. At most one of density and mass
/// is given; with neither the density is 1000 kg/m^3.
struct FreeBody {
  std::optional<double> density;  ///< [kg/m^3]  > 0  Density of the solid that the body encloses.
  std::optional<double> mass;     ///< [kg]  > 0
  std::optional<Eigen::Vector3d> centre_of_mass;  ///< [m]  p_BC; else that of the solid.
  std::optional<Eigen::Matrix3d> inertia;         ///< [kg m^2]  About C, axes of the body frame;
                                                  ///< else that of the solid.
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();   ///< [m/s]  Of C, world axes.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]  World axes.
  std::array<bool, 3> locked_translation{};  ///< Along the world's axes: C keeps its coordinate.
  std::array<bool, 3> locked_rotation{};     ///< About the world's axes: no angular velocity.
  std::vector<TimedForce> forces;
};

/// The friction and the restitution of a surface; those of the scene where none is given.
struct Surface {
  std::optional<double> friction;     ///< [-]  Coulomb's coefficient, >= 0.
  std::optional<double> restitution;  ///< [-]  Newton's, in [0, 1].
  /// [m/s]  Velocity at which the surface runs along the body, as a conveyor belt does; axes of the
  /// body frame.
  ///
  /// Its part along a contact's normal has no effect.
  std::optional<Eigen::Vector3d> velocity = {};
};

/// The law of impacts that happen at the same time.
enum class ImpactLaw {
  sequential,    ///< Pairs answer one after the other, the fastest first, until all part.
  simultaneous,  ///< Newton's law holds for all contacts at once.
};

/// The words of ImpactLaw in files and in Python, in this order.
inline constexpr std::array<const char*, 2> kImpactLawWords{"sequential", "simultaneous"};

/// The rule for scripts that would crush something that cannot yield.
enum class JamRule {
  lose_time,  ///< Everything stands still for the rest of the step.
  wait,       ///< The scripted body stands still, and goes on with its script that much later.
};

/// The words of JamRule in files and in Python, in this order.
inline constexpr std::array<const char*, 2> kJamRuleWords{"lose_time", "wait"};

/// A number at a time.
struct TimedNumber {
  double time = 0.0;  ///< [s]
  double number = 0.0;
};

/// A motor that drives a joint, at most with its effort.
struct JointMotor {
  enum class Kind {
    position,  ///< Towards a position; a spring and a damper where a stiffness is given.
    velocity,  ///< Towards a velocity.
    torque,    ///< By a torque, or a force along a slide.
  };
  Kind kind = Kind::position;
  /// [rad, rad/s, N m; or m, m/s, N]  The target over time; empty for the positions of the robot's
  /// trajectory.
  ///
  /// It is linear between its times, which increase, and constant before and after.
  std::vector<TimedNumber> target = {};
  std::optional<double> stiffness = {};  ///< [N m/rad or N/m]  > 0; without it the joint gets there
                                         ///< within a step.
  double damping = 0.0;                  ///< [N m s/rad or N s/m]  >= 0; with a stiffness.
  std::optional<double> effort = {};     ///< [N m or N]  >= 0; else the model's limit, or none.
};

/// A robot that forces and contacts move. It starts at its `state`, with its base in place.
struct RobotDynamics {
  bool has_free_base = false;  ///< Else the root link is held where it is.
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();   ///< [m/s]  Velocity of a free base's
                                                               ///< origin, world axes.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]  World axes.
  std::map<std::string, double, std::less<>> velocities = {};  ///< [rad/s or m/s]  By coordinate.
  std::map<std::size_t, JointMotor> motors = {};  ///< Motors by joint; the joint has one
                                                  ///< coordinate.
  std::optional<double> density = {};  ///< [kg/m^3]  > 0  Density of links that have no mass in the
                                       ///< model.
  Surface surface = {};                ///< Surface of all links.
};

/// The surface of one pair of bodies, in place of what their surfaces give.
struct PairSurface {
  BodyPair bodies;
  Surface surface;
};

/// The settings of a simulation.
///
/// A pair of bodies has the geometric mean of their frictions and the greater of their
/// restitutions.
struct Simulation {
  double duration = 1.0;                        ///< [s]  > 0
  double step = 1.0 / 240.0;                    ///< [s]  > 0
  Eigen::Vector3d gravity = {0.0, 0.0, -9.81};  ///< [m/s^2]
  double friction = 0.5;                        ///< [-]  >= 0
  double restitution = 0.0;                     ///< [-]  In [0, 1].
  ImpactLaw impacts = ImpactLaw::sequential;
  JamRule jams = JamRule::lose_time;
  /// [m]  > 0  The distance at which bodies that touch rest, up to one and a half of it.
  ///
  /// The default is 1e-3 of the radius of the smallest free body. Without any free body it is 5e-4
  /// of the radius of the smallest link.
  std::optional<double> contact_distance;
  std::size_t events = 1000;  ///< > 0  Most events in a step; past them the step ends early.
  std::vector<PairSurface> pairs;
  std::vector<Tie> ties = {};
};

}  // namespace firstcontact
