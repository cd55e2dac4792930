#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/sim_body.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// [m/s]  Bounds the speed that a change of a robot's velocities gives to any point of its links.
double fastest_of(const IslandState& state, std::size_t robot, const RobotFlight& flight,
                  const VectorXd& change) {
  double fastest = 0.0;
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (state.member(k).link_body && state.robots.robot_of(k) == robot) {
      const Eigen::Matrix<double, 6, 1> V = flight.J[state.robots.link_of(k)] * change;
      fastest = std::max(fastest, V.head<3>().norm() + state.member(k).reach * V.tail<3>().norm());
    }
  }
  return fastest;
}

bool is_any(const std::vector<bool>& flags) {
  return std::ranges::find(flags, true) != flags.end();
}

}  // namespace

/// Chooses velocities at the end for the robots whose contacts close now and will act: the mean of
/// both ends would close them. So most plans are solved once.
void IslandPlanner::choose_rules() {
  const double slack = slack_of_mean();
  bool closes = false;
  for (std::size_t k = 0; k < problem_.contacts.size() && !closes; ++k) {
    const ContactPoint& contact = problem_.contacts[k];
    const double least = contact.least_normal_velocity;
    const double mean = 0.5 * (normal_velocity(contact, bodies_.bodies()) + least);
    const double missing = least_of_mean(k) - mean;
    closes = missing > slack &&
             (contact.guess[0] > 0.0 || normal_velocity(contact, problem_.bodies) < least) &&
             !(is_on_curve(k) && missing * span_ <= most_from_curve(k, bodies_.bodies()));
  }
  std::vector<bool> by_end = robots_by_end_;
  for (const ContactPoint& contact : problem_.contacts) {
    for (const std::size_t place : contact.bodies) {
      if (is_link_body(place)) {
        const std::size_t r = state_.robots.robot_of(place);
        by_end[r] = by_end[r] || closes || (contact.guess[0] > 0.0 && leaves(r));
      }
    }
  }
  if (by_end != robots_by_end_) {
    robots_by_end_ = std::move(by_end);
    fly_robots();
  }
}

/// Whether motors answer what a robot at rest touches, and would turn it away without that. Then
/// the forces of its motors in its flight are no estimate for the plan. Where links turn they are,
/// as the flight takes in the contacts. They also are where no link turns in the flight, as masses
/// and Jacobians stay.
///
/// Links at rest turn by a small part of their turn in the flight. A limit of its own for them
/// would take in the time around each turning point, and longer the shorter plans are.
bool IslandPlanner::leaves(std::size_t robot) const {
  const double flies = state_.robots.turn_of(robot, flights_[robot]);
  return state_.robots.has_answering_motors(robot) && flies >= kSwing &&
         turn_of_links() < kRestOfSwing * flies &&
         state_.robots.change_of_way(robot, flights_[robot], span_) > state_.model.distances.least;
}

bool IslandPlanner::is_link_body(std::size_t place) const {
  return place < state_.size() && state_.member(place).link_body;
}

PlanSpan IslandPlanner::plan_span() const {
  const double step = state_.start.h;
  return {.from = state_.start.time + state_.reached,
          .length = span_,
          .catch_up = std::max(step - state_.reached, kLeastShareOfPlan * step)};
}

void IslandPlanner::fly_robots() {
  make_flights();
  set_robots();
}

/// Makes the flights of robots that are not made yet or have loads.
void IslandPlanner::make_flights() {
  end_loads_by_rule();
  const std::vector<Eigen::VectorXd> loads = loads_on_robots();
  if (!loads.empty()) {
    for (RobotFlight& flight : flights_) {
      flight.is_known = false;
    }
  }
  state_.robots.fly(plan_span(), robots_by_end_, loads, flights_);
  for (std::size_t r = 0; r < flights_.size() && loads_; ++r) {
    if (loads_->acts[r]) {
      flights_[r].of_contacts = state_.robots.change_by(r, loads_->on_links, flights_[r]);
    }
  }
}

void IslandPlanner::set_robots() {
  state_.robots.set(flights_, problem_);
  if (!ties_.empty()) {
    lay_ties();
  }
}

/// Makes flights anew for robots whose rule changed. Returns whether there were any.
bool IslandPlanner::lead_robots_by_end(const std::vector<bool>& by_end) {
  std::vector<bool> led =
      state_.robots.led_by_end(problem_, last_->velocities, flights_, by_end, plan_span());
  for (std::size_t r = 0; r < led.size(); ++r) {
    const bool yields = last_->yields && state_.robots.has_rigid_motors(r);
    led[r] = led[r] || robots_by_end_[r] || yields;
  }
  if (led == robots_by_end_) {
    return false;
  }
  robots_by_end_ = std::move(led);
  fly_robots();
  last_.reset();
  return true;
}

