#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <firstcontact/simulation/detail/anderson_mixing.h>
#include <firstcontact/simulation/detail/island_plan.h>
#include <firstcontact/simulation/detail/island_response.h>
#include <firstcontact/simulation/detail/island_state.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {

using Eigen::VectorXd;

namespace {

/// [-]  Changes of forces that grow by more from one round to the next never become small.
constexpr double kGrowthOfTies = 1.5;

/// [-]  Impulses are no greater than so many times those that act where flights end.
constexpr double kGrowthOfMixed = 10.0;
/// [rad]  No flight that ties act in turns farther.
constexpr double kWildTurn = 3.0;

}  // namespace

/// The rows of ties for where the bodies fly.
void IslandPlanner::lay_ties() {
  std::vector<Move> moves;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    moves.push_back({0.5 * span_ * (bodies_.bodies()[k].v + flight_.at_end[k].v) + ties_.shift(k),
                     flight_.rotation_vectors[k]});
  }
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
  ties_.lay(bodies_, {moves, flights_, led_by_end(), at_end, spinning}, problem_);
  laid_by_end_ = by_end_;
}

/// Makes flights and rows anew, and solves.
void IslandPlanner::fly_with_ties() {
  fly_bodies();
  if (state_.robots.empty()) {
    lay_ties();
  } else {
    fly_robots();
  }
  last_.reset();
  solve();
  by_end_ = by_end_ || !mean_is_allowed();
}

/// Lets the forces of ties act in the flights of bodies and robots, until they stay the same. Where
/// repeats do not find them, changes are mixed: a force on a long arm or on a light link turns it
/// more than it moves it. Near positions in which a loop is singular that does not find them
/// either: there nothing is predicted, and velocities are projected where flights end, which adds
/// no energy.
void IslandPlanner::follow_ties() {
  if (!repeat_forces_of_ties()) {
    forget_ties();
    if (!mix_forces_of_ties()) {
      forget_ties();
    }
  }
}

/// Returns whether the forces were found.
bool IslandPlanner::repeat_forces_of_ties() {
  double before = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostRoundsOfTies; ++round) {
    const double change = ties_.greatest_change(last_->velocities.ties);
    const bool is_near = change <= kNearChangeOfTies;
    const bool is_done = change <= kChangeOfTies || (is_near && change > 0.5 * before);
    if (is_done && laid_by_end_ == by_end_) {
      return true;
    }
    const bool is_last = round + 1 == kMostRoundsOfTies;
    if ((!is_near && (is_last || !(change <= kGrowthOfTies * before))) || turns_wildly()) {
      return false;
    }
    before = change;
    predict_ties(ties_.predicted() + changes_of_ties());
  }
  return !turns_wildly();
}

/// Likewise, by mixing. The first guess is no impulse at all, too far from the others to count.
bool IslandPlanner::mix_forces_of_ties() {
  AndersonMixing mixing;
  const double most = kGrowthOfMixed * changes_of_ties().norm();
  predict_ties(changes_of_ties());
  for (int round = 0; round < kMostMixedRoundsOfTies; ++round) {
    if (ties_.greatest_change(last_->velocities.ties) <= kMixedChangeOfTies &&
        laid_by_end_ == by_end_) {
      return true;
    }
    const VectorXd guess = mixing.next(ties_.predicted(), changes_of_ties());
    if (!(guess.norm() <= most) || turns_wildly()) {  // Flights would turn without end.
      return false;
    }
    predict_ties(guess);
  }
  return !turns_wildly() && ties_.greatest_change(last_->velocities.ties) <= kNearChangeOfTies;
}

/// Whether a flight turns much farther than plans of tied bodies do.
bool IslandPlanner::turns_wildly() const {
  return std::ranges::any_of(flight_.rotation_vectors, [](const Eigen::Vector3d& turn) {
    return !(turn.norm() <= kWildTurn);
  });
}

/// Those that the last solution found.
VectorXd IslandPlanner::changes_of_ties() const {
  const std::vector<double>& changes = last_->velocities.ties;
  return VectorXd::Map(changes.data(), static_cast<Eigen::Index>(changes.size()));
}

/// Lets ties act in flights by these impulses, and solves.
void IslandPlanner::predict_ties(const VectorXd& impulses) {
  ties_.predict(impulses);
  take_spins();
  take_loads();
  fly_with_ties();
}

/// Predicts no forces of ties, and solves.
void IslandPlanner::forget_ties() {
  ties_.forget();
  loads_.reset();
  flights_.clear();
  for (ContactPoint& contact : problem_.contacts) {
    contact.guess.setZero();
  }
  fly_with_ties();
}

/// Adds displacements without velocity that bring joints of ties together, and cables back to their
/// length, where the plan ends. Contacts come no nearer by them.
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
  for (int round = 0; round < kRoundsOfSettling; ++round) {
    state_.robots.set_moves(plan.robots, state_.states, span_, plan.moves);
    std::vector<Pose> at_end;
    for (std::size_t k = 0; k < state_.size(); ++k) {
      at_end.push_back(motion_of(state_.member(k), state_.states[k].X_WB, plan.moves[k]).pose(1.0));
    }
    ContactProblem problem = resting;
    const double off = ties_.add_settling(at_end, last_->velocities.ties, bodies_, problem);
    if (!(off > tolerance)) {
      return;
    }
    const ContactSolution way = project_on_contacts(problem, {.tolerance = 0.1 * tolerance});
    if (!(way.residual < off)) {
      return;
    }
    double farthest = 0.0;     // [m]
    double most_turned = 0.0;  // [rad]
    for (std::size_t k = 0; k < state_.size(); ++k) {
      farthest = std::max(farthest, way.bodies[k].v.norm());
      most_turned = std::max(most_turned, way.bodies[k].w.norm());
    }
    if (!(farthest <= kFarthestOfGap * off) || !(most_turned <= kMostTurnOfTied)) {
      return;  // Near a singular position.
    }
    for (std::size_t k = 0; k < state_.size(); ++k) {
      plan.moves[k].translation += way.bodies[k].v;
      plan.moves[k].rotation_vector += way.bodies[k].w;
    }
    state_.robots.displace(way.mechanisms, plan.robots);
  }
}

}  // namespace firstcontact::detail
