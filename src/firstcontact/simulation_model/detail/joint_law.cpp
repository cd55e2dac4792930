#include <firstcontact/simulation_model/detail/joint_law.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include <firstcontact/simulation_model/detail/constants.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// [-]  A motor takes the rate of its target where the mean of the velocities at both ends leads to
/// it, to this part of their change: on smooth targets, not at a kink.
constexpr double kSmoothTarget = 0.25;
/// [-]  Time before a kink at which rates are taken, by the span.
constexpr double kJustBefore = 1e-9;

double number_at(const std::vector<TimedNumber>& target, double time) {
  const auto next = std::ranges::upper_bound(target, time, {}, &TimedNumber::time);
  if (next == target.begin()) {
    return next->number;
  }
  const TimedNumber& before = *(next - 1);
  if (next == target.end()) {
    return before.number;
  }
  const double share = (time - before.time) / (next->time - before.time);
  return before.number + share * (next->number - before.number);
}

/// The mean of the lines between the numbers over a span; exact for short changes, too.
double mean_over(const std::vector<TimedNumber>& target, double from, double length) {
  double time = from;
  double number = number_at(target, from);
  double sum = 0.0;
  auto next = std::ranges::upper_bound(target, from, {}, &TimedNumber::time);
  for (; next != target.end() && next->time < from + length; ++next) {
    sum += 0.5 * (next->time - time) * (number + next->number);
    time = next->time;
    number = next->number;
  }
  const double rest = from + length - time;
  const double rate = next == target.begin() || next == target.end()
                          ? 0.0
                          : (next->number - number) / (next->time - time);
  return (sum + rest * (number + 0.5 * rate * rest)) / length;
}

/// A motor's target and its rate.
struct Target {
  double number = 0.0;
  double rate = 0.0;
};

/// The target on lines between the numbers, or on cubics where rates are given.
Target target_at(const JointLaw& law, double time) {
  const std::vector<TimedNumber>& target = law.motor->target;
  const auto next = std::ranges::upper_bound(target, time, {}, &TimedNumber::time);
  if (next == target.begin() || next == target.end()) {
    return {number_at(target, time), 0.0};
  }
  const TimedNumber& A = *(next - 1);
  const double length = next->time - A.time;
  const double s = (time - A.time) / length;
  const double way = next->number - A.number;
  if (law.rates.empty()) {
    return {A.number + s * way, way / length};
  }
  const auto k = static_cast<std::size_t>(next - target.begin());
  const double rate_A = law.rates[k - 1].number;
  const double rate_B = law.rates[k].number;
  // Distance of the cubic from the line, by the differences of the rates from the line's.
  const double from_A = length * rate_A - way;
  const double from_B = length * rate_B - way;
  const double t = 1.0 - s;
  return {A.number + s * way + s * t * (t * from_A - s * from_B),
          (way + t * (t - 2.0 * s) * from_A - s * (2.0 * t - s) * from_B) / length};
}

/// The nearest position that limits allow.
double within(const JointLimits& limits, double q) {
  return std::min(std::max(q, limits.lower.value_or(q)), limits.upper.value_or(q));
}

/// A velocity that leads no farther than the limits.
///
/// Two laws that nothing yields to have no solution against each other.
double within_limits(const JointLaw& law, double velocity, double q, double span) {
  const double least = law.limits.lower ? (*law.limits.lower - q) / span : velocity;
  const double greatest = law.limits.upper ? (*law.limits.upper - q) / span : velocity;
  return std::min(std::max(velocity, least), greatest);
}

JointDrive torque_drive(const JointLaw& law, const PlanSpan& span) {
  const double bound = greatest_impulse(law, span.length);
  const double torque = mean_over(law.motor->target, span.from, span.length);
  const double impulse = std::clamp(torque * span.length, -bound, bound);
  return {.least = impulse, .greatest = impulse};
}

