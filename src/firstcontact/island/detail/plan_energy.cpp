#include <firstcontact/island/detail/plan_energy.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/island/detail/energy_limit.h>
#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [-]  Greatest work of contacts in a step, by the kinetic energy, and lift in it, by the contact
/// distance. Smaller: plans become shorter where contacts are right to second order.
constexpr double kEnergyOfContacts = 1e-3;
constexpr double kLiftOfContacts = 0.1;

/// Energies of an island.
struct Energy {
  double kinetic = 0.0;    // [J]
  double potential = 0.0;  // [J]
  double slack = 0.0;      // [J]  Energy of a height of one contact distance.
};

/// Whether only gravity acts, and joints whose other ends rest.
bool is_conservative(const IslandState& state, const Plan& plan, const ContactSolution& solution) {
  const auto is_joint = [&](std::size_t t) { return state.model.ties[t].is_joint(); };
  const auto is_none = [](const Vector3d& impulse) { return impulse.isZero(0.0); };
  return !state.ties.empty() && std::ranges::all_of(state.ties, is_joint) &&
         !is_pulled(state.model, state.start, state.members) &&
         std::ranges::all_of(solution.impulses, is_none) && state.robots.are_passive(plan.robots) &&
         std::ranges::all_of(state.members, [&](std::size_t body) {
           return state.model.bodies[body].forces.empty();
         });
}

/// Whether a body turns so far in a plan that the solution alone does not limit the energy.
bool turns_far(const IslandState& state, double span) {
  return std::ranges::any_of(state.states, [&](const RigidState& moving) {
    return span * moving.w_WB.norm() > kTurnOfEnergy;
  });
}

/// Whether only gravity acts, and contacts with each other or with what stands still.
bool is_passive(const IslandState& state, const ContactProblem& problem) {
  const auto has_forces = [&](std::size_t body) {
    return !state.model.bodies[body].forces.empty();
  };
  const auto is_moved = [&](std::size_t place) {
    return place >= state.size() &&
           (problem.bodies[place].v.any() || problem.bodies[place].w.any());
  };
  return state.ties.empty() && state.robots.empty() && !state.model.laws.has_belts() &&
         std::ranges::none_of(state.members, has_forces) &&
         std::ranges::none_of(problem.contacts, [&](const ContactPoint& contact) {
           return std::ranges::any_of(contact.bodies, is_moved);
         });
}

void add(const IslandState& state, const SimBody& body, const RigidState& moving, Energy& energy) {
  const Vector3d& g = state.model.gravity;
  energy.kinetic += kinetic_energy(body.inertia, moving);
  energy.potential -= body.inertia.mass * g.dot(centre_of_mass(body.inertia, moving.X_WB));
  energy.slack += body.inertia.mass * g.norm() * state.model.distances.least;
}

}  // namespace

bool keeps_tied_energy(const IslandState& state, const Plan& plan, const ContactSolution& solution,
                       double span) {
  if (!is_conservative(state, plan, solution)) {
    return true;
  }
  Energy now;
  Energy end;
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (!state.member(k).link_body) {
      add(state, state.member(k), state.states[k], now);
      add(state, state.member(k), state_ahead(state, plan, k, 1.0), end);
    }
  }
  for (std::size_t r = 0; r < state.robots.size(); ++r) {
    const MechanismMechanics from = state.robots.mechanics(r);
    const MechanismMechanics to = state.robots.mechanics(r, plan.robots[r].end);
    now.kinetic += from.kinetic_energy;
    now.potential += from.potential_energy;
    end.kinetic += to.kinetic_energy;
    end.potential += to.potential_energy;
    now.slack += from.mass * state.model.gravity.norm() * state.model.distances.least;
  }
  const double change = end.kinetic + end.potential - now.kinetic - now.potential;
  const double most = kEnergyOfTied * std::max(now.kinetic, end.kinetic) + now.slack;
  return std::abs(change) <= span / state.start.h * most;
}

