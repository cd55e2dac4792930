#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/contact_solver/detail/active_set.h>
#include <firstcontact/contact_solver/detail/augmented_lagrangian.h>
#include <firstcontact/contact_solver/detail/constants.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>
#include <firstcontact/contact_solver/detail/coulomb_cone.h>
#include <firstcontact/contact_solver/detail/decoupled_ties.h>
#include <firstcontact/contact_solver/detail/interior_point.h>
#include <firstcontact/contact_solver/detail/least_norm.h>
#include <firstcontact/contact_solver/detail/projected_gauss_seidel.h>
#include <firstcontact/math/number_text.h>

namespace firstcontact {
namespace {

using detail::ContactRow;
using detail::ContactRows;
using detail::Impulses;
using detail::Projection;

/// Counts the velocities that impulses change.
std::size_t moving_velocities(const ContactProblem& problem) {
  std::size_t count = 0;
  for (const ContactBody& body : problem.bodies) {
    count += detail::is_movable(body) ? 6 : 0;
  }
  for (const ContactMechanism& mechanism : problem.mechanisms) {
    count += static_cast<std::size_t>(mechanism.velocity.size());
  }
  return count;
}

/// The problem's guesses, as far as the laws permit them.
Impulses guesses(const ContactProblem& problem, const ContactRows& rows) {
  Impulses impulses;
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    const ContactRow& row = rows.contacts[k];
    impulses.contacts.push_back(
        row.greatest() > 0.0
            ? detail::project_on_cone(row.own.turn() * problem.contacts[k].guess, row.friction)
            : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }
  for (const JointDrive& drive : problem.drives) {
    impulses.drives.push_back(std::clamp(drive.guess, drive.least, drive.greatest));
  }
  for (const TieRow& tie : problem.ties) {
    impulses.drives.push_back(std::clamp(tie.guess, tie.least, tie.greatest));
  }
  return impulses;
}

/// [J]  Computes r^T J M^-1 J^T r / 2 + r^T u_free. The impulses without friction are its least
/// point; 0 without impulses.
double dual_objective(const ContactRows& rows, const Projection& projection) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    const ContactRow& row = rows.contacts[k];
    const Eigen::Vector3d& impulse = projection.impulses.contacts[k];
    if (!impulse.isZero(0.0)) {
      sum += 0.5 * impulse.dot(row.excess_velocity(rows.free_velocities) +
                               row.excess_velocity(projection.velocities));
    }
  }
  for (std::size_t k = 0; k < rows.drives.size(); ++k) {
    const detail::DriveRow& row = rows.drives[k];
    const double impulse = projection.impulses.drives[k];
    sum += 0.5 * impulse *
           (row.excess_velocity(0.0, rows.free_velocities) +
            row.excess_velocity(impulse, projection.velocities));
  }
  return sum;
}

/// Starts from the guesses where they seem better than no impulse at all, and no impulse is no
/// solution.
///
/// The guesses are judged as a whole, as a single one may be far off where a body came to lie on
/// another feature. With friction the objective is only an indication.
Projection start(const ContactProblem& problem, const ContactRows& rows, double tolerance) {
  Projection none{.velocities = rows.free_velocities};
  none.impulses.contacts.assign(rows.contacts.size(), Eigen::Vector3d::Zero());
  for (const detail::DriveRow& row : rows.drives) {  // 0 may be outside the bounds of a tie.
    none.impulses.drives.push_back(row.tie.empty() ? 0.0
                                                   : std::clamp(0.0, row.least, row.greatest));
  }
  if (!problem.ties.empty()) {
    none.velocities = detail::velocities_after(rows, none.impulses);
  }
  none.residual = detail::greatest_residual(rows, none.impulses, none.velocities);
  Projection guessed{.impulses = guesses(problem, rows)};
  guessed.velocities = detail::velocities_after(rows, guessed.impulses);
  if (none.residual <= tolerance || !(dual_objective(rows, guessed) < 0.0)) {
    return none;
  }
  guessed.residual = detail::greatest_residual(rows, guessed.impulses, guessed.velocities);
  return guessed;
}

/// Whether masses differ so much that multipliers stop short of an answer.
bool are_unequal(const ContactProblem& problem) {
  double lightest = std::numeric_limits<double>::infinity();
  double heaviest = 0.0;
  for (const ContactBody& body : problem.bodies) {
    const double inverse = body.inverse_inertia.mass.maxCoeff();
    if (!body.link && inverse > 0.0) {
      lightest = std::min(lightest, 1.0 / inverse);
      heaviest = std::max(heaviest, 1.0 / inverse);
    }
  }
  return heaviest >= detail::kUnequalMasses * lightest;
}

