#include <firstcontact/simulation/detail/island_response.h>

#include <algorithm>
#include <cmath>

#include <firstcontact/contact_solver/detail/re_solve.h>
#include <firstcontact/simulation/detail/constants.h>
#include <firstcontact/simulation/detail/island_state.h>
#include <firstcontact/simulation/detail/response.h>
#include <firstcontact/simulation/detail/sequential_impacts.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [m/s, rad/s]  The greatest part of any velocity.
double fastest(const ContactSolution& solution) {
  double greatest = 0.0;
  for (const ContactBody& body : solution.bodies) {
    greatest = std::max({greatest, body.v.cwiseAbs().maxCoeff(), body.w.cwiseAbs().maxCoeff()});
  }
  for (const Eigen::VectorXd& velocities : solution.mechanisms) {
    greatest = std::max(greatest, velocities.cwiseAbs().maxCoeff());
  }
  return greatest;
}

/// [m/s]  A part of what gravity adds in a step.
double of_gravity(const IslandState& state, double part) {
  return std::max(kLeastTolerance, part * state.model.gravity.norm() * state.start.h);
}

/// [J]  Of the members and their robots.
double energy_of(const IslandState& state, const ContactProblem& problem,
                 const std::vector<ContactBody>& bodies,
                 const std::vector<Eigen::VectorXd>& mechanisms) {
  double sum = kinetic_energy(problem.mechanisms, mechanisms);
  for (std::size_t k = 0; k < state.size(); ++k) {
    if (!state.member(k).piece) {
      sum +=
          kinetic_energy(state.member(k).inertia, {state.states[k].X_WB, bodies[k].v, bodies[k].w});
    }
  }
  return sum;
}

/// Contacts add no energy: without moving bodies around, what they allow contains rest, and the
/// projection on it makes no velocity longer in the kinetic metric. A scripted body adds at most
/// its own speed twice, and so does a belt. Of a problem without solution, as of a body that is
/// crushed, the solver's answer is anything: it is shortened to what there was before, or to what
/// moves with the script. Motors add what they want, as long as there is a solution.
///
/// @returns whether it was shortened
bool limit_energy(const IslandState& state, const ContactProblem& problem,
                  ContactSolution& solution) {
  const double left = state.robots.empty() ? solution.allowed : 0.0;
  const bool is_solved = solution.residual <= std::max({left, of_gravity(state, kUnsolved),
                                                        kUnsolvedOfSpeed * fastest(solution)});
  if (is_solved && state.robots.has_motors()) {
    return false;
  }
  const double before =
      energy_of(state, problem, problem.bodies, velocities_of(problem.mechanisms));
  const double after = energy_of(state, problem, solution.bodies, solution.mechanisms);
  double mass = 0.0;
  for (std::size_t k = 0; k < state.size(); ++k) {
    mass += state.member(k).inertia.mass;
  }
  double speed = 0.0;
  for (const ContactPoint& contact : problem.contacts) {
    speed = std::max(speed, contact.sticking_velocity.norm());
    for (int side = 0; side < 2; ++side) {
      const ContactBody& body = problem.bodies[contact.bodies[side]];
      if (contact.bodies[side] >= state.size()) {
        const Vector3d& arm = side == 0 ? contact.arm_A : contact.arm_B;
        speed = std::max(speed, (body.v + body.w.cross(arm)).norm());
      }
    }
  }
  const double along = speed * std::sqrt(0.5 * mass);
  const double allowed =
      is_solved ? std::sqrt(before) + 2.0 * along : std::max(std::sqrt(before), along);
  if (std::sqrt(after) <= allowed * (1.0 + 1e-9)) {
    return false;
  }
  const double share = allowed / std::sqrt(after);
  for (std::size_t k = 0; k < state.size(); ++k) {
    solution.bodies[k].v *= share;
    solution.bodies[k].w *= share;
  }
  for (Eigen::VectorXd& velocities : solution.mechanisms) {
    velocities *= share;
  }
  return true;
}

/// Whether sweeps alone would not do.
bool has_many(const IslandState& state, const ContactProblem& problem) {
  return problem.contacts.size() >= kHeapContacts && state.size() >= kHeapBodies;
}

/// Whether no member moves by more than what the solver may leave.
bool stands(const IslandState& state) {
  const double slow = of_gravity(state, kStandsOfGravity);
  for (std::size_t k = 0; k < state.size(); ++k) {
    const RigidState& member = state.states[k];
    if (!(member.v_WC.norm() + state.member(k).reach * member.w_WB.norm() <= slow)) {
      return false;
    }
  }
  return true;
}

