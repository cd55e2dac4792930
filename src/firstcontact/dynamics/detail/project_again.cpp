#include <firstcontact/dynamics/detail/project_again.h>

#include <firstcontact/dynamics/detail/contact_rows.h>

namespace firstcontact::detail {

ContactSolution project_again(const ContactProblem& problem, const std::vector<ContactBody>& before,
                              const std::vector<std::size_t>& changed,
                              const ProjectionOptions& options) {
  const ContactRows rows(problem);
  Projection projection{.velocities = rows.free_velocities};
  for (std::size_t b = 0; b < before.size(); ++b) {
    projection.velocities.segment<6>(rows.layout.body[b]) << before[b].v, before[b].w;
  }
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    projection.impulses.contacts.emplace_back(rows.contacts[k].own.turn() *
                                              problem.contacts[k].guess);
  }
  project_around(rows, changed, options, projection);
  return solution_of(problem, rows, projection, ProjectionSpace::contact);
}

}  // namespace firstcontact::detail
