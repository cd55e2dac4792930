#include <firstcontact/contact_solver/detail/active_set.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include <firstcontact/contact_solver/detail/constants.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Finds in which of eight octants a direction lies.
unsigned octant(const Vector3d& v) {
  return (v.x() > 0.0 ? 1u : 0u) | (v.y() > 0.0 ? 2u : 0u) | (v.z() > 0.0 ? 4u : 0u);
}

class ActiveSet {
 public:
  ActiveSet(const ContactProblem& problem, const ContactRows& rows)
      : problem_(problem), rows_(rows), is_chosen_(rows.contacts.size(), false) {}

  /// Adds the contacts with an impulse, if they are few; or takes all impulses away.
  void add_acting(Projection& projection) {
    std::vector<Vector3d>& impulses = projection.impulses.contacts;
    const auto count = std::ranges::count_if(
        impulses, [](const Vector3d& impulse) { return !impulse.isZero(0.0); });
    if (!are_few(static_cast<std::size_t>(count))) {
      std::ranges::fill(impulses, Vector3d::Zero());
      projection.velocities = velocities_after(rows_, projection.impulses);
    }
    for (std::size_t k = 0; k < impulses.size(); ++k) {
      if (!impulses[k].isZero(0.0)) {
        choose(k);
      }
    }
  }

  [[nodiscard]] bool are_few() const { return are_few(chosen_.size()); }

  /// Adds the contacts that close faster than `speed`: for each two bodies the fastest of each
  /// side, which is an octant of normals. Neighbours on a side have much the same normals. Returns
  /// false if no contact closes so fast.
  bool add_closing(const Eigen::VectorXd& velocities, double speed) {
    std::map<Side, std::pair<double, std::size_t>> fastest;
    for (std::size_t k = 0; k < rows_.contacts.size(); ++k) {
      const double closing = -rows_.contacts[k].excess_velocity(velocities)[0];
      if (!is_chosen_[k] && closing > speed && rows_.contacts[k].greatest() > 0.0) {
        auto& most = fastest[side_of(problem_.contacts[k])];
        most = std::max(most, {closing, k});
      }
    }
    for (const auto& [side, most] : fastest) {
      choose(most.second);
    }
    return !fastest.empty();
  }

  /// Solves the chosen contacts alone, from the projection's impulses on.
  ContactSolution solve(const ProjectionOptions& options, Projection& projection) const {
    ContactProblem part{.bodies = problem_.bodies,
                        .mechanisms = problem_.mechanisms,
                        .drives = problem_.drives,
                        .ties = problem_.ties};
    for (const std::size_t k : chosen_) {
      part.contacts.push_back(problem_.contacts[k]);
      part.contacts.back().guess =
          rows_.contacts[k].own.turn().transpose() * projection.impulses.contacts[k];
    }
    for (std::size_t k = 0; k < part.drives.size(); ++k) {
      part.drives[k].guess = projection.impulses.drives[k];
    }
    for (std::size_t k = 0; k < part.ties.size(); ++k) {
      part.ties[k].guess = projection.impulses.drives[part.drives.size() + k];
    }
    ContactSolution solution = project_on_contacts(part, options);
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      projection.impulses.contacts[chosen_[i]] =
          rows_.contacts[chosen_[i]].own.turn() * solution.impulses[i];
    }
    projection.impulses.drives = solution.drives;
    std::ranges::copy(solution.ties, std::back_inserter(projection.impulses.drives));
    projection.velocities = velocities_after(rows_, projection.impulses);
    projection.iterations += solution.iterations;
    return solution;
  }

 private:
  using Side = std::array<std::size_t, 4>;

  [[nodiscard]] bool are_few(std::size_t count) const {
    return kPartOfAll * count < is_chosen_.size();
  }

  [[nodiscard]] Side side_of(const ContactPoint& contact) const {
    const ContactBody& A = problem_.bodies[contact.bodies[0]];
    return {contact.bodies[0], contact.bodies[1],
            octant(A.link || is_movable(A) ? contact.arm_A : contact.arm_B),
            octant(contact.frame.row(0))};
  }

  void choose(std::size_t k) {
    is_chosen_[k] = true;
    chosen_.push_back(k);
  }

  const ContactProblem& problem_;
  const ContactRows& rows_;
  std::vector<bool> is_chosen_;
  std::vector<std::size_t> chosen_;
};

}  // namespace

std::optional<ProjectionSpace> project_by_active_set(const ContactProblem& problem,
                                                     const ContactRows& rows,
                                                     const ProjectionOptions& options,
                                                     Projection& projection) {
  Projection found = projection;
  ActiveSet deciding(problem, rows);
  deciding.add_acting(found);
  ProjectionSpace space = ProjectionSpace::contact;
  double left = options.tolerance;
  for (int round = 0; round < kMostRoundsOfDeciding; ++round) {
    const bool are_more = deciding.add_closing(found.velocities, left);
    if ((!are_more && round > 0) || !deciding.are_few()) {
      break;
    }
    const ContactSolution solution = deciding.solve(options, found);
    left = std::max(options.tolerance, solution.residual);
    space = solution.space;
  }
  found.residual = greatest_residual(rows, found.impulses, found.velocities);
  if (found.residual < projection.residual) {
    projection = std::move(found);
  }
  const double enough = problem.drives.empty() && problem.ties.empty() ? options.enough : 0.0;
  if (projection.residual <= std::max(options.tolerance, enough)) {
    return space;
  }
  return std::nullopt;
}

}  // namespace firstcontact::detail