/// Finds the link that each member goes with, for robots that move by velocities at the end: its
/// own, or that on which it presses. By the mean of its velocities, a workpiece in a gripper would
/// slip by half of the change of its velocity in a plan.
std::vector<std::optional<std::size_t>> IslandPlanner::carriers() const {
  std::vector<std::optional<std::size_t>> carriers(state_.size());
  bool has_more = false;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (is_link_body(k) && robots_by_end_[state_.robots.robot_of(k)]) {
      carriers[k] = k;
      has_more = true;
    }
  }
  while (has_more && last_) {
    has_more = false;
    for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
      const auto& [a, b] = problem_.contacts[k].bodies;
      const bool presses = !last_->velocities.impulses[k].isZero(0.0);
      if (!presses || a >= state_.size() || b >= state_.size() ||
          carriers[a].has_value() == carriers[b].has_value()) {
        continue;
      }
      const std::size_t carried = carriers[a] ? b : a;
      const bool is_tied =
          !state_.ties.empty() && !state_.model.ties_of[state_.members[carried]].empty();
      if (is_link_body(carried) || !is_tied) {
        carriers[carried] = carriers[carriers[a] ? a : b];
        has_more = true;
      }
    }
  }
  return carriers;
}

/// [rad]  The turn in the plan of the link that turns fastest now.
double IslandPlanner::turn_of_links() const {
  return kMostTurnOfLinks * span_ / state_.robots.longest_span();
}

/// Whether a contact is between two links of one robot.
bool IslandPlanner::is_inner(const ContactPoint& contact) const {
  const auto [a, b] = contact.bodies;
  return is_link_body(a) && is_link_body(b) &&
         state_.robots.robot_of(a) == state_.robots.robot_of(b);
}

/// The impulses of the last solution's contacts on link bodies.
std::vector<LinkImpulse> IslandPlanner::impulses_on_links() const {
  std::vector<LinkImpulse> impulses;
  for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
    const ContactPoint& contact = problem_.contacts[k];
    const Vector3d on_B = contact.frame.transpose() * last_->velocities.impulses[k];
    for (std::size_t s = 0; s < 2 && !on_B.isZero(0.0); ++s) {
      if (is_link_body(contact.bodies[s])) {
        const Vector3d on = s == 0 ? Vector3d(-on_B) : on_B;
        const Vector3d& arm = s == 0 ? contact.arm_A : contact.arm_B;
        impulses.push_back({contact.bodies[s], on, arm.cross(on), is_inner(contact)});
      }
    }
  }
  return impulses;
}

/// Finds the robots whose links turn while contacts change their velocities: inertia acts on the
/// change. They may turn now, or in a flight that contacts keep them from.
std::vector<bool> IslandPlanner::loaded_robots(const std::vector<LinkImpulse>& impulses) const {
  const double tolerance = projection_options(state_, problem_).tolerance;
  std::vector<bool> loaded(state_.robots.size(), false);
  for (const LinkImpulse& impulse : impulses) {
    loaded[state_.robots.robot_of(impulse.member)] = true;
  }
  for (std::size_t r = 0; r < loaded.size(); ++r) {
    if (loads_ && loads_->acts[r]) {
      loaded[r] = true;
    } else if (loaded[r]) {
      const VectorXd change = state_.robots.change_by(r, impulses, flights_[r]);
      const double turn = std::max(turn_of_links(), state_.robots.turn_of(r, flights_[r]));
      loaded[r] =
          !robots_by_end_[r] && turn * fastest_of(state_, r, flights_[r], change) > tolerance;
    }
  }
  return loaded;
}

/// Whether robots with contacts in their flights move otherwise than the last solution has them.
bool IslandPlanner::loads_change_much() const {
  const double tolerance = projection_options(state_, problem_).tolerance;
  for (std::size_t r = 0; r < flights_.size(); ++r) {
    if (loads_->acts[r]) {
      const VectorXd otherwise = flights_[r].end.velocities - last_->velocities.mechanisms[r];
      if (fastest_of(state_, r, flights_[r], otherwise) > tolerance) {
        return true;
      }
    }
  }
  return false;
}

