#include <algorithm>
#include <cmath>
#include <utility>

#include <firstcontact/dynamics/detail/contact_rows.h>
#include <firstcontact/dynamics/detail/coulomb_cone.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

double solve_alone(const DriveRow& row, double& impulse, VectorXd& V) {
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
    change = std::max(change, solve_alone(rows[k], impulses[k], V));
  }
  return change;
}

/// What all contacts and drives change in a pair of sweeps, for directions of conjugate gradients.
struct Changes {
  Impulses impulses;
  VectorXd V;
};

double squared_length(const ContactRows& rows, const Impulses& r) {
  double sum = 0.0;
  for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
    sum += rows.contacts[k].greatest() * r.contacts[k].squaredNorm();
  }
  for (std::size_t k = 0; k < rows.drives.size(); ++k) {
    sum += rows.drives[k].own * r.drives[k] * r.drives[k];
  }
  return sum;
}

template <class Value>
void subtract(const std::vector<Value>& values, std::vector<Value>& from) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    from[k] = values[k] - from[k];
  }
}

template <class Value>
void add(double share, const std::vector<Value>& values, std::vector<Value>& to) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    to[k] += share * values[k];
  }
}

/// Goes on in the direction of the pairs of sweeps before.
class Extrapolation {
 public:
  explicit Extrapolation(const ContactRows& rows) : rows_(rows) {}

  /// Before a pair of sweeps.
  void begin(const Projection& projection) {
    step_.impulses = projection.impulses;
    step_.V = projection.velocities;
  }

  /// After it.
  void end(Projection& projection) {
    subtract(projection.impulses.contacts, step_.impulses.contacts);
    subtract(projection.impulses.drives, step_.impulses.drives);
    step_.V = projection.velocities - step_.V;
    const double squared = squared_length(rows_, step_.impulses);
    const double share = squared / last_;
    last_ = squared;
    if (!(share <= 1.0) || direction_.V.size() == 0) {
      direction_ = step_;
      return;
    }
    add(share, direction_.impulses.contacts, projection.impulses.contacts);
    add(share, direction_.impulses.drives, projection.impulses.drives);
    projection.velocities += share * direction_.V;
    add(share, direction_.impulses.contacts, step_.impulses.contacts);
    add(share, direction_.impulses.drives, step_.impulses.drives);
    step_.V += share * direction_.V;
    std::swap(step_, direction_);
  }

 private:
  const ContactRows& rows_;
  Changes step_;
  Changes direction_;
  double last_ = 0.0;
};

}  // namespace

void project_in_contact_space(const ContactRows& rows, const ProjectionOptions& options,
                              Projection& projection) {
  auto& [V, impulses, residual, iterations] = projection;
  Extrapolation extrapolation(rows);
  for (iterations = 0; iterations < options.sweeps;) {
    // There and back: a stack of n bodies would need n sweeps in one direction.
    const bool backwards = iterations % 2 == 1;
    if (!backwards) {
      extrapolation.begin(projection);
    }
    const double change = std::max(sweep(rows.contacts, backwards, impulses.contacts, V),
                                   sweep(rows.drives, backwards, impulses.drives, V));
    ++iterations;
    if (change <= options.tolerance) {
      residual = greatest_residual(rows, impulses, V);
      if (residual <= options.tolerance) {
        return;
      }
    }
    if (backwards && iterations < options.sweeps) {
      extrapolation.end(projection);
    }
  }
  residual = greatest_residual(rows, impulses, V);
}

}  // namespace firstcontact::detail
