#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include <firstcontact/contact_solver/detail/anderson_mixing.h>
#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_response.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/island/detail/plan_energy.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// [-]  Growth of the changes of forces from one round to the next above which they do not
/// converge.
constexpr double kGrowthOfTies = 1.5;

/// [-]  Bounds of impulses in flights: this many times those at the end of flights. And of turns:
/// this many times the body's own turn, and [rad] the second number.
constexpr double kWildGrowth = 10.0;
constexpr double kWildTurn = 1.0;

}  // namespace

/// Makes the rows of ties at the end of the flights.
void IslandPlanner::lay_ties() {
  std::vector<ContactBody> at_end = problem_.bodies;
  std::vector<bool> spinning(state_.size(), false);
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (spins(k)) {
      at_end[k].w = flight_.at_end[k].w;
      spinning[k] = true;
    } else if (is_link_body(k) && loads_) {
      const RobotFlight& flight = flights_[state_.robots.robot_of(k)];
      const Eigen::Matrix<double, 6, 1> V = flight.J[state_.robots.link_of(k)] * flight.velocities;
      at_end[k].v = V.head<3>();
      at_end[k].w = V.tail<3>();
    }
  }
  ties_.take_changes(bodies_, at_end);
  const std::vector<bool> by_end = led_by_end();
  std::vector<Move> moves;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    moves.push_back(move_of(k, by_end[k], Vector3d::Zero(), flight_.at_end[k]));
  }
  ties_.lay(bodies_, {moves, flights_, by_end, at_end, spinning}, problem_);
  laid_by_end_ = by_end_;
}

/// Makes rows anew at the end of the flights, and solves.
void IslandPlanner::solve_where_flown() {
  if (state_.robots.empty()) {
    lay_ties();
  } else {
    fly_robots();
  }
  last_.reset();
  solve();
  by_end_ = by_end_ || !mean_is_allowed();
}

/// Whether the flight of a tied body turns much farther than the body's own turn, or is not finite.
bool IslandPlanner::turns_wildly() const {
  for (std::size_t k = 0; k < state_.size(); ++k) {
    const double most = kWildTurn + kWildGrowth * span_ * state_.states[k].w_WB.norm();
    const bool is_tame =
        flight_.rotation_vectors[k].norm() <= most && span_ * flight_.at_end[k].w.norm() <= most;
    if (!is_tame && !state_.model.ties_of[state_.members[k]].empty()) {
      return true;
    }
  }
  return false;
}

/// Adds the forces of ties to the flights of bodies and robots, until they stay the same. Where
/// repeating this fails, changes are mixed: a force on a long arm or on a light link turns it more
/// than it moves it. Where both fail nothing is predicted: velocities are projected where flights
/// end, which loses energy. Returns whether the forces were found.
bool IslandPlanner::follow_ties() {
  if (repeat_forces_of_ties()) {
    return true;
  }
  forget_ties();
  if (mix_forces_of_ties()) {
    return true;
  }
  forget_ties();
  return false;
}

/// Finds the forces by repeating. Returns whether they were found.
bool IslandPlanner::repeat_forces_of_ties() {
  double before = std::numeric_limits<double>::infinity();
  const double most = kWildGrowth * changes_of_ties().norm();
  for (int round = 0; round < kMostRoundsOfTies; ++round) {
    const double change = ties_.greatest_change(last_->velocities.ties);
    const bool is_near = change <= kNearChangeOfTies;
    const bool is_done = change <= kChangeOfTies || (is_near && change > 0.5 * before);
    if (is_done && laid_by_end_ == by_end_) {
      return true;
    }
    const bool is_last = round + 1 == kMostRoundsOfTies;
    if (!is_near && (is_last || !(change <= kGrowthOfTies * before))) {
      return false;
    }
    before = change;
    if (!predict_ties(ties_.predicted() + changes_of_ties(), most)) {
      return false;
    }
  }
  return true;
}

/// Finds them by mixing. The first guess is no impulse at all, too far from the others to count.
bool IslandPlanner::mix_forces_of_ties() {
  AndersonMixing mixing;
  const double most = kWildGrowth * changes_of_ties().norm();
  bool goes_on = predict_ties(changes_of_ties(), most);
  for (int round = 0; goes_on && round < kMostMixedRoundsOfTies; ++round) {
    if (ties_.greatest_change(last_->velocities.ties) <= kMixedChangeOfTies &&
        laid_by_end_ == by_end_) {
      return true;
    }
    goes_on = predict_ties(mixing.next(ties_.predicted(), changes_of_ties()), most);
  }
  return goes_on && ties_.greatest_change(last_->velocities.ties) <= kNearChangeOfTies;
}

/// The changes that the last solution found.
VectorXd IslandPlanner::changes_of_ties() const {
  const std::vector<double>& changes = last_->velocities.ties;
  return VectorXd::Map(changes.data(), static_cast<Eigen::Index>(changes.size()));
}

/// Adds these impulses to the flights, and solves. Returns false if they are longer than `most`, or
/// turn a body wildly.
bool IslandPlanner::predict_ties(const VectorXd& impulses, double most) {
  if (!(impulses.norm() <= most)) {
    return false;
  }
  ties_.predict(impulses);
  take_spins();
  take_loads();
  fly_bodies();
  if (turns_wildly()) {  // Such flights have no further use.
    return false;
  }
  solve_where_flown();
  return true;
}

