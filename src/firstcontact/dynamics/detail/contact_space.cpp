#include <algorithm>
#include <cmath>
#include <deque>
#include <unordered_map>
#include <utility>

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
  const Vector3d u = row.excess_velocity(V);
  if (u[0] >= 0.0 && impulse.isZero(0.0)) {
    return 0.0;
  }
  const Vector3d u_free = u - row.own.W() * impulse;
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

/// Contacts that wait to be solved, first come, first served.
class Neighbourhood {
 public:
  Neighbourhood(const ContactRows& rows, const ProjectionOptions& options, Projection& projection)
      : rows_(rows),
        tolerance_(options.tolerance),
        most_(static_cast<std::size_t>(options.sweeps) * rows.contacts.size()),
        projection_(projection),
        waits_(rows.contacts.size(), false) {
    for (std::size_t k = 0; k < rows.contacts.size(); ++k) {
      for (const RowSide& side : rows.contacts[k].sides) {
        contacts_of_[side.at].push_back(k);
      }
    }
  }

  void project(const std::vector<std::size_t>& changed) {
    for (const std::size_t k : changed) {
      wait(k);
    }
    for (std::size_t solved = 0; !queue_.empty() && solved < most_; ++solved) {
      const std::size_t k = queue_.front();
      queue_.pop_front();
      waits_[k] = false;
      const double change =
          solve(rows_.contacts[k], projection_.impulses.contacts[k], projection_.velocities);
      if (change > tolerance_) {
        for (const RowSide& side : rows_.contacts[k].sides) {
          if (!side.response.isZero(0.0)) {
            for (const std::size_t other : contacts_of_.at(side.at)) {
              if (other != k) {
                wait(other);
              }
            }
          }
        }
      }
    }
  }

 private:
  void wait(std::size_t k) {
    if (!waits_[k]) {
      waits_[k] = true;
      queue_.push_back(k);
    }
  }

  const ContactRows& rows_;
  double tolerance_;
  std::size_t most_;
  Projection& projection_;
  std::vector<bool> waits_;
  std::deque<std::size_t> queue_;
  std::unordered_map<Eigen::Index, std::vector<std::size_t>> contacts_of_;
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

void project_around(const ContactRows& rows, const std::vector<std::size_t>& changed,
                    const ProjectionOptions& options, Projection& projection) {
  Neighbourhood(rows, options, projection).project(changed);
  projection.residual = greatest_residual(rows, projection.impulses, projection.velocities);
}

}  // namespace firstcontact::detail