bool contacts_add_no_energy(const IslandState& state, const Plan& plan,
                            const ContactProblem& problem, double span) {
  if (problem.contacts.empty() || !turns_far(state, span) || !is_passive(state, problem)) {
    return true;
  }
  Energy now;
  Energy end;
  for (std::size_t k = 0; k < state.size(); ++k) {
    add(state, state.member(k), state.states[k], now);
    add(state, state.member(k), state_ahead(state, plan, k, 1.0), end);
  }
  const double gain = end.kinetic + end.potential - now.kinetic - now.potential;
  const double lift = static_cast<double>(state.size()) * now.slack;
  return gain <= span / state.start.h * kEnergyOfTurning * now.kinetic + lift;
}

/// The velocities before the plan, in the axes of those of the solution. Where a body does not
/// spin, they are those of its free flight, without what its forces add.
std::vector<ContactBody> IslandPlanner::before_contacts() const {
  std::vector<ContactBody> before = bodies_.bodies();
  for (std::size_t k = 0; k < state_.size(); ++k) {
    if (!is_link_body(k) && !spins(k)) {
      before[k].w =
          flight_.at_end[k].w - span_ * (before[k].inverse_inertia.rotation * flight_.torques[k]);
    }
  }
  return before;
}

/// [m/s]  The mean over the plan of the velocity that belts give a contact.
Eigen::Vector2d IslandPlanner::mean_belt(std::size_t k) const {
  if (!acts(k)) {
    return problem_.contacts[k].sticking_velocity;
  }
  return acting_[k].now.sticking_velocity + 0.5 * acting_[k].change_of_belt;
}

/// [J]  The energy that contacts add to what forces, ties, drives, belts and scripts add. What
/// friction takes does not count, nor does what contacts give where links drift together.
///
/// Derivation: impulses P change the kinetic energy by the sum of P u. Here u is the mean of the
/// velocities before and after all impulses, at the place where P acts. That is exact for constant
/// masses, whatever else acts.
double IslandPlanner::work_of_contacts() const {
  const ContactSolution& solution = last_->velocities;
  const std::vector<ContactBody> before = before_contacts();
  double of_normals = 0.0;
  double of_friction = 0.0;
  for (std::size_t k = 0; k < problem_.contacts.size(); ++k) {
    const ContactPoint& contact = problem_.contacts[k];
    const Vector3d& impulse = solution.impulses[k];
    const Vector3d mean =
        0.5 * (relative_velocity(contact, before) + relative_velocity(contact, solution.bodies));
    const double drift = drift_along(touches_[k].bodies, contact) / span_;
    of_normals += impulse[0] * (mean[0] + std::min(0.0, drift));
    of_friction += impulse.tail<2>().dot(mean.tail<2>() - mean_belt(k));
  }
  return of_normals + std::max(0.0, of_friction);
}

/// Whether contacts do no work, to the precision of plans. True where they have no solution, as
/// their impulses are arbitrary then.
bool IslandPlanner::contacts_do_no_work() const {
  const ContactSolution& solution = last_->velocities;
  if (symmetric_ || last_->slips || last_->yields || !is_solved(state_, solution)) {
    return true;
  }
  double pressing = 0.0;  // [N s]
  for (const Vector3d& impulse : solution.impulses) {
    pressing += impulse[0];
  }
  const double h = state_.start.h;
  const double lifting = kLiftOfContacts * state_.model.distances.least / h;  // [m/s]
  const double lift = (lifting + 2.0 * projection_options(state_, problem_).tolerance) * pressing;
  const double work = work_of_contacts();
  if (work <= lift) {
    return true;
  }
  const double most =
      kEnergyOfContacts * energy_of(state_, problem_, solution.bodies, solution.mechanisms);
  // In the shortest plans work changes its sign where the mean rule is as precise as it can be.
  const bool is_shortest = span_ <= kLeastShareOfTied * h;
  const double of_mean = is_shortest ? std::min(most, slack_of_mean() * pressing) : 0.0;
  return work <= lift + span_ / h * most + of_mean;
}

}  // namespace firstcontact::detail