/// [rad or m]  The position to which a motor is led from a position.
double caught_up(const JointLaw& law, double q, const PlanSpan& span) {
  const double to = target_at(law, span.to()).number;
  if (span.length >= span.catch_up) {
    return to;
  }
  const double from = target_at(law, span.from).number;
  return q + (to - from) + span.length / span.catch_up * (from - q);
}

/// The drive of a motor by the end of the span.
///
/// @param q       [rad or m]  at the begin
/// @param origin  [rad or m]  at the end q is origin + length u
JointDrive motor_by_end(const JointLaw& law, double q, double origin, const PlanSpan& span) {
  const JointMotor& motor = *law.motor;
  const double bound = greatest_impulse(law, span.length);
  JointDrive drive{.least = -bound, .greatest = bound};
  switch (motor.kind) {
    case JointMotor::Kind::torque:
      return torque_drive(law, span);
    case JointMotor::Kind::velocity:
      drive.target = within_limits(law, number_at(motor.target, span.to()), origin, span.length);
      break;
    case JointMotor::Kind::position: {
      if (!motor.stiffness) {
        const double way = caught_up(law, q, span) - origin;
        drive.target = within_limits(law, way / span.length, origin, span.length);
        break;
      }
      const double to = target_at(law, span.to()).number;
      const double missing = to - origin;
      // r = span (k (missing - span u) + d (rate - u))
      const double rate = (to - target_at(law, span.from).number) / span.length;
      const double answer = span.length * *motor.stiffness + motor.damping;
      drive.target = (*motor.stiffness * missing + motor.damping * rate) / answer;
      drive.compliance = 1.0 / (span.length * answer);
      break;
    }
  }
  return drive;
}

/// One coordinate over a span, and its rule.
struct Coordinate {
  double q;  // Position at the begin.
  double v;
  double weight;  // At the end the position is origin + span weight u.
  double origin;
};

Coordinate coordinate_of(const JointLaw& law, const MechanismState& state,
                         const PositionRule& rule) {
  return {state.positions[law.position], state.velocities[law.velocity], rule.weights[law.velocity],
          rule.origin[law.velocity]};
}

/// [rad or m]  The position to which a weight above 1/2 leads.
///
/// It is right for a velocity that the damper ends: in a span it loses at least 2 weight - 1 of it.
/// A velocity that changes by less than half of that is of a slow motion against the damper. With
/// such a weight its positions would be of first order, so it has the mean.
double weighted_position(const JointLaw& law, const Coordinate& c, double u, double span) {
  const double more = c.weight - 0.5;
  const double change = u - c.v;
  const double ended = more * std::max(std::abs(u), std::abs(c.v));
  const double slow = ended > 0.0 ? std::clamp(2.0 - std::abs(change) / ended, 0.0, 1.0) : 0.0;
  const double way = c.origin + span * c.weight * u - slow * span * more * change - c.q;
  return c.q + room_within_limits(law, c.q, c.q, way);
}

/// [rad or m]  The position to which a motor without spring leads in a span.
double goal(const JointLaw& law, double q, const PlanSpan& span) {
  if (law.motor->kind == JointMotor::Kind::position) {
    return within(law.limits, caught_up(law, q, span));
  }
  const double way = 0.5 * span.length *
                     (number_at(law.motor->target, span.from + kJustBefore * span.length) +
                      number_at(law.motor->target, span.to()));
  return within(law.limits, q + way);
}

/// [rad/s or m/s]  The velocity of a motor without spring when it is at its goal.
double speed_at_goal(const JointLaw& law, const Coordinate& c, const PlanSpan& span) {
  const double to = goal(law, c.q, span);
  const double mean = (to - c.q) / span.length;
  if (law.motor->kind == JointMotor::Kind::velocity) {
    const double speed = number_at(law.motor->target, span.to());
    const double free =
        c.q + 0.5 * span.length *
                  (speed + number_at(law.motor->target, span.from + kJustBefore * span.length));
    return to == free ? speed : mean;
  }
  const Target target = target_at(law, span.to() - kJustBefore * span.length);
  const bool is_smooth =
      to == target_at(law, span.to()).number &&
      std::abs(mean - 0.5 * (c.v + target.rate)) <= kSmoothTarget * std::abs(target.rate - c.v);
  return is_smooth ? target.rate : mean;
}