/// Removes the forces of ties, and solves.
void IslandPlanner::forget_ties() {
  ties_.forget();
  loads_.reset();
  flights_.clear();
  for (ContactPoint& contact : problem_.contacts) {
    contact.guess.setZero();
  }
  fly_bodies();
  solve_where_flown();
}

/// Whether a plan moves bodies without bound, as forces of ties may at a singular position. No
/// motion of such a plan is followed.
bool IslandPlanner::leads_nowhere(const Plan& plan) const {
  return !std::ranges::all_of(plan.moves, [](const Move& move) {
    return move.translation.allFinite() && move.rotation_vector.norm() <= kMostTurnOfPlan;
  }) || !std::ranges::all_of(plan.robots, [](const RobotPlan& robot) {
    return robot.end.positions.allFinite() && robot.end.velocities.allFinite() &&
           robot.motors.allFinite();
  });
}

/// Adds the displacements by springs to robots, except those that move by velocities at the end or
/// by motors.
void IslandPlanner::shift_robots(Plan& plan) const {
  std::vector<VectorXd> shifts = ties_.shifts_of_robots(problem_);
  for (std::size_t r = 0; r < shifts.size(); ++r) {
    if (robots_by_end_[r] || state_.robots.has_motors(r)) {
      shifts[r].setZero();
    }
  }
  if (!shifts.empty()) {
    state_.robots.displace(shifts, plan.robots);
  }
}

/// Whether displacements close most of a gap [m], and are not far longer than it, as they are near
/// a singular position.
bool IslandPlanner::closes_gaps(const ContactSolution& way, double off) const {
  double farthest = 0.0;     // [m]
  double most_turned = 0.0;  // [rad]
  for (std::size_t k = 0; k < state_.size(); ++k) {
    farthest = std::max(farthest, way.bodies[k].v.norm());
    most_turned = std::max(most_turned, way.bodies[k].w.norm());
  }
  return way.residual < off && farthest <= kFarthestOfGap * off && most_turned <= kMostTurnOfTied;
}

/// Adds displacements without velocity that bring joints of ties together, and cables back to their
/// length, where the plan ends. They bring contacts no nearer. Stiff springs keep their lengths
/// where that is possible, or they would get energy.
void IslandPlanner::settle_ties(Plan& plan) const {
  if (state_.ties.empty()) {
    return;
  }
  ContactProblem resting{.bodies = problem_.bodies, .mechanisms = problem_.mechanisms};
  for (ContactBody& body : resting.bodies) {
    body.v.setZero();
    body.w.setZero();
  }
  for (ContactMechanism& mechanism : resting.mechanisms) {
    mechanism.velocity.setZero();
  }
  for (const ContactPoint& contact : problem_.contacts) {
    resting.contacts.push_back({.bodies = contact.bodies,
                                .arm_A = contact.arm_A,
                                .arm_B = contact.arm_B,
                                .frame = contact.frame});
  }
  const double tolerance = kApartOfDistance * state_.model.distances.least;
  std::optional<std::vector<PlanTies::LedSpring>> springs;
  for (int round = 0; round < kRoundsOfSettling; ++round) {
    state_.robots.set_moves(plan.robots, state_.states, span_, share_of_drift(), plan.moves);
    std::vector<Pose> at_end;
    for (std::size_t k = 0; k < state_.size(); ++k) {
      at_end.push_back(motion_of(state_.member(k), state_.states[k].X_WB, plan.moves[k]).pose(1.0));
    }
    if (!springs) {
      springs = ties_.led_springs(at_end);
    }
    ContactProblem problem = resting;
    double off = ties_.add_settling(at_end, last_->velocities.ties, bodies_, problem);
    if (!springs->empty()) {
      off = std::max(off, ties_.hold(*springs, at_end, bodies_, problem));
    }
    if (!(off > tolerance)) {
      return;
    }
    const ContactSolution way = project_on_contacts(problem, {.tolerance = 0.1 * tolerance});
    if (!closes_gaps(way, off)) {
      if (springs->empty()) {
        return;
      }
      springs->clear();  // Without them gaps may close.
      continue;
    }
    for (std::size_t k = 0; k < state_.size(); ++k) {
      plan.moves[k].translation += way.bodies[k].v;
      plan.moves[k].rotation_vector += way.bodies[k].w;
    }
    state_.robots.displace(way.mechanisms, plan.robots);
  }
}

/// Corrects a plan for contacts and ties to second order, and judges its effect on ties.
///
/// @param outer  impulses on robots, all of the plan's
void IslandPlanner::settle(const std::vector<OuterImpulse>& outer, Plan& made) {
  keep_on_curves(made);
  push_apart(made);
  settle_ties(made);
  carry_back(made);
  state_.robots.keep_momenta(outer, span_, made.robots);
  state_.robots.set_moves(made.robots, state_.states, span_, share_of_drift(), made.moves);
  made.is_refused = leads_nowhere(made);
  made.keeps_energy = made.is_refused || (contacts_do_no_work() &&
                                          contacts_add_no_energy(state_, made, problem_, span_));
  if (!state_.ties.empty()) {
    made.is_refused = made.is_refused || tears_ties(state_, made, span_);
    made.finds_ties =
        made.finds_ties &&
        (made.is_refused || keeps_tied_energy(state_, made, last_->velocities, span_));
  }
}

}  // namespace firstcontact::detail