/// Adds the impulses of the last solution's contacts to the flights of robots, as for bodies that
/// spin. Impulses of contacts on which motors yield are too large for that: a flight does not
/// balance them as contacts do. Returns whether that changes the problem.
bool IslandPlanner::follow_loads() {
  if (state_.robots.empty() || last_->is_limited || last_->yields ||
      !is_solved(state_, last_->velocities)) {
    return false;
  }
  std::vector<LinkImpulse> impulses = impulses_on_links();
  std::vector<bool> acts = loaded_robots(impulses);
  if (!is_any(acts)) {
    return false;
  }
  std::vector<RobotFlight> flights = flights_;
  const std::optional<LoadsOfContacts> before = loads_;
  const double energy =
      before ? before->energy
             : kinetic_energy(problem_.mechanisms, velocities_of(problem_.mechanisms));
  loads_ = LoadsOfContacts{std::move(impulses), std::move(acts), energy, {}};
  make_flights();
  if (!loads_change_much()) {
    flights_ = std::move(flights);
    loads_ = before;
    return false;
  }
  set_robots();
  return true;
}

/// Removes contacts from the flights of robots that move by velocities at the end.
void IslandPlanner::end_loads_by_rule() {
  for (std::size_t r = 0; r < robots_by_end_.size() && loads_; ++r) {
    loads_->acts[r] = loads_->acts[r] && !robots_by_end_[r];
  }
  if (loads_ && !is_any(loads_->acts)) {
    forget_flights();
  }
}

/// Computes the forces along the coordinates of robots by ties, forces on links and contacts; empty
/// where there are none.
std::vector<VectorXd> IslandPlanner::loads_on_robots() {
  std::vector<VectorXd> forces = ties_.loads(flights_);
  if (!loads_) {
    return forces;
  }
  forces.resize(state_.robots.size());
  loads_->of_inner.assign(state_.robots.size(), Vector3d::Zero());
  for (std::size_t r = 0; r < forces.size(); ++r) {
    if (!loads_->acts[r]) {
      continue;
    }
    const std::vector<LinkLoad> loads =
        state_.robots.loads_of(r, loads_->on_links, flights_[r], span_);
    for (const LinkLoad& load : loads) {
      if (load.is_inner) {
        loads_->of_inner[r] += span_ * load.torque;
      }
    }
    const VectorXd of_contacts = state_.robots.forces_of(r, loads, flights_[r], span_);
    forces[r] = forces[r].size() > 0 ? VectorXd(forces[r] + of_contacts) : of_contacts;
  }
  return forces;
}

/// Computes the impulses from outside on robots that their flights do not have. They act where the
/// contact problem has them, with its links at the ends of flights. So velocities that contacts
/// allow have their momenta.
///
/// @param outer  all of them
std::vector<OuterImpulse> IslandPlanner::changes_of(std::vector<OuterImpulse> outer) const {
  for (OuterImpulse& change : outer) {
    change.linear.setZero();
    change.angular.setZero();
  }
  const auto add = [&](const LinkImpulse& on, double share) {
    const std::size_t r = state_.robots.robot_of(on.member);
    if (!on.is_inner) {
      const Vector3d centre = state_.robots.centre_at_end(on.member, flights_[r]);
      outer[r].linear += share * on.linear;
      outer[r].angular += share * (on.angular + centre.cross(on.linear));
    }
  };
  if (outer.empty()) {
    return outer;
  }
  for (const LinkImpulse& on : impulses_on_links()) {
    add(on, 1.0);
  }
  if (!loads_) {
    return outer;
  }
  for (const LinkImpulse& on : loads_->on_links) {
    if (loads_->acts[state_.robots.robot_of(on.member)]) {
      add(on, -1.0);
    }
  }
  for (std::size_t r = 0; r < outer.size(); ++r) {
    outer[r].angular -= loads_->of_inner[r];
  }
  return outer;
}

/// Puts the impulses of the last solution into the next flights.
void IslandPlanner::take_loads() {
  if (by_end_) {
    loads_.reset();
  }
  if (loads_ && is_solved(state_, last_->velocities)) {
    loads_->on_links = impulses_on_links();
  }
}

/// Removes contacts from all flights.
void IslandPlanner::forget_flights() {
  loads_.reset();
  for (RobotFlight& flight : flights_) {
    flight.is_known = false;
  }
}

/// Flies robots without contacts where velocities at the end are used, or were limited.
void IslandPlanner::forget_loads() {
  forget_flights();
  fly_robots();
  last_.reset();
}

}  // namespace firstcontact::detail
