#include <firstcontact/contact_solver/detail/projected_gauss_seidel.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <firstcontact/contact_solver/detail/conjugate_direction.h>
#include <firstcontact/contact_solver/detail/contact_batches.h>
#include <firstcontact/contact_solver/detail/contact_rows.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

double solve_alone(const DriveRow& row, double& impulse, VectorXd& V) {
  if (!(row.own > 0.0)) {
    return 0.0;
  }
  const double solved =
      std::clamp(impulse - row.excess_velocity(impulse, V) / row.own, row.least, row.greatest);
  const double change = solved - impulse;
  row.apply(change, V);
  impulse = solved;
  return std::abs(change) * row.own;
}

/// Sweeps over contacts and drives one by one. The state: all impulses, then the velocities.
class RowSweeps {
 public:
  explicit RowSweeps(const ContactRows& rows)
      : rows_(rows),
        drives_at_(static_cast<Index>(3 * rows.contacts.size())),
        V_at_(drives_at_ + static_cast<Index>(rows.drives.size())) {}

  /// The weights of squared lengths: impulses count by their changes of velocity.
  [[nodiscard]] VectorXd weights() const {
    VectorXd weights = VectorXd::Zero(V_at_ + rows_.layout.size);
    Index at = 0;
    for (const ContactRow& row : rows_.contacts) {
      weights.segment<3>(at).setConstant(row.greatest());
      at += 3;
    }
    for (const DriveRow& row : rows_.drives) {
      weights[at++] = row.own;
    }
    return weights;
  }

  [[nodiscard]] VectorXd state_of(const Projection& projection) const {
    VectorXd state(V_at_ + rows_.layout.size);
    Index at = 0;
    for (const Vector3d& impulse : projection.impulses.contacts) {
      state.segment<3>(at) = impulse;
      at += 3;
    }
    std::ranges::copy(projection.impulses.drives, state.data() + drives_at_);
    state.tail(rows_.layout.size) = projection.velocities;
    return state;
  }

  /// Runs a sweep.
  ///
  /// @returns [m/s]  the greatest change of a velocity
  double sweep(bool backwards, VectorXd& state) const {
    VectorXd V = state.tail(rows_.layout.size);
    double change = 0.0;
    in_order(rows_.contacts.size(), backwards, [&](Index k) {
      Vector3d impulse = state.segment<3>(3 * k);
      const ContactRow& row = rows_.contacts[static_cast<std::size_t>(k)];
      change = std::max(change, solve_alone(row, impulse, V));
      state.segment<3>(3 * k) = impulse;
    });
    in_order(rows_.drives.size(), backwards, [&](Index k) {
      const DriveRow& row = rows_.drives[static_cast<std::size_t>(k)];
      change = std::max(change, solve_alone(row, state[drives_at_ + k], V));
    });
    state.tail(rows_.layout.size) = V;
    return change;
  }

  void take(const VectorXd& state, Projection& projection) const {
    Index at = 0;
    for (Vector3d& impulse : projection.impulses.contacts) {
      impulse = state.segment<3>(at);
      at += 3;
    }
    for (double& impulse : projection.impulses.drives) {
      impulse = state[at++];
    }
    projection.velocities = state.tail(rows_.layout.size);
    projection.residual = greatest_residual(rows_, projection.impulses, projection.velocities);
  }

 private:
  template <class Use>
  static void in_order(std::size_t size, bool backwards, const Use& use) {
    const auto count = static_cast<Index>(size);
    for (Index i = 0; i < count; ++i) {
      use(backwards ? count - 1 - i : i);
    }
  }

  const ContactRows& rows_;
  Index drives_at_;
  Index V_at_;
};

/// Every kLook sweeps the changes are compared. Where they fell by less than kFall, more sweeps
/// gain little: then a residual of kPartOfEnough of `enough` ends them. Near the tolerance it does
/// not, as bodies come to rest there. After a hit it always does: the first residual is above kHit
/// of `enough`.
constexpr int kLook = 10;
constexpr double kFall = 0.5;
constexpr double kPartOfEnough = 0.5;
constexpr double kNearTolerance = 10.0;
constexpr double kHit = 10.0;

