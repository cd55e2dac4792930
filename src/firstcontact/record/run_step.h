/// @file
/// A step of a recorded simulation: every in-between motion, state and contact of it.

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/contact.h>

namespace firstcontact {

/// A piece of a step in which a body's centre of mass moves on a line while the body turns about
/// it.
///
/// Both go at constant rates: Motion::constant_rates with the centre of mass as pivot.
struct RunPiece {
  double to = 0.0;  ///< [s]  End of the piece since the step began; it begins where the one before
                    ///< ended.
  Pose X_WB;        ///< Pose at the begin of the piece.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]  Displacement of the centre of
                                                          ///< mass.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]  World axes.
};

/// A body at the end of a step, and how it got there.
///
/// It is one of the scene, or behind them a link body (LinksAsBodies). Bodies that rest at the
/// scene's pose for the whole run have no entry.
struct RunBody {
  std::size_t body = 0;
  std::vector<RunPiece> pieces = {};  ///< At least one, one after another; the last one ends with
                                      ///< the step. Where a step lasted 0 s there may be none, or
                                      ///< one of no length.
  Pose X_WB = {};
  Eigen::Vector3d linear_velocity = Eigen::Vector3d::Zero();   ///< [m/s]  Velocity of the centre of
                                                               ///< mass.
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s]  World axes.
  bool rests = false;  ///< Whether contacts hold the body where it is. Until something disturbs it,
                       ///< steps are as this one.
  /// [s]  Time by which the script of a body is behind the run.
  ///
  /// The body waited where it would have crushed an obstacle.
  double behind = 0.0;
};

/// The coordinates of a robot at the end of a step. Its links are among the bodies.
struct RunRobot {
  std::size_t robot = 0;                ///< Its number in the scene.
  std::vector<double> positions = {};   ///< Coordinates in the order of MechanismState.
  std::vector<double> velocities = {};  ///< Velocities in the order of MechanismState.
  std::vector<double> efforts = {};  ///< [N m or N]  Effort of motors along each of the velocities:
                                     ///< the mean over the step; 0 without a motor.
};

/// A contact that acted at the end of a step.
struct RunContact {
  BodyPair bodies = {};
  Feature feature_A;  ///< Feature of the first body.
  Feature feature_B;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< [m]  World, between the two surfaces.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< [-]  From the first to the second body.
  double distance = 0.0;                              ///< [m]
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< [N s]  Impulse on the second body in the
                                                      ///< step.
};

/// The effect of an impact within a step at one place.
struct RunImpact {
  double at = 0.0;  ///< [s]  Since the step began.
  BodyPair bodies = {};
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< [m]  World, between the two surfaces.
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();  ///< [N s]  Impulse on the second body.
};

/// The force of a tie of the simulation: the mean over a step, without its impacts.
struct RunTie {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]  Force on the second body, at its
                                                     ///< point.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]  Torque on the second body, for a
                                                     ///< hinge or a weld.
};

/// A link of a haptic tool where the device leads it.
struct RunDeviceLink {
  std::size_t body = 0;
  Pose X_WB = {};
};

/// The device of a haptic tool at the begin of a step.
struct RunDevice {
  std::size_t body = 0;                              ///< The tool.
  Pose X_WB = {};                                    ///< Pose to which the device leads the tool.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N]  Force on the device at the tool's
                                                     ///< centre of mass in X_WB, world axes.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m]  Torque on the device about that
                                                     ///< centre, world axes.
  std::vector<RunDeviceLink> links = {};             ///< Links that grips move, in the order of
                                                     ///< bodies.
};

/// A step of a run.
struct RunStep {
  std::size_t index = 0;  ///< From 1.
  double time = 0.0;      ///< [s]  Simulated time at the end of the step; the sum of the times that
                          ///< steps lasted.
  double lasted = 0.0;    ///< [s]  The step's length, less the time that is lost.
  double time_lost = 0.0;  ///< [s]  Time lost in this step, where its events were spent or it jams.
  double clearance = 0.0;  ///< [m]  Proven: no pair came closer in this step; > 0, infinite where
                           ///< there is no pair.
  double kinetic_energy = 0.0;    ///< [J]  Sum over the free bodies and robots.
  double potential_energy = 0.0;  ///< [J]  In the field of gravity, 0 at the world's origin;
                                  ///< springs and cables included.
  Eigen::Vector3d linear_momentum = Eigen::Vector3d::Zero();   ///< [kg m/s]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< [kg m^2/s]  About the origin.
  double residual = 0.0;   ///< [m/s]  The greatest residual of the step's contact problems.
  std::size_t events = 0;  ///< Times within the step at which contacts were projected.
  std::vector<RunBody> bodies = {};
  std::vector<RunRobot> robots = {};  ///< Robots that forces move, in order.
  std::vector<RunContact> contacts = {};
  std::vector<RunImpact> impacts = {};  ///< In the order of time.
  std::vector<RunTie> ties = {};        ///< In the order of the scene's.
  std::vector<RunDevice> devices = {};  ///< Devices of haptic tools, in the order of bodies.
};

}  // namespace firstcontact
