#include <firstcontact/island/detail/island_response.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <firstcontact/contact_solver/detail/re_solve.h>
#include <firstcontact/island/detail/energy_limit.h>
#include <firstcontact/island/detail/island_state.h>
#include <firstcontact/island/detail/sequential_impacts.h>
#include <firstcontact/simulation_model/detail/constants.h>
#include <firstcontact/simulation_model/detail/response.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// [m/s, rad/s]  The greatest component of any velocity.
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

/// [m/s]  A fraction of what gravity adds in a step.
double of_gravity(const IslandState& state, double part) {
  return std::max(kLeastTolerance, part * state.model.gravity.norm() * state.start.h);
}

/// Makes the problem with motors that yield a little to contacts and limits that leave no room for
/// their target velocities. Nothing where no motor is stronger than any force.
std::optional<ContactProblem> with_yielding_motors(const ContactProblem& problem) {
  std::optional<ContactProblem> yielding;
  for (std::size_t k = 0; k < problem.drives.size(); ++k) {
    const JointDrive& drive = problem.drives[k];
    if (is_unbounded(drive)) {
      yielding = yielding ? std::move(yielding) : std::optional(problem);
      const auto c = static_cast<Eigen::Index>(drive.coordinate);
      yielding->drives[k].compliance =
          kYield * problem.mechanisms[drive.mechanism].inverse_mass(c, c);
    }
  }
  return yielding;
}

/// Whether scripts push an island. A script that waited in the step before does not count: the
/// bodies that it would push are jammed.
bool is_pushed(const IslandState& state, const ContactProblem& problem) {
  const auto around = problem.bodies.begin() + static_cast<std::ptrdiff_t>(state.size());
  return std::ranges::find(state.start.waited, true) == state.start.waited.end() &&
         std::any_of(around, problem.bodies.end(),
                     [](const ContactBody& body) { return body.v.any() || body.w.any(); });
}

/// Makes the problem with contacts that slip. Nothing where none has friction.
std::optional<ContactProblem> with_slippery_contacts(const ContactProblem& problem) {
  ContactProblem slippery = problem;
  bool has_friction = false;
  for (ContactPoint& contact : slippery.contacts) {
    has_friction = has_friction || contact.friction > 0.0;
    contact.friction *= kSlippery;
    contact.guess.setZero();
  }
  return has_friction ? std::optional(std::move(slippery)) : std::nullopt;
}

/// Whether sweeps alone would not converge.
bool has_many(const IslandState& state, std::size_t contacts) {
  return contacts >= kHeapContacts && state.size() >= kHeapBodies;
}

/// Whether no member moves faster than the residual of the solver.
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

PlanSolution project_with_motors(const IslandState& state, const ContactProblem& problem,
                                 const ProjectionOptions& options, std::optional<double> free) {
  PlanSolution plan{project_on_contacts(problem, options)};
  if (!is_solved(state, plan.velocities) || squeezes_out(state, problem, plan.velocities, free)) {
    if (const std::optional<ContactProblem> yielding = with_yielding_motors(problem)) {
      plan.velocities = project_on_contacts(*yielding, options);
      plan.yields = true;
    }
  }
  plan.is_limited = limit_energy(state, problem, plan.velocities, plan.yields, free);
  return plan;
}

PlanSolution project_with(IslandState& state, const ContactProblem& problem,
                          const ProjectionOptions& options,
                          std::optional<double> free = std::nullopt) {
  if (problem.contacts.empty() && problem.drives.empty() && problem.ties.empty()) {
    return {unchanged(problem)};
  }
  PlanSolution plan = project_with_motors(state, problem, options, free);
  if (is_solved(state, plan.velocities) || state.slips >= kMostSlips ||
      !is_pushed(state, problem)) {
    return plan;
  }
  if (const std::optional<ContactProblem> slippery = with_slippery_contacts(problem)) {
    ++state.slips;
    PlanSolution slipping = project_with_motors(state, *slippery, options, free);
    if (is_solved(state, slipping.velocities)) {
      slipping.velocities.residual = contact_residual(problem, slipping.velocities);
      slipping.slips = true;
      return slipping;
    }
  }
  return plan;
}

}  // namespace

double free_energy(const IslandState& state, const ContactProblem& problem) {
  return energy_of(state, problem, problem.bodies, velocities_of(problem.mechanisms));
}

bool is_solved(const IslandState& state, const ContactSolution& solution) {
  const double left = state.robots.empty() ? solution.allowed : 0.0;
  return solution.residual <=
         std::max({left, of_gravity(state, kUnsolved), kUnsolvedOfSpeed * fastest(solution)});
}

double exact_tolerance(const IslandState& state) { return of_gravity(state, kExactTolerance); }

