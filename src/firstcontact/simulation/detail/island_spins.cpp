#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <firstcontact/motion/detail/turn.h>
#include <firstcontact/simulation/detail/island_plan.h>
#include <firstcontact/simulation/detail/island_state.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/sim_body.h>

namespace firstcontact::detail {

using Eigen::Vector3d;

/// Whether gyroscopic moments act on a member that turns much in the plan. Robots and ties have
/// flights of their own.
bool IslandPlanner::may_spin(std::size_t k) const {
  const Inertia& inertia = state_.member(k).inertia;
  const double turn = span_ * state_.states[k].w_WB.norm();
  return state_.robots.empty() && state_.ties.empty() && !is_locked(inertia) &&
         !is_isotropic(inertia) && turn > kSpin && turn < kMostSpin;
}

/// [N m s]  Of the contacts on each member in the last solution.
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

/// Lets bodies that spin turn with the angular impulses of the last solution, as ties do with
/// theirs: gyroscopic moments act on what these impulses change. The next solution finds all of the
/// impulses again, so what they do to the velocities is taken off the flight. Returns whether that
/// changes the problem.
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
    if (impulses[k].isZero(0.0) && !(spins_ && spins_->is_member[k])) {
      continue;
    }
    const Inertia& inertia = state_.member(k).inertia;
    const RigidState& state = state_.states[k];
    const Vector3d& torque = spins_ ? spins_->without.torques[k] : flight_.torques[k];
    const FreeTurn flown = free_turn(inertia, state, torque + impulses[k] / span_, span_);
    const InverseInertia at_end = inverse_inertia(
        inertia, {state.X_WB.position, turn(flown.rotation_vector) * state.X_WB.rotation});
    const Vector3d w = flown.w_WB - at_end.rotation * impulses[k];
    ContactBody& body = problem_.bodies[k];
    const Vector3d otherwise =
        w - body.w + (at_end.rotation - body.inverse_inertia.rotation) * impulses[k];
    if (!(state_.member(k).reach * otherwise.norm() > tolerance)) {
      continue;
    }
    if (!spins_) {
      spins_ =
          Spins{flight_, free_energy(state_, problem_), std::vector<bool>(state_.size(), false)};
    }
    spins_->is_member[k] = true;
    body.inverse_inertia = at_end;
    body.w = w;
    flight_.rotation_vectors[k] = flown.rotation_vector;
    flight_.at_end[k].w = flown.w_WB;
    is_changed = true;
  }
  if (is_changed) {
    last_.reset();
  }
  return is_changed;
}

/// Where velocities at the end lead, bodies keep the velocities that they have without contacts.
void IslandPlanner::forget_spins() {
  flight_ = std::move(spins_->without);
  const std::vector<ContactBody>& now = bodies_.bodies();
  for (std::size_t k = 0; k < state_.size(); ++k) {
    problem_.bodies[k].w = flight_.at_end[k].w;
    problem_.bodies[k].inverse_inertia = now[k].inverse_inertia;
  }
  spins_.reset();
  last_.reset();
}

/// Gives velocities at the end the coordinates that they have in the axes of now.
void IslandPlanner::carry_back(Plan& plan) const {
  for (std::size_t k = 0; k < state_.size() && spins_; ++k) {
    if (spins_->is_member[k]) {
      plan.at_end[k].w =
          turned_along(state_.member(k).inertia, plan.at_end[k].w, -plan.moves[k].rotation_vector);
    }
  }
}

}  // namespace firstcontact::detail