/// The drive r = span (k (missing - q') + d (rate - u')), with the weighted means q' and u' of both
/// ends.
JointDrive spring_by_rule(const JointLaw& law, const Coordinate& c, const PlanSpan& span,
                          JointDrive drive) {
  const double k = *law.motor->stiffness;
  const double d = law.motor->damping;
  const double h = span.length;
  const double begin = target_at(law, span.from).number;
  const double end = target_at(law, span.to()).number;
  const double missing = (1.0 - c.weight) * (begin - c.q) + c.weight * (end - c.origin);
  const double rate = (end - begin) / h - (1.0 - c.weight) * c.v;
  const double answer = c.weight * (k * c.weight * h + d);
  drive.target = (k * missing + d * rate) / answer;
  drive.compliance = 1.0 / (h * answer);
  return drive;
}

JointDrive motor_by_rule(const JointLaw& law, const Coordinate& c, const PlanSpan& span) {
  if (law.motor->kind == JointMotor::Kind::torque) {
    return torque_drive(law, span);
  }
  const double bound = greatest_impulse(law, span.length);
  JointDrive drive{.least = -bound, .greatest = bound};
  if (law.motor->stiffness) {
    return spring_by_rule(law, c, span, drive);
  }
  drive.target = speed_at_goal(law, c, span);
  return drive;
}

bool is_stop(const JointDrive& drive) {
  return (drive.least == 0.0) != (drive.greatest == 0.0) &&
         !(std::isfinite(drive.least) && std::isfinite(drive.greatest));
}

/// The drives that act, and the impulses of the others.
struct ActiveDrives {
  std::vector<std::size_t> active = {};
  std::vector<double> impulses = {};
};

/// All drives except stops, and except friction where a motor determines the velocity.
ActiveDrives first_active(const std::vector<JointDrive>& drives) {
  ActiveDrives made;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    const JointDrive& drive = drives[k];
    double impulse = drive.least == drive.greatest ? drive.least : 0.0;
    bool is_active = drive.least < drive.greatest && !is_stop(drive);
    if (is_active && drive.compliance == 0.0) {
      for (std::size_t i = 0; i < k && is_active; ++i) {
        const JointDrive& motor = drives[i];
        if (motor.coordinate == drive.coordinate && motor.compliance == 0.0 &&
            motor.least < motor.greatest && !is_stop(motor)) {
          is_active = false;
          impulse = motor.target > 0.0 ? drive.least : motor.target < 0.0 ? drive.greatest : 0.0;
        }
      }
    }
    made.impulses.push_back(impulse);
    if (is_active) {
      made.active.push_back(k);
    }
  }
  return made;
}

/// Finds the impulses with which active drives meet their laws. Returns whether there are any.
bool solve_active(const MatrixXd& inverse_mass, const VectorXd& u,
                  const std::vector<JointDrive>& drives, ActiveDrives& now) {
  const auto n = static_cast<Index>(now.active.size());
  for (const std::size_t k : now.active) {
    now.impulses[k] = 0.0;
  }
  VectorXd held = u;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    if (now.impulses[k] != 0.0) {
      held += now.impulses[k] * inverse_mass.col(static_cast<Index>(drives[k].coordinate));
    }
  }
  MatrixXd A(n, n);
  VectorXd missing(n);
  for (Index i = 0; i < n; ++i) {
    const JointDrive& row = drives[now.active[static_cast<std::size_t>(i)]];
    const auto c = static_cast<Index>(row.coordinate);
    for (Index k = 0; k < n; ++k) {
      const JointDrive& other = drives[now.active[static_cast<std::size_t>(k)]];
      A(i, k) = inverse_mass(c, static_cast<Index>(other.coordinate));
    }
    A(i, i) += row.compliance;
    missing[i] = row.target - held[c];
  }
  const Eigen::LLT<MatrixXd> factor(A);
  if (factor.info() != Eigen::Success) {
    return false;
  }
  const VectorXd solved = factor.solve(missing);
  for (Index i = 0; i < n; ++i) {
    now.impulses[now.active[static_cast<std::size_t>(i)]] = solved[i];
  }
  return solved.allFinite();
}

