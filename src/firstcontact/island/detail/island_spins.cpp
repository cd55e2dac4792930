#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact::detail {

using Eigen::Vector3d;

/// Whether gyroscopic moments act on a member that turns much in the plan. Robots have flights of
/// their own.
bool IslandPlanner::may_spin(std::size_t k) const {
  const SimBody& member = state_.member(k);
  const double turn = span_ * state_.states[k].w_WB.norm();
  return !member.link_body && !is_locked(member.inertia) && !is_isotropic(member.inertia) &&
         turn > kSpin && turn < kMostSpin;
}

bool IslandPlanner::spins(std::size_t k) const { return spins_ && spins_->impulses[k]; }

/// [N m s]  The angular impulses of the contacts on each member in the last solution.
std::vector<Vector3d> IslandPlanner::angular_impulses() const {
  std::vector<Vector3d> impulses(state_.size(), Vector3d::Zero());
  for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
    const ContactPoint& contact = problem_.contacts[k];
    const Vector3d on_B = contact.frame.transpose() * last_->velocities.impulses[k];
    const auto [A, B] = contact.bodies;
    if (A < state_.size()) {
      impulses[A] -= contact.arm_A.cross(on_B);
    }
    if (B < state_.size()) {
      impulses[B] += contact.arm_B.cross(on_B);
    }
  }
  return impulses;
}

/// Adds the angular impulses of the last solution to the flights of bodies that spin, as for ties.
/// Gyroscopic moments act on the changes by these impulses. Returns whether that changes the
/// problem.
bool IslandPlanner::follow_spins() {
  if (last_->is_limited || !is_solved(state_, last_->velocities)) {
    return false;
  }
  const double tolerance = projection_options(state_, problem_).tolerance;
  std::vector<Vector3d> impulses;
  bool is_changed = false;
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (!may_spin(k)) {
      continue;
    }
    if (impulses.empty()) {
      impulses = angular_impulses();
    }
    if (!impulses[k].isZero(0.0) || spins(k)) {
      is_changed = spin(k, impulses[k], tolerance) || is_changed;
    }
  }
  return is_changed;
}

/// Adds an angular impulse of contacts [N m s] to a member's flight, if it changes the velocity by
/// more than a tolerance [m/s]. The next solution finds all of the impulses again, so the change of
/// velocity by this one is subtracted from the flight.
bool IslandPlanner::spin(std::size_t k, const Vector3d& impulse, double tolerance) {
  const Inertia& inertia = state_.member(k).inertia;
  const RigidState& state = state_.states[k];
  const FreeTurn flown = free_turn(inertia, state, flight_.torques[k] + impulse / span_, span_);
  const InverseInertia at_end = inverse_inertia(
      inertia, {state.X_WB.position, turn(flown.rotation_vector) * state.X_WB.rotation});
  const Vector3d w = flown.w_WB - at_end.rotation * impulse;
  ContactBody& body = problem_.bodies[k];
  const Vector3d otherwise =
      w - body.w + (at_end.rotation - body.inverse_inertia.rotation) * impulse;
  if (!(state_.member(k).reach * otherwise.norm() > tolerance)) {
    return false;
  }
  if (!spins_) {
    spins_ = Spins{std::vector<std::optional<Vector3d>>(state_.size()),
                   free_energy(state_, {.bodies = flight_.at_end})};
  }
  spins_->impulses[k] = impulse;
  body.inverse_inertia = at_end;
  body.w = w;
  flight_.rotation_vectors[k] = flown.rotation_vector;
  flight_.at_end[k].w = flown.w_WB;
  return true;
}

/// Makes the flights of all bodies, with the predicted forces of their ties and the impulses of
/// contacts on those that spin.
void IslandPlanner::fly_bodies() {
  flight_ = free_flight();
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (!state_.member(k).link_body) {
      problem_.bodies[k] = flight_.at_end[k];
    }
  }
  if (!spins_) {
    return;
  }
  spins_->energy = free_energy(state_, {.bodies = flight_.at_end});
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (spins(k)) {
      spin(k, Vector3d(*spins_->impulses[k]), -1.0);
    }
  }
}

/// Puts the impulses of the last solution into the next flights.
void IslandPlanner::take_spins() {
  if (by_end_) {
    spins_.reset();
  }
  if (!spins_ || !is_solved(state_, last_->velocities)) {
    return;
  }
  const std::vector<Vector3d> impulses = angular_impulses();
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (spins(k)) {
      spins_->impulses[k] = impulses[k];
    }
  }
}

/// Flies bodies without the impulses of contacts, where they move by velocities at the end.
void IslandPlanner::forget_spins() {
  spins_.reset();
  fly_bodies();
  if (!ties_.empty()) {
    lay_ties();
  }
  last_.reset();
}

/// Solves without spins and loads of contacts where they cannot act.
void IslandPlanner::end_spins() {
  if (!(spins_ || loads_) || !(by_end_ || last_->is_limited)) {
    return;
  }
  if (loads_) {
    forget_loads();
  }
  if (spins_) {
    forget_spins();
  }
  solve();
  by_end_ = by_end_ || !mean_is_allowed();
}

/// Gives velocities at the end their coordinates in the axes of now.
void IslandPlanner::carry_back(Plan& plan) const {
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (spins(k)) {
      plan.at_end[k].w =
          turned_along(state_.member(k).inertia, plan.at_end[k].w, -plan.moves[k].rotation_vector);
    }
  }
}

}  // namespace firstcontact::detail