/// [sweeps]  Least distance of two renewals: where changes are small and the residual is not,
/// velocities are computed anew from the impulses. A renewal costs as much as a sweep.
constexpr int kRenewal = 10;

/// Sweeps there and back: a stack of n bodies would need n sweeps in one direction.
template <class Sweeps>
void project_by(Sweeps sweeps, const ProjectionOptions& options, Projection& projection) {
  auto state = sweeps.state_of(projection);
  ConjugateDirection direction(sweeps.weights());
  double before = std::numeric_limits<double>::infinity();  // Changes at the last comparison.
  const bool is_hit = projection.residual > kHit * options.enough;
  int renewed = -kRenewal;
  int& count = projection.iterations;
  for (count = 0; count < options.sweeps;) {
    const bool backwards = count % 2 == 1;
    if (!backwards) {
      direction.begin(state);
    }
    const double change = sweeps.sweep(backwards, state);
    ++count;
    double wanted = options.tolerance;
    if (count % kLook == 0) {
      if (is_hit || (change > kFall * before && change > kNearTolerance * options.tolerance)) {
        wanted = std::max(wanted, kPartOfEnough * options.enough);
      }
      before = change;
    }
    if (change <= wanted && count - renewed >= kRenewal) {
      sweeps.take(state, projection);
      if (projection.residual <= wanted) {
        return;
      }
      state = sweeps.state_of(projection);  // Without the roundings that added up.
      renewed = count;
    }
    if (backwards && count < options.sweeps) {
      direction.end(state);
    }
  }
  sweeps.take(state, projection);
}

/// Whether responses and friction are of like size everywhere: then products of all numbers of a
/// contact are far from the limits of single precision. It is false where axes are locked.
bool are_alike(const ContactRows& rows, const BatchUnits& units) {
  constexpr double kRange = 1e4;
  return std::ranges::all_of(rows.contacts, [&](const ContactRow& row) {
    const double least = std::min(row.own.W()(0, 0), row.own.tangential().minCoeff());
    return !(row.greatest() > 0.0) ||
           (row.greatest() <= kRange * units.response && least >= units.response / kRange &&
            (row.friction == 0.0 || (row.friction >= 1.0 / kRange && row.friction <= kRange)));
  });
}

/// [m/s]  The resolution of sweeps in single precision: a few 2^-24 of the changes of velocity of
/// bodies and at contacts.
double told_by_single_precision(const ContactRows& rows, const BatchUnits& units,
                                const Projection& projection) {
  double greatest = units.velocity;
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    greatest =
        std::max(greatest, rows.contacts[k].greatest() * projection.impulses.contacts[k].norm());
  }
  constexpr double kTold = 5e-6;
  return kTold * greatest;
}

}  // namespace

void project_by_gauss_seidel(const ContactProblem& problem, const ContactRows& rows,
                             const ProjectionOptions& options, Projection& projection) {
  const BatchUnits units = units_of(rows);
  if (are_alike(rows, units) &&
      told_by_single_precision(rows, units, projection) <= options.tolerance) {
    if (auto batches = ContactBatches<float>::of(problem, rows, units)) {
      Projection swept = projection;
      project_by(*std::move(batches), options, swept);
      const bool is_told = told_by_single_precision(rows, units, swept) <= options.tolerance;
      if (swept.residual < projection.residual) {
        projection = std::move(swept);
      }
      if (is_told || projection.residual <= std::max(options.tolerance, options.enough)) {
        return;
      }
    }
  }
  if (auto batches = ContactBatches<double>::of(problem, rows)) {
    return project_by(*std::move(batches), options, projection);
  }
  project_by(RowSweeps(rows), options, projection);
}

}  // namespace firstcontact::detail