/// A drive on the coordinate of a law.
JointDrive on_coordinate_of(const JointLaw& law, JointDrive drive) {
  drive.coordinate = static_cast<std::size_t>(law.velocity);
  return drive;
}

}  // namespace

double fitted_weight(double z) {
  return z < 1e-2 ? 0.5 + z / 12.0 : 1.0 / -std::expm1(-z) - 1.0 / z;
}

double greatest_impulse(const JointLaw& law, double span) {
  const double effort = law.motor->effort.value_or(law.limits.effort.value_or(kUnbounded));
  return effort * span;
}

bool is_rigid(const JointLaw& law) {
  return law.motor && law.motor->kind != JointMotor::Kind::torque && !law.motor->stiffness &&
         !std::isfinite(greatest_impulse(law, 1.0));
}

VectorXd followed_damping(const std::vector<JointLaw>& laws, const MatrixXd& inverse_mass,
                          double span) {
  VectorXd followed = VectorXd::Zero(inverse_mass.rows());
  double decay = 0.0;
  for (const JointLaw& law : laws) {
    if (law.damping > 0.0 && !(law.motor && law.motor->stiffness)) {
      followed[law.velocity] = law.damping;
      decay += span * law.damping * inverse_mass(law.velocity, law.velocity);
    }
  }
  return decay > 0.0 && decay <= kFollowedDecay ? followed : VectorXd();
}

VectorXd position_weights(const std::vector<JointLaw>& laws, const MatrixXd& inverse_mass,
                          const VectorXd& followed, double span) {
  VectorXd weights = VectorXd::Constant(inverse_mass.rows(), 0.5);
  for (const JointLaw& law : laws) {
    if (followed.size() > 0 && followed[law.velocity] > 0.0) {
      continue;
    }
    const double mobility = inverse_mass(law.velocity, law.velocity);
    double z = span * law.damping * mobility;
    if (law.motor && law.motor->stiffness) {
      const double phase = span * std::sqrt(*law.motor->stiffness * mobility);
      z += span * law.motor->damping * mobility + std::max(0.0, phase - kGreatestPhase);
    }
    weights[law.velocity] = fitted_weight(z);
  }
  return weights;
}

std::vector<JointDrive> drives_by_rule(const std::vector<JointLaw>& laws,
                                       const MechanismState& state, const PositionRule& rule,
                                       const PlanSpan& span) {
  std::vector<JointDrive> drives;
  const auto add = [&](const JointLaw& law, const JointDrive& drive) {
    drives.push_back(on_coordinate_of(law, drive));
  };
  for (const JointLaw& law : laws) {
    if (law.motor) {
      add(law, motor_by_rule(law, coordinate_of(law, state, rule), span));
    }
  }
  const double h = span.length;
  for (const JointLaw& law : laws) {
    const Coordinate c = coordinate_of(law, state, rule);
    if (law.damping > 0.0) {
      add(law, {.target = -(1.0 - c.weight) / c.weight * c.v,
                .compliance = 1.0 / (h * law.damping * c.weight)});
    }
    if (law.friction > 0.0) {
      add(law, {.least = -law.friction * h, .greatest = law.friction * h});
    }
    if (law.limits.lower) {
      add(law,
          {.target = (std::min(c.q, *law.limits.lower) - c.origin) / (h * c.weight), .least = 0.0});
    }
    if (law.limits.upper) {
      add(law, {.target = (std::max(c.q, *law.limits.upper) - c.origin) / (h * c.weight),
                .greatest = 0.0});
    }
  }
  return drives;
}

