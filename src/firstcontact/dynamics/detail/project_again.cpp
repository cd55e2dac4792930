#include <firstcontact/dynamics/detail/project_again.h>

#include <cassert>
#include <unordered_set>

#include <firstcontact/dynamics/detail/contact_rows.h>

namespace firstcontact::detail {
namespace {

/// Gives the bodies of contacts the velocities that belong to the impulses. A contact may press
/// elsewhere than it did in the solution before.
void balance(const ContactRows& rows, const std::vector<std::size_t>& contacts,
             Projection& projection) {
  std::unordered_set<Eigen::Index> bodies;
  for (const std::size_t k : contacts) {
    for (const RowSide& side : rows.contacts[k].sides) {
      bodies.insert(side.at);
      projection.velocities.segment<6>(side.at) = rows.free_velocities.segment<6>(side.at);
    }
  }
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    for (const RowSide& side : rows.contacts[k].sides) {
      if (bodies.contains(side.at)) {
        side.apply(projection.impulses.contacts[k], projection.velocities);
      }
    }
  }
}

}  // namespace

ContactSolution project_again(const ContactProblem& problem, const std::vector<ContactBody>& before,
                              const std::vector<std::size_t>& changed,
                              const ProjectionOptions& options) {
  assert(problem.mechanisms.empty());
  const ContactRows rows(problem);
  Projection projection{.velocities = rows.free_velocities};
  for (std::size_t b = 0; b < before.size(); ++b) {
    projection.velocities.segment<6>(rows.layout.body[b]) << before[b].v, before[b].w;
  }
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    projection.impulses.contacts.emplace_back(rows.contacts[k].own.turn() *
                                              problem.contacts[k].guess);
  }
  balance(rows, changed, projection);
  project_around(rows, changed, options, projection);
  return solution_of(problem, rows, projection, ProjectionSpace::contact);
}

}  // namespace firstcontact::detail
