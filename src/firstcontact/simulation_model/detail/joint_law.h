/// @file
/// The law of one coordinate of a robot over a span of time: its drives, brakes and stops.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/mechanism/mechanism.h>
#include <firstcontact/robot/robot_description.h>
#include <firstcontact/scene/simulation.h>

namespace firstcontact::detail {

/// The law of one coordinate, besides gravity, inertia and contacts.
struct JointLaw {
  Eigen::Index position = 0;  ///< Index among the mechanism's positions.
  Eigen::Index velocity = 0;  ///< Index among the mechanism's velocities.
  JointLimits limits = {};
  double damping = 0.0;   ///< [N m s/rad or N s/m]
  double friction = 0.0;  ///< [N m or N]
  std::optional<JointMotor> motor = {};
  /// [rad/s or m/s]  Rates of the motor's target at its times, for a target from a trajectory.
  ///
  /// With them cubics lead from one time to the next. Without them lines do.
  std::vector<TimedNumber> rates = {};
};

/// A span of time of a plan.
struct PlanSpan {
  double from = 0.0;    ///< [s]  Since the simulation began.
  double length = 0.0;  ///< [s]  > 0
  /// [s]  The time in which motors catch up with their targets; a longer plan is all of it.
  ///
  /// In the short plans of a jam motors would otherwise have extreme velocities.
  double catch_up = 0.0;
  [[nodiscard]] double to() const { return from + length; }
};

/// The rule for positions at the end of a span from the velocities u there: origin + span weight u.
///
/// Entries are in the order of velocities.
struct PositionRule {
  Eigen::VectorXd weights;  ///< [-]  From 1/2, the mean of both ends, to 1, the end alone.
  Eigen::VectorXd origin;   ///< [rad or m]  For coordinates with laws.
};

/// [N m s or N s]  The greatest impulse of the motor of a law over a span [s].
[[nodiscard]] double greatest_impulse(const JointLaw& law, double span);

/// Whether a motor holds its joint against any force, also in impacts.
[[nodiscard]] bool is_rigid(const JointLaw& law);

/// [-]  The weight of the end of a span that makes the decay of one damped coordinate exact.
///
/// It is 1 / (1 - exp(-z)) - 1 / z. It differs from 1/2 by z / 12, so that rules stay of second
/// order.
///
/// Source: the exponential fit of W. Liniger, R. A. Willoughby, "Efficient integration methods for
/// stiff systems of ordinary differential equations", SIAM Journal on Numerical Analysis 7 (1970).
///
/// @param z  span damping / mass
[[nodiscard]] double fitted_weight(double z);

/// (size)  [N m s/rad or N s/m]  The damping of joints that flights follow; empty for none.
///
/// Flights follow light dampers by their rule of fourth order. The sum of span damping / mass over
/// them bounds the rates of decay, and is at most kFollowedDecay. The dampers of joints with
/// springs belong to the rule of the springs.
///
/// @param inverse_mass  inverse mass matrix of the mechanism
/// @param span          [s]
[[nodiscard]] Eigen::VectorXd followed_damping(const std::vector<JointLaw>& laws,
                                               const Eigen::MatrixXd& inverse_mass, double span);

/// The weights of the laws' coordinates.
///
/// Undamped springs have 1/2, and keep their energy. So have dampers that flights follow. Other
/// dampers have fitted_weight(). Springs that swing by more than one radian of their phase in a
/// span are damped, as steps cannot follow them.
///
/// @param inverse_mass  inverse mass matrix of the mechanism
/// @param followed      result of followed_damping()
/// @param span          [s]
[[nodiscard]] Eigen::VectorXd position_weights(const std::vector<JointLaw>& laws,
                                               const Eigen::MatrixXd& inverse_mass,
                                               const Eigen::VectorXd& followed, double span);

/// The drives of a span by the rule: those of motors come first, in the order of laws.
///
/// Springs, dampers and friction act with the weighted means of both ends.
[[nodiscard]] std::vector<JointDrive> drives_by_rule(const std::vector<JointLaw>& laws,
                                                     const MechanismState& state,
                                                     const PositionRule& rule,
                                                     const PlanSpan& span);

/// The drives of a span by Euler's implicit rule, in the same order.
///
/// The end of the span determines the extension of springs, the speed of dampers, and the stops.
///
/// @param origin  positions from which the velocities u at the end lead to origin + span u
[[nodiscard]] std::vector<JointDrive> drives_by_end(const std::vector<JointLaw>& laws,
                                                    const MechanismState& state,
                                                    const Eigen::VectorXd& origin,
                                                    const PlanSpan& span);

/// A coordinate and its position at the end of a span.
struct PlacedCoordinate {
  Eigen::Index velocity = 0;  ///< Index among the mechanism's velocities.
  Eigen::Index position = 0;  ///< Index among the mechanism's positions.
  double at = 0.0;            ///< [rad or m]
  /// Whether the rows of a motor lead it from one position to another.
  bool is_along_rows = false;
};

/// The coordinates whose positions at the end of a span differ from those of the mean of
/// velocities.
///
/// Motors that reach their target are at the target's position. Others are where weights above 1/2
/// lead.
///
/// @param drives    result of drives_by_rule()
/// @param impulses  one for each drive
/// @param u         velocities at the end
[[nodiscard]] std::vector<PlacedCoordinate> placed_coordinates(
    const std::vector<JointLaw>& laws, const std::vector<JointDrive>& drives,
    const std::vector<double>& impulses, const MechanismState& state, const PositionRule& rule,
    const PlanSpan& span, const Eigen::VectorXd& u);

/// [rad or m]  As much of a displacement as the limits permit. A joint beyond its limit gets no
/// farther from it.
///
/// @param begin  position at the begin of the span
/// @param q      position to displace
/// @param by     the displacement
[[nodiscard]] double room_within_limits(const JointLaw& law, double begin, double q, double by);

/// Whether a drive has a target velocity, and reaches it with an impulse within its bounds.
[[nodiscard]] bool reaches_target(const JointDrive& drive, double impulse);

/// Predicts the impulses of drives without contacts, as a start.
///
/// They are exact where no bound acts, and where exactly those bounds act that the impulses without
/// bounds exceed.
///
/// @param u  velocities without drives
[[nodiscard]] std::vector<double> predicted_impulses(const Eigen::MatrixXd& inverse_mass,
                                                     const Eigen::VectorXd& u,
                                                     const std::vector<JointDrive>& drives);

}  // namespace firstcontact::detail