PlanSolution project_with(const IslandState& state, const ContactProblem& problem,
                          const ProjectionOptions& options) {
  if (problem.contacts.empty() && problem.drives.empty()) {
    return {unchanged(problem)};
  }
  PlanSolution plan{project_on_contacts(problem, options)};
  plan.is_limited = limit_energy(state, problem, plan.velocities);
  return plan;
}

}  // namespace

double exact_tolerance(const IslandState& state) { return of_gravity(state, kExactTolerance); }

bool is_heap(const IslandState& state, const ContactProblem& problem) {
  return has_many(state, problem) && !stands(state);
}

ProjectionOptions projection_options(const IslandState& state, const ContactProblem& problem) {
  const double exact = exact_tolerance(state);
  if (has_many(state, problem)) {
    if (stands(state)) {
      return {.tolerance = exact};
    }
    return {.tolerance = of_gravity(state, kHeapTolerance),
            .enough = of_gravity(state, kHeapEnough),
            .sweeps = kHeapSweeps,
            .rounds = kRoundsOfMany};
  }
  if (problem.contacts.size() >= kManyContactsOfIsland) {
    return {.tolerance = of_gravity(state, kHeapTolerance), .rounds = kRoundsOfMany};
  }
  return {.tolerance = exact, .rounds = kRoundsOfMany};
}

/// Free bodies that are hit within a plan need not be solved as exactly as those that an impact
/// parts.
ProjectionOptions plan_options(const IslandState& state, const ContactProblem& problem) {
  ProjectionOptions options = projection_options(state, problem);
  if (state.size() >= kSeveralBodies && state.robots.empty() && !state.model.gravity.isZero(0.0)) {
    options.of_hits = kPartOfHits;
    options.hit = of_gravity(state, kHitOfGravity);
  }
  return options;
}

PlanSolution project_plan(const IslandState& state, const ContactProblem& problem) {
  return project_with(state, problem, plan_options(state, problem));
}

PlanSolution project_way(const IslandState& state, const ContactProblem& problem, double span) {
  ProjectionOptions options = plan_options(state, problem);
  options.tolerance =
      std::max(options.tolerance, kToleranceOfWay * state.model.distances.least / span);
  options.space = ProjectionSpace::contact;
  options.sweeps = kSweepsOfWay;
  return project_with(state, problem, options);
}

std::optional<PlanSolution> project_plan_again(const IslandState& state,
                                               const ContactProblem& problem,
                                               const PlanSolution& before,
                                               const std::vector<std::size_t>& changed) {
  if (!is_heap(state, problem) || !state.robots.empty() || before.is_limited) {
    return std::nullopt;
  }
  PlanSolution plan{
      re_solve(problem, before.velocities, changed,
               {.tolerance = of_gravity(state, kAroundTolerance), .sweeps = kAroundSweeps})};
  if (plan.velocities.residual > projection_options(state, problem).enough) {
    return std::nullopt;
  }
  plan.is_limited = limit_energy(state, problem, plan.velocities);
  return plan;
}

ContactSolution project_impact_of(const IslandState& state, const ContactProblem& problem,
                                  const std::vector<BodyPair>& pairs) {
  std::vector<double> restitution;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    restitution.push_back(restitution_of(state, pairs[k], problem.contacts[k], problem.bodies));
  }
  const bool bounces = std::ranges::any_of(restitution, [](double e) { return e > 0.0; });
  return bounces && state.model.impacts == ImpactLaw::sequential
             ? project_sequential_impacts(state, problem, pairs)
             : project_simultaneous_impact(state, problem, restitution);
}

double slowest_bounce(const IslandState& state) {
  return kStepsWithoutBounce * state.model.gravity.norm() * state.start.h;
}

double restitution_of(const IslandState& state, const BodyPair& pair, const ContactPoint& contact,
                      const std::vector<ContactBody>& bodies) {
  return state.bounces(pair, -normal_velocity(contact, bodies)) ? state.model.laws.restitution(pair)
                                                                : 0.0;
}

ContactSolution project_simultaneous_impact(const IslandState& state, const ContactProblem& problem,
                                            const std::vector<double>& restitution) {
  ContactSolution solution = project_impact(
      problem, restitution, state.size(),
      [&](const auto& moving, const auto& mechanisms) {
        return energy_of(state, problem, moving, mechanisms);
      },
      projection_options(state, problem));
  limit_energy(state, problem, solution);
  return solution;
}

}  // namespace firstcontact::detail
