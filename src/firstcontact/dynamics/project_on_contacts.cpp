#include <algorithm>
#include <stdexcept>
#include <string>

#include <firstcontact/dynamics/contact_problem.h>
#include <firstcontact/dynamics/detail/contact_rows.h>
#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact {
namespace {

using detail::ContactRow;
using detail::Projection;

/// Dense factorisations grow with the cube of the bodies.
constexpr std::size_t kMostBodiesInMotionSpace = 24;

/// Contacts for each body from where on motion space is cheaper (a sweep costs as many contacts as
/// an assembly, of which far fewer are needed).
constexpr std::size_t kManyContacts = 12;

std::size_t moving_bodies(const ContactProblem& problem) {
  return static_cast<std::size_t>(std::ranges::count_if(problem.bodies, [](const ContactBody& b) {
    return b.inverse_inertia.mass.any() || b.inverse_inertia.rotation.any();
  }));
}

/// Starts from the guesses where they are nearer to the laws than no impulse at all.
Projection start(const ContactProblem& problem, const std::vector<ContactRow>& rows) {
  Projection guessed;
  Projection none;
  none.impulses.assign(rows.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    guessed.impulses.push_back(
        rows[k].greatest() > 0.0
            ? detail::project_on_cone(rows[k].own.turn() * problem.contacts[k].guess,
                                      rows[k].friction)
            : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }
  for (Projection* projection : {&guessed, &none}) {
    projection->velocities = detail::velocities_after(problem, rows, projection->impulses);
    projection->residual =
        detail::greatest_residual(rows, projection->impulses, projection->velocities);
  }
  return guessed.residual < none.residual ? guessed : none;
}

ContactSolution solution_of(const ContactProblem& problem, const std::vector<ContactRow>& rows,
                            const Projection& projection, ProjectionSpace space) {
  ContactSolution solution;
  solution.bodies = problem.bodies;
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    solution.bodies[b].v = projection.velocities[b].head<3>();
    solution.bodies[b].w = projection.velocities[b].tail<3>();
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    solution.impulses.push_back(rows[k].own.turn().transpose() * projection.impulses[k]);
  }
  solution.residual = projection.residual;
  solution.space = space;
  solution.iterations = projection.iterations;
  return solution;
}

}  // namespace

ContactSolution project_on_contacts(const ContactProblem& problem,
                                    const ProjectionOptions& options) {
  if (!(options.tolerance > 0.0)) {
    throw std::invalid_argument("ProjectionOptions::tolerance must be > 0, got " +
                                std::to_string(options.tolerance));
  }
  if (options.sweeps <= 0) {
    throw std::invalid_argument("ProjectionOptions::sweeps must be > 0, got " +
                                std::to_string(options.sweeps));
  }
  const std::vector<ContactRow> rows = detail::contact_rows(problem);
  Projection projection = start(problem, rows);
  if (projection.residual <= options.tolerance) {
    return solution_of(problem, rows, projection, ProjectionSpace::contact);
  }
  const std::size_t moving = moving_bodies(problem);
  const bool automatic = options.space == ProjectionSpace::automatic;
  const bool is_small = moving <= kMostBodiesInMotionSpace;
  const bool has_many = rows.size() >= kManyContacts * moving;
  if (options.space == ProjectionSpace::contact || (automatic && !(is_small && has_many))) {
    detail::project_in_contact_space(rows, options, projection);
    if (!automatic || projection.residual <= options.tolerance || !is_small) {
      return solution_of(problem, rows, projection, ProjectionSpace::contact);
    }
  }
  const Projection before = projection;
  detail::project_in_motion_space(problem, rows, options, projection);
  return before.residual < projection.residual
             ? solution_of(problem, rows, before, ProjectionSpace::contact)
             : solution_of(problem, rows, projection, ProjectionSpace::motion);
}

double contact_residual(const ContactProblem& problem, const ContactSolution& solution) {
  const std::vector<ContactRow> rows = detail::contact_rows(problem);
  std::vector<Eigen::Vector3d> impulses;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    impulses.emplace_back(rows[k].own.turn() * solution.impulses[k]);
  }
  return detail::greatest_residual(rows, impulses, detail::velocities(solution.bodies));
}

}  // namespace firstcontact
