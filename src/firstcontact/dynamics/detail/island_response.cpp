#include <firstcontact/dynamics/detail/island_response.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Of contact problems: of what gravity adds in a step. Heaps are solved less exactly, and where
/// they slide even less.
constexpr double kTolerance = 3e-7;
constexpr double kHeapTolerance = 1e-3;
constexpr std::size_t kHeap = 300;  // Contacts.
constexpr int kHeapRounds = 2;
constexpr double kLeastTolerance = 1e-9;  // [m/s]

/// A residual of this part of what gravity adds tells that a problem has no solution, or none that
/// was found.
constexpr double kUnsolved = 1e-2;

/// [m/s]  A part of what gravity adds in a step.
double of_gravity(const IslandState& state, double part) {
  return std::max(kLeastTolerance, part * state.world.gravity.norm() * state.start.h);
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
/// its own speed twice. Of a problem without solution, as of a body that is crushed, the solver's
/// answer is anything: it is shortened to what there was before, or to what moves with the
/// script.
/// Motors add what they want, as long as there is a solution.
void limit_energy(const IslandState& state, const ContactProblem& problem,
                  ContactSolution& solution) {
  const bool is_solved = solution.residual <= of_gravity(state, kUnsolved);
  if (is_solved && state.robots.has_motors()) {
    return;
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
      is_solved ? std::sqrt(before) + 2.0 * along : std::max(std::sqrt(before), along);
  if (std::sqrt(after) <= allowed * (1.0 + 1e-9)) {
    return;
  }
  const double share = allowed / std::sqrt(after);
  for (std::size_t k = 0; k < state.size(); ++k) {
    solution.bodies[k].v *= share;
    solution.bodies[k].w *= share;
  }
  for (Eigen::VectorXd& velocities : solution.mechanisms) {
    velocities *= share;
  }
}

}  // namespace

ProjectionOptions projection_options(const IslandState& state, const ContactProblem& problem) {
  return {
      .tolerance = of_gravity(state, problem.contacts.size() < kHeap ? kTolerance : kHeapTolerance),
      .rounds = kHeapRounds};
}

ContactSolution project_plan(const IslandState& state, const ContactProblem& problem) {
  if (problem.contacts.empty() && problem.drives.empty()) {
    return unchanged(problem);
  }
  ContactSolution solution = project_on_contacts(problem, projection_options(state, problem));
  limit_energy(state, problem, solution);
  return solution;
}

ContactSolution project_impact_of(const IslandState& state, const ContactProblem& problem,
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
