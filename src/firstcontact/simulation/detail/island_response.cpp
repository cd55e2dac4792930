#include <firstcontact/simulation/detail/island_response.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <firstcontact/contact_solver/detail/re_solve.h>
#include <firstcontact/simulation/detail/constants.h>
#include <firstcontact/simulation/detail/island_state.h>
#include <firstcontact/simulation/detail/response.h>

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

/// Whether a problem has a solution that was found.
bool is_solved(const IslandState& state, const ContactSolution& solution) {
  const double left = state.robots.empty() ? solution.allowed : 0.0;
  return solution.residual <=
         std::max({left, of_gravity(state, kUnsolved), kUnsolvedOfSpeed * fastest(solution)});
}

/// The problem with motors that yield a little to what is stronger than anything: to contacts and
/// limits that leave no room for the velocities that they want. Nothing where none is so strong.
std::optional<ContactProblem> with_yielding_motors(const ContactProblem& problem) {
  std::optional<ContactProblem> yielding;
  for (std::size_t k = 0; k < problem.drives.size(); ++k) {
    const JointDrive& drive = problem.drives[k];
    if (drive.compliance == 0.0 && std::isinf(drive.least) && std::isinf(drive.greatest)) {
      yielding = yielding ? std::move(yielding) : std::optional(problem);
      const auto c = static_cast<Eigen::Index>(drive.coordinate);
      yielding->drives[k].compliance =
          kYield * problem.mechanisms[drive.mechanism].inverse_mass(c, c);
    }
  }
  return yielding;
}

/// Contacts add no energy: without moving bodies around, what they allow contains rest, and the
/// projection on it makes no velocity longer in the kinetic metric. A scripted body adds at most
/// its own speed twice. Of a problem without solution, as of a body that is crushed, the solver's
/// answer is anything: it is shortened to what there was before, or to what moves with the
/// script.
/// Motors add what they want, as long as there is a solution.
///
/// @returns whether it was shortened
bool limit_energy(const IslandState& state, const ContactProblem& problem,
                  ContactSolution& solution) {
  const bool has_solution = is_solved(state, solution);
  if (has_solution && state.robots.has_motors()) {
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
      has_solution ? std::sqrt(before) + 2.0 * along : std::max(std::sqrt(before), along);
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

}  // namespace

double exact_tolerance(const IslandState& state) { return of_gravity(state, kExactTolerance); }

bool is_heap(const IslandState& state, const ContactProblem& problem) {
  return problem.contacts.size() >= kHeapContacts && state.size() >= kHeapBodies;
}

ProjectionOptions projection_options(const IslandState& state, const ContactProblem& problem) {
  if (is_heap(state, problem)) {
    return {.tolerance = of_gravity(state, kHeapTolerance),
            .enough = of_gravity(state, kHeapEnough),
            .sweeps = kHeapSweeps,
            .rounds = kRoundsOfMany};
  }
  if (problem.contacts.size() >= kManyContactsOfIsland) {
    return {.tolerance = of_gravity(state, kHeapTolerance), .rounds = kRoundsOfMany};
  }
  return {.tolerance = exact_tolerance(state), .rounds = kRoundsOfMany};
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
  if (problem.contacts.empty() && problem.drives.empty()) {
    return {unchanged(problem)};
  }
  PlanSolution plan{project_on_contacts(problem, plan_options(state, problem))};
  if (!is_solved(state, plan.velocities)) {
    if (const std::optional<ContactProblem> yielding = with_yielding_motors(problem)) {
      plan.velocities = project_on_contacts(*yielding, plan_options(state, problem));
    }
  }
  plan.is_limited = limit_energy(state, problem, plan.velocities);
  return plan;
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

PlanSolution project_impact_of(const IslandState& state, const ContactProblem& problem,
                               const std::vector<double>& restitution) {
  const auto project = [&](const ContactProblem& given) {
    return project_impact(
        given, restitution, state.size(),
        [&](const auto& moving, const auto& mechanisms) {
          return energy_of(state, given, moving, mechanisms);
        },
        projection_options(state, given));
  };
  PlanSolution impact{project(problem)};
  if (!is_solved(state, impact.velocities)) {
    if (const std::optional<ContactProblem> yielding = with_yielding_motors(problem)) {
      impact.velocities = project(*yielding);
    }
  }
  impact.is_limited = limit_energy(state, problem, impact.velocities);
  return impact;
}

std::vector<OuterImpulse> outer_impulses(const ContactProblem& problem,
                                         const PlanSolution& solution, const ProblemBodies& bodies,
                                         std::size_t robots) {
  std::vector<OuterImpulse> outer(robots);
  for (std::size_t k = 0; k < problem.contacts.size() && robots > 0; ++k) {
    const ContactPoint& contact = problem.contacts[k];
    const std::array<const std::optional<MechanismLink>*, 2> links{
        &problem.bodies[contact.bodies[0]].link, &problem.bodies[contact.bodies[1]].link};
    const Vector3d impulse = contact.frame.transpose() * solution.velocities.impulses[k];
    const bool is_inner =
        *links[0] && *links[1] && (*links[0])->mechanism == (*links[1])->mechanism;
    if (is_inner || impulse.isZero(0.0)) {
      continue;
    }
    const std::array<Vector3d, 2> points{bodies.centre(contact.bodies[0]) + contact.arm_A,
                                         bodies.centre(contact.bodies[1]) + contact.arm_B};
    for (int side = 0; side < 2; ++side) {
      if (*links[side]) {
        const Vector3d point =
            *links[1 - side] ? Vector3d(0.5 * (points[0] + points[1])) : points[1 - side];
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
