#include <algorithm>
#include <cmath>

#include <firstcontact/dynamics/detail/contact_rows.h>
#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Solves one contact with all others held. Returns how much its velocity changes [m/s].
double solve(const ContactRow& row, Vector3d& impulse, VectorXd& V) {
  if (!(row.greatest() > 0.0)) {
    return 0.0;
  }
  const Vector3d u_free = row.excess_velocity(V) - row.own.W() * impulse;
  const Vector3d solved = row.own.impulse(u_free, row.friction);
  const Vector3d change = solved - impulse;
  row.apply(change, V);
  impulse = solved;
  return change.norm() * row.greatest();
}

double solve(const DriveRow& row, double& impulse, VectorXd& V) {
  const double solved =
      std::clamp(impulse - row.excess_velocity(impulse, V) / row.own, row.least, row.greatest);
  const double change = solved - impulse;
  row.apply(change, V);
  impulse = solved;
  return std::abs(change) * row.own;
}

/// Returns the greatest change [m/s].
template <class Row, class Impulse>
double sweep(const std::vector<Row>& rows, bool backwards, std::vector<Impulse>& impulses,
             VectorXd& V) {
  const std::size_t n = rows.size();
  double change = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = backwards ? n - 1 - i : i;
    change = std::max(change, solve(rows[k], impulses[k], V));
  }
  return change;
}

}  // namespace

void project_in_contact_space(const ContactRows& rows, const ProjectionOptions& options,
                              Projection& projection) {
  auto& [V, impulses, residual, iterations] = projection;
  for (iterations = 0; iterations < options.sweeps;) {
    // There and back: a stack of n bodies would need n sweeps in one direction.
    const bool backwards = iterations % 2 == 1;
    const double change = std::max(sweep(rows.contacts, backwards, impulses.contacts, V),
                                   sweep(rows.drives, backwards, impulses.drives, V));
    ++iterations;
    if (change <= options.tolerance) {
      residual = greatest_residual(rows, impulses, V);
      if (residual <= options.tolerance) {
        return;
      }
    }
  }
  residual = greatest_residual(rows, impulses, V);
}

}  // namespace firstcontact::detail
