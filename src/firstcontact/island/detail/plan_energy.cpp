#include <firstcontact/island/detail/plan_energy.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/kinetics.h>
#include <firstcontact/island/detail/island_plan.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/island_ties.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

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

}  // namespace firstcontact::detail