template <class Number>
void require_positive(Number value, const std::string& option) {
  if (!(value > Number())) {
    throw std::invalid_argument("ProjectionOptions::" + option + " must be > 0, got " +
                                std::to_string(value));
  }
}

void require_not_negative(double value, const std::string& option) {
  if (!(value >= 0.0)) {
    throw std::invalid_argument("ProjectionOptions::" + option + " must be >= 0, got " +
                                detail::shortest(value));
  }
}

/// Tries cheap methods before expensive ones.
class Solver {
 public:
  Solver(const ContactProblem& problem, const ProjectionOptions& options)
      : problem_(problem),
        options_(options),
        rows_(problem),
        is_automatic_(options.space == ProjectionSpace::automatic),
        projection_(start(problem, rows_, options.tolerance)) {
    if (projection_.residual > options.hit) {
      options_.tolerance = std::max(options.tolerance, options.of_hits * projection_.residual);
    }
    const std::size_t moving = moving_velocities(problem);
    const std::size_t contacts = rows_.contacts.size();
    is_small_ = moving <= detail::kMostForAugmentedLagrangian;
    are_redundant_ = 6 * contacts >= detail::kManyContactsOfBody * moving;
    are_many_redundant_ = is_automatic_ && are_redundant_ && contacts >= detail::kManyRedundant;
    has_interior_ =
        is_small_ && !has_drives() &&
        contacts >= (are_redundant_ ? detail::kManyRedundant : detail::kManyForInteriorPoint);
    // Along a chain of links or ties impulses would have to travel from joint to joint.
    has_many_ =
        !problem.mechanisms.empty() || !problem.ties.empty() || has_interior_ || are_redundant_;
  }

  ContactSolution solve() {
    if (is_solved(projection_)) {
      return solution(projection_, ProjectionSpace::contact);
    }
    if (sweep_first()) {
      share_evenly();
      return solution(projection_, ProjectionSpace::contact);
    }
    if (are_many_redundant_) {
      if (const std::optional<ProjectionSpace> space =
              detail::project_by_active_set(problem_, rows_, options_, projection_)) {
        return solution(projection_, *space);
      }
    }
    if (has_interior_) {
      if (std::optional<ContactSolution> found = from_inside()) {
        return std::move(*found);
      }
    }
    return by_multipliers();
  }

 private:
  [[nodiscard]] bool has_drives() const {
    return !problem_.drives.empty() || !problem_.ties.empty();
  }

  [[nodiscard]] bool is_solved(const Projection& projection) const {
    return projection.residual <= options_.tolerance;
  }

  [[nodiscard]] ContactSolution solution(const Projection& projection,
                                         ProjectionSpace space) const {
    ContactSolution found = detail::solution_of(problem_, rows_, projection, space);
    found.allowed = std::max(options_.tolerance, options_.enough);
    return found;
  }

  /// Sweeps over the contacts, where that may solve the problem. Returns whether it ends there.
  bool sweep_first() {
    const bool is_worthwhile = is_automatic_ && !(is_small_ && has_many_);
    if (options_.space != ProjectionSpace::contact && !is_worthwhile) {
      return false;
    }
    ProjectionOptions sweeping = options_;
    if (is_automatic_ && is_small_) {
      sweeping.sweeps = std::min(options_.sweeps, detail::kSweepsBeforeAugmentedLagrangian);
    }
    detail::project_by_gauss_seidel(problem_, rows_, sweeping, projection_);
    return !is_automatic_ || is_solved(projection_) || !is_small_;
  }

  /// Solves by an interior point. Returns nothing where multipliers are to go on.
  std::optional<ContactSolution> from_inside() {
    Projection inner = projection_;
    if (is_automatic_) {  // Sweeps alone may solve it.
      ProjectionOptions sweeping = options_;
      if (are_redundant_) {
        sweeping.sweeps = std::min(options_.sweeps, detail::kSweepsOfRedundant);
      } else if (!(options_.enough > 0.0)) {
        sweeping.sweeps = std::min(options_.sweeps, detail::kSweepsBeforeAugmentedLagrangian);
      }
      detail::project_by_gauss_seidel(problem_, rows_, sweeping, inner);
      if (is_solved(inner) && !are_redundant_) {
        sweeping.sweeps = detail::kExtraSweeps;
        sweeping.tolerance = detail::kExtraTolerance * options_.tolerance;
        Projection more = inner;
        detail::project_by_gauss_seidel(problem_, rows_, sweeping, more);
        more.iterations += inner.iterations;
        if (more.residual < inner.residual) {
          inner = std::move(more);
        }
      }
      if (inner.residual <= std::max(options_.tolerance, options_.enough)) {
        return solution(inner, ProjectionSpace::contact);
      }
    }
    detail::project_by_interior_point(problem_, rows_, options_, inner);
    if (inner.residual < projection_.residual) {
      projection_ = std::move(inner);
    }
    const bool may_leave_something = is_automatic_ && options_.enough > 0.0;
    if (may_leave_something || is_solved(projection_)) {
      return solution(projection_, ProjectionSpace::motion);
    }
    return std::nullopt;
  }