std::vector<JointDrive> drives_by_end(const std::vector<JointLaw>& laws,
                                      const MechanismState& state, const VectorXd& origin,
                                      const PlanSpan& span) {
  std::vector<JointDrive> drives;
  const auto add = [&](const JointLaw& law, const JointDrive& drive) {
    drives.push_back(on_coordinate_of(law, drive));
  };
  for (const JointLaw& law : laws) {
    if (law.motor) {
      add(law, motor_by_end(law, state.positions[law.position], origin[law.position], span));
    }
  }
  const double h = span.length;
  for (const JointLaw& law : laws) {
    const double q = state.positions[law.position];
    const double q_origin = origin[law.position];
    if (law.damping > 0.0) {
      add(law, {.compliance = 1.0 / (h * law.damping)});
    }
    if (law.friction > 0.0) {
      add(law, {.least = -law.friction * h, .greatest = law.friction * h});
    }
    if (law.limits.lower) {
      add(law, {.target = (std::min(q, *law.limits.lower) - q_origin) / h, .least = 0.0});
    }
    if (law.limits.upper) {
      add(law, {.target = (std::max(q, *law.limits.upper) - q_origin) / h, .greatest = 0.0});
    }
  }
  return drives;
}

double room_within_limits(const JointLaw& law, double begin, double q, double by) {
  double room = by;
  if (law.limits.upper && by > 0.0) {
    room = std::min(room, std::max(0.0, std::max(*law.limits.upper, begin) - q));
  }
  if (law.limits.lower && by < 0.0) {
    room = std::max(room, std::min(0.0, std::min(*law.limits.lower, begin) - q));
  }
  return room;
}

bool reaches_target(const JointDrive& drive, double impulse) {
  return drive.compliance == 0.0 && impulse > drive.least && impulse < drive.greatest;
}

std::vector<PlacedCoordinate> placed_coordinates(const std::vector<JointLaw>& laws,
                                                 const std::vector<JointDrive>& drives,
                                                 const std::vector<double>& impulses,
                                                 const MechanismState& state,
                                                 const PositionRule& rule, const PlanSpan& span,
                                                 const VectorXd& u) {
  std::vector<PlacedCoordinate> placed;
  std::size_t motor = 0;
  for (const JointLaw& law : laws) {
    const std::size_t k = motor;
    motor += law.motor ? 1 : 0;
    const bool is_led = law.motor && law.motor->kind != JointMotor::Kind::torque &&
                        !law.motor->stiffness && reaches_target(drives[k], impulses[k]);
    const Coordinate c = coordinate_of(law, state, rule);
    if (is_led) {
      const bool is_along_rows =
          law.motor->kind == JointMotor::Kind::position &&
          target_at(law, span.from).number != target_at(law, span.to()).number;
      placed.push_back({law.velocity, law.position, goal(law, c.q, span), is_along_rows});
    } else if (c.weight > 0.5) {
      placed.push_back(
          {law.velocity, law.position, weighted_position(law, c, u[law.velocity], span.length)});
    }
  }
  return placed;
}

std::vector<double> predicted_impulses(const MatrixXd& inverse_mass, const VectorXd& u,
                                       const std::vector<JointDrive>& drives) {
  constexpr int kRounds = 8;
  ActiveDrives now = first_active(drives);
  for (int round = 0; round < kRounds; ++round) {
    if (!solve_active(inverse_mass, u, drives, now)) {
      return std::vector<double>(drives.size(), 0.0);
    }
    std::vector<std::size_t> within_bounds;
    for (const std::size_t k : now.active) {
      const double clamped = std::clamp(now.impulses[k], drives[k].least, drives[k].greatest);
      if (clamped == now.impulses[k]) {
        within_bounds.push_back(k);
      }
      now.impulses[k] = clamped;
    }
    if (within_bounds.size() == now.active.size()) {
      break;
    }
    now.active = std::move(within_bounds);
  }
  return now.impulses;
}

}  // namespace firstcontact::detail