bool is_finite(const ContactSolution& solution) {
  const auto is_finite = [](double number) { return std::isfinite(number); };
  return std::ranges::all_of(
             solution.bodies,
             [](const ContactBody& body) { return body.v.allFinite() && body.w.allFinite(); }) &&
         std::ranges::all_of(solution.mechanisms,
                             [](const Eigen::VectorXd& v) { return v.allFinite(); }) &&
         std::ranges::all_of(solution.impulses,
                             [](const Vector3d& impulse) { return impulse.allFinite(); }) &&
         std::ranges::all_of(solution.drives, is_finite) &&
         std::ranges::all_of(solution.ties, is_finite) && std::isfinite(solution.residual);
}

bool is_heap(const IslandState& state, std::size_t contacts) {
  return has_many(state, contacts) && !stands(state);
}

ProjectionOptions projection_options(const IslandState& state, const ContactProblem& problem) {
  const bool is_of_many = has_many(state, problem.contacts.size());
  const bool is_large = is_of_many || problem.contacts.size() >= kManyContactsOfIsland;
  if (is_of_many && stands(state)) {  // As many rounds as it takes.
    return {.tolerance = exact_tolerance(state)};
  }
  if (!is_large || stands(state)) {
    return {.tolerance = exact_tolerance(state), .rounds = kRoundsOfMany};
  }
  ProjectionOptions options{.tolerance = of_gravity(state, kHeapTolerance),
                            .rounds = kRoundsOfMany};
  if (is_of_many) {
    options.enough = of_gravity(state, kHeapEnough);
    options.sweeps = kHeapSweeps;
  }
  return options;
}

/// Chooses the options of a plan. Free bodies that meet within a plan need not be solved as exactly
/// as those that an impact parts.
ProjectionOptions plan_options(const IslandState& state, const ContactProblem& problem) {
  ProjectionOptions options = projection_options(state, problem);
  if (state.size() >= kSeveralBodies && state.robots.empty() && !state.model.gravity.isZero(0.0)) {
    options.of_hits = kPartOfHits;
    options.hit = of_gravity(state, kHitOfGravity);
  }
  return options;
}

PlanSolution project_plan(IslandState& state, const ContactProblem& problem,
                          std::optional<double> free) {
  return project_with(state, problem, plan_options(state, problem), free);
}

PlanSolution project_way(IslandState& state, const ContactProblem& problem, double span) {
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
  if (!is_heap(state, problem.contacts.size()) || !state.robots.empty() || before.is_limited ||
      !problem.ties.empty()) {
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
  const auto project = [&](const ContactProblem& given) {
    return project_impact(
        given, restitution, state.size(),
        [&](const auto& moving, const auto& mechanisms) {
          return energy_of(state, given, moving, mechanisms);
        },
        projection_options(state, given));
  };
  ContactSolution solution = project(problem);
  bool yields = false;
  if (!is_solved(state, solution) || squeezes_out(state, problem, solution, std::nullopt)) {
    if (const std::optional<ContactProblem> yielding = with_yielding_motors(problem)) {
      solution = project(*yielding);
      yields = true;
    }
  }
  limit_energy(state, problem, solution, yields);
  return solution;
}

std::vector<OuterImpulse> outer_impulses(const ContactProblem& problem,
                                         const PlanSolution& solution, const ProblemBodies& bodies,
                                         std::size_t robots, double span) {
  std::vector<OuterImpulse> outer(robots);
  for (std::size_t k = 0; k < problem.contacts.size() && robots > 0; ++k) {
    const ContactPoint& contact = problem.contacts[k];
    const std::array<const std::optional<MechanismLink>*, 2> links{
        &problem.bodies[contact.bodies[0]].link, &problem.bodies[contact.bodies[1]].link};
    const Vector3d impulse = contact.frame.transpose() * solution.velocities.impulses[k];
    const bool is_inner =
        *links[0] && *links[1] && (*links[0])->mechanism == (*links[1])->mechanism;
    if (impulse.isZero(0.0)) {
      continue;
    }
    for (const auto* link : links) {
      if (*link) {
        outer[(*link)->mechanism].touches = true;
      }
    }
    if (is_inner) {
      continue;
    }
    const auto halfway = [&](int side) {
      const std::size_t place = contact.bodies[side];
      const Vector3d mean = 0.5 * (bodies.bodies()[place].v + solution.velocities.bodies[place].v);
      return Vector3d(bodies.centre(place) + 0.5 * span * mean +
                      (side == 0 ? contact.arm_A : contact.arm_B));
    };
    const std::array<Vector3d, 2> points{halfway(0), halfway(1)};
    const auto is_free = [&](int side) {
      return problem.bodies[contact.bodies[side]].inverse_inertia.mass.any();
    };
    for (int side = 0; side < 2; ++side) {
      if (*links[side]) {
        const Vector3d point = *links[1 - side] ? Vector3d(0.5 * (points[0] + points[1]))
                                                : points[is_free(1 - side) ? 1 - side : side];
        const Vector3d on = side == 0 ? Vector3d(-impulse) : impulse;
        OuterImpulse& sum = outer[(*links[side])->mechanism];
        sum.linear += on;
        sum.angular += point.cross(on);
        sum.acts = true;
        sum.is_known = !solution.is_limited;
      }
    }
  }
  return outer;
}

}  // namespace firstcontact::detail
