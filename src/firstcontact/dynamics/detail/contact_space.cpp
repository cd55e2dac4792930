#include <algorithm>

#include <firstcontact/dynamics/detail/contact_rows.h>
#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Solves one contact with all others held. Returns how much its velocity changes [m/s].
double solve_contact(const ContactRow& row, Vector3d& impulse, std::vector<Velocity>& V) {
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

}  // namespace

void project_in_contact_space(const std::vector<ContactRow>& rows, const ProjectionOptions& options,
                              Projection& projection) {
  auto& [V, impulses, residual, iterations] = projection;
  const std::size_t n = rows.size();
  for (iterations = 0; iterations < options.sweeps;) {
    double change = 0.0;
    // There and back: a stack of n bodies would need n sweeps in one direction.
    const bool backwards = iterations % 2 == 1;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t k = backwards ? n - 1 - i : i;
      change = std::max(change, solve_contact(rows[k], impulses[k], V));
    }
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
