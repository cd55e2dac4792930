#include <firstcontact/contact_solver/detail/decoupled_ties.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// [-]  The least part of a tie's response across other ties, as a fraction of its own. With less
/// it follows from them, up to rounding.
constexpr double kImplied = 1e-24;

/// The velocities of a part that moves by itself, in the vector of all.
struct Part {
  Index at;
  Index size;
};

std::vector<Part> parts_of(const ContactProblem& problem, const VelocityLayout& layout) {
  std::vector<Part> parts;
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    if (!problem.bodies[b].link) {
      parts.push_back({layout.body[b], 6});
    }
  }
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    parts.push_back({layout.mechanism[m], problem.mechanisms[m].velocity.size()});
  }
  return parts;
}

/// A combination of ties over all velocities.
struct Combination {
  VectorXd J;
  VectorXd response;
  double target = 0.0;
  double own = 0.0;  // Response to its own impulse.

  Combination(const DriveRow& row, Index size)
      : J(VectorXd::Zero(size)), response(VectorXd::Zero(size)), target(row.target) {
    for (const TieRowSide& side : row.tie) {
      J.segment(side.at, side.J.size()) += side.J;
      response.segment(side.at, side.J.size()) += side.response;
    }
    own = J.dot(response);
  }

  /// Takes the share of another one away. Returns it.
  double part_from(const Combination& other) {
    const double share = other.own > 0.0 ? J.dot(other.response) / other.own : 0.0;
    J -= share * other.J;
    response -= share * other.response;
    target -= share * other.target;
    own = J.dot(response);
    return share;
  }

  /// Makes the row of a problem.
  [[nodiscard]] DriveRow row(DriveRow made, const std::vector<Part>& parts) const {
    made.tie.clear();
    for (const Part& part : parts) {
      if (J.segment(part.at, part.size).any()) {
        made.tie.push_back(
            {part.at, J.segment(part.at, part.size), response.segment(part.at, part.size)});
      }
    }
    made.own = own;
    made.target = target;
    return made;
  }
};

bool is_rigid(const DriveRow& row) {
  return !row.tie.empty() && row.own > 0.0 && row.compliance == 0.0 && std::isinf(row.least) &&
         std::isinf(row.greatest);
}

/// Computes the velocity along one tie that a unit impulse along another one causes.
double response_between(const DriveRow& one, const DriveRow& other) {
  double sum = 0.0;
  for (const TieRowSide& on : one.tie) {
    for (const TieRowSide& by : other.tie) {
      if (on.at == by.at) {
        sum += on.J.dot(by.response);
      }
    }
  }
  return sum;
}

}  // namespace

// The diagonal of a Cholesky factorisation of their responses.
double least_left_of_ties(const ContactRows& rows) {
  std::vector<const DriveRow*> rigid;
  for (const DriveRow& row : rows.drives) {
    if (is_rigid(row)) {
      rigid.push_back(&row);
    }
  }
  const auto n = static_cast<Index>(rigid.size());
  MatrixXd L = MatrixXd::Zero(n, n);
  double least = 1.0;
  for (Index k = 0; k < n; ++k) {
    const DriveRow& row = *rigid[static_cast<std::size_t>(k)];
    for (Index l = 0; l < k; ++l) {
      const double product = L.row(k).head(l).dot(L.row(l).head(l));
      const double response = response_between(row, *rigid[static_cast<std::size_t>(l)]);
      L(k, l) = L(l, l) > 0.0 ? (response - product) / L(l, l) : 0.0;
    }
    const double left = row.own - L.row(k).head(k).squaredNorm();
    least = std::min(least, left / row.own);
    L(k, k) = std::sqrt(std::max(0.0, left));
  }
  return least;
}

DecoupledTies::DecoupledTies(const ContactProblem& problem, const ContactRows& rows) : rows_(rows) {
  std::vector<Combination> all;
  for (std::size_t k = 0; k < rows.drives.size(); ++k) {
    if (is_rigid(rows.drives[k])) {
      rigid_.push_back(k);
      all.emplace_back(rows.drives[k], rows.layout.size);
    }
  }
  const std::size_t n = all.size();
  const std::vector<Part> parts = parts_of(problem, rows.layout);
  shares_ = MatrixXd::Identity(static_cast<Index>(n), static_cast<Index>(n));
  for (std::size_t k = 0; k < n; ++k) {
    const auto next = std::ranges::max_element(all.begin() + static_cast<std::ptrdiff_t>(k),
                                               all.end(), {}, &Combination::own);
    const auto p = static_cast<std::size_t>(next - all.begin());
    std::swap(all[k], all[p]);
    std::swap(rigid_[k], rigid_[p]);
    const auto column = static_cast<Index>(k);
    shares_.row(column).head(column).swap(shares_.row(static_cast<Index>(p)).head(column));
    for (std::size_t l = 0; l < k; ++l) {  // What rounding left the first time.
      shares_(column, static_cast<Index>(l)) += all[k].part_from(all[l]);
    }
    DriveRow& row = rows_.drives[rigid_[k]];
    const double whole = row.own;
    row = all[k].row(std::move(row), parts);
    if (!(row.own > kImplied * whole)) {
      all[k].own = 0.0;
      row.least = 0.0;
      row.greatest = 0.0;
    }
    for (std::size_t l = k + 1; l < n; ++l) {
      shares_(static_cast<Index>(l), column) = all[l].part_from(all[k]);
    }
  }
}

void DecoupledTies::meet(Projection& projection) const {
  for (const std::size_t k : rigid_) {
    const DriveRow& row = rows_.drives[k];
    double& impulse = projection.impulses.drives[k];
    const double wanted = impulse - row.excess_velocity(0.0, projection.velocities) / row.own;
    const double to = std::clamp(wanted, row.least, row.greatest);
    row.apply(to - impulse, projection.velocities);
    impulse = to;
  }
  projection.residual = greatest_residual(rows_, projection.impulses, projection.velocities);
}

Impulses DecoupledTies::combined(Impulses impulses) const {
  VectorXd r(static_cast<Index>(rigid_.size()));
  for (std::size_t k = 0; k < rigid_.size(); ++k) {
    r[static_cast<Index>(k)] = impulses.drives[rigid_[k]];
  }
  r = (shares_.transpose() * r).eval();
  for (std::size_t k = 0; k < rigid_.size(); ++k) {
    impulses.drives[rigid_[k]] = r[static_cast<Index>(k)];
  }
  return impulses;
}

Impulses DecoupledTies::separate(Impulses impulses) const {
  VectorXd r(static_cast<Index>(rigid_.size()));
  for (std::size_t k = 0; k < rigid_.size(); ++k) {
    r[static_cast<Index>(k)] = impulses.drives[rigid_[k]];
  }
  shares_.triangularView<Eigen::UnitLower>().transpose().solveInPlace(r);
  for (std::size_t k = 0; k < rigid_.size(); ++k) {
    impulses.drives[rigid_[k]] = r[static_cast<Index>(k)];
  }
  return impulses;
}

}  // namespace firstcontact::detail