  void share_evenly() {
    if (is_automatic_ && is_solved(projection_)) {
      detail::share_evenly(rows_, options_.tolerance, projection_);
    }
  }

  ContactSolution by_multipliers() {
    const Projection before = projection_;
    if (can_decouple() && detail::least_left_of_ties(rows_) < detail::kNearlyImplied) {
      by_decoupled_ties();
      if (is_solved(projection_)) {
        return solution(projection_, ProjectionSpace::motion);
      }
    }
    detail::project_by_augmented_lagrangian(problem_, rows_, options_, projection_);
    share_evenly();
    if (!is_solved(projection_) && is_automatic_ && !has_interior_ && !has_drives() &&
        are_unequal(problem_)) {
      by_interior_point_after_all();
    }
    if (!is_solved(projection_) && can_decouple()) {
      by_decoupled_ties();
    }
    return before.residual < projection_.residual ? solution(before, ProjectionSpace::contact)
                                                  : solution(projection_, ProjectionSpace::motion);
  }

  /// Tries an interior point after multipliers: at great ratios of masses these stop short of few
  /// contacts, too.
  void by_interior_point_after_all() {
    Projection inner = projection_;
    detail::project_by_interior_point(problem_, rows_, options_, inner);
    if (inner.residual < projection_.residual) {
      projection_ = std::move(inner);
    }
  }

  /// Whether there may be rigid ties to decouple, and not too many.
  [[nodiscard]] bool can_decouple() const {
    return problem_.ties.size() >= 2 && moving_velocities(problem_) <= detail::kMostForDecoupling;
  }

  /// Tries multipliers for combinations of rigid ties. Without other rows there is nothing left for
  /// them to do.
  void by_decoupled_ties() {
    const detail::DecoupledTies ties(problem_, rows_);
    if (ties.empty()) {
      return;
    }
    ProjectionOptions options = options_;
    options.tolerance /= static_cast<double>(problem_.ties.size());
    Projection found = projection_;
    found.impulses = ties.combined(std::move(found.impulses));
    ties.meet(found);
    if (!(found.residual <= options.tolerance)) {
      detail::project_by_augmented_lagrangian(problem_, ties.rows(), options, found);
      ties.meet(found);
    }
    found.impulses = ties.separate(std::move(found.impulses));
    found.residual = detail::greatest_residual(rows_, found.impulses, found.velocities);
    if (found.residual < projection_.residual) {
      projection_ = std::move(found);
    }
  }

  const ContactProblem& problem_;
  ProjectionOptions options_;
  ContactRows rows_;
  bool is_automatic_;
  bool are_redundant_ = false;
  bool are_many_redundant_ = false;
  bool is_small_ = false;
  bool has_interior_ = false;
  bool has_many_ = false;
  Projection projection_;
};

}  // namespace

ContactSolution project_on_contacts(const ContactProblem& problem,
                                    const ProjectionOptions& options) {
  require_positive(options.tolerance, "tolerance");
  require_positive(options.sweeps, "sweeps");
  require_positive(options.rounds, "rounds");
  require_not_negative(options.of_hits, "of_hits");
  require_not_negative(options.hit, "hit");
  require_not_negative(options.enough, "enough");
  return Solver(problem, options).solve();
}

double contact_residual(const ContactProblem& problem, const ContactSolution& solution) {
  const ContactRows rows(problem);
  Impulses impulses{.contacts = {}, .drives = solution.drives};
  std::ranges::copy(solution.ties, std::back_inserter(impulses.drives));
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    impulses.contacts.emplace_back(rows.contacts[k].own.turn() * solution.impulses[k]);
  }
  ContactProblem moving = problem;
  moving.bodies = solution.bodies;
  for (std::size_t m = 0; m < moving.mechanisms.size(); ++m) {
    moving.mechanisms[m].velocity = solution.mechanisms[m];
  }
  return detail::greatest_residual(rows, impulses, ContactRows(moving).free_velocities);
}

}  // namespace firstcontact
