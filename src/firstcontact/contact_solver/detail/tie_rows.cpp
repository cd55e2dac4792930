#include <firstcontact/contact_solver/detail/tie_rows.h>

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// [-]  The least part of a row's response across other rows, as a fraction of its greatest one.
constexpr double kRedundant = 1e-12;

/// [1/kg]  The response of a row in the direction in which its bodies yield most. A response below
/// a tiny fraction of it is rounding.
double greatest_response(const TieRow& row, const ContactProblem& problem) {
  double sum = 0.0;
  for (const TieSide& side : row.sides) {
    const ContactBody& body = problem.bodies[side.body];
    const double linear = side.row.head<3>().norm();
    const double angular = side.row.tail<3>().norm();
    if (body.link) {
      const Eigen::VectorXd J = linear * body.link->J.topRows<3>().colwise().norm().transpose() +
                                angular * body.link->J.bottomRows<3>().colwise().norm().transpose();
      sum += J.dot(problem.mechanisms[body.link->mechanism].inverse_mass.cwiseAbs() * J);
    } else {
      sum += linear * linear * body.inverse_inertia.mass.maxCoeff() +
             angular * angular * body.inverse_inertia.rotation.norm();
    }
  }
  return sum;
}

/// Computes J M^-1 J^T.
MatrixXd response_of(const ContactProblem& problem) {
  const auto n = static_cast<Index>(problem.ties.size());
  MatrixXd response(n, n);
  for (Index k = 0; k < n; ++k) {
    for (Index l = 0; l <= k; ++l) {
      response(k, l) = inverse_mass_between(problem.ties[static_cast<std::size_t>(k)],
                                            problem.ties[static_cast<std::size_t>(l)], problem);
    }
  }
  return response;
}

}  // namespace

double inverse_mass_between(const TieRow& one, const TieRow& other, const ContactProblem& problem) {
  double sum = 0.0;
  for (const TieSide& on : one.sides) {
    const ContactBody& pushed = problem.bodies[on.body];
    for (const TieSide& by : other.sides) {
      const ContactBody& body = problem.bodies[by.body];
      if (pushed.link && body.link && pushed.link->mechanism == body.link->mechanism) {
        const ContactMechanism& mechanism = problem.mechanisms[body.link->mechanism];
        sum += (pushed.link->J.transpose() * on.row)
                   .dot(mechanism.inverse_mass * (body.link->J.transpose() * by.row));
      } else if (on.body == by.body && !body.link) {
        const InverseInertia& inverse = body.inverse_inertia;
        sum += on.row.head<3>().dot(inverse.mass.cwiseProduct(by.row.head<3>())) +
               on.row.tail<3>().dot(inverse.rotation * by.row.tail<3>());
      }
    }
  }
  return sum;
}

std::vector<bool> find_redundant(const ContactProblem& problem, std::size_t first, double least) {
  MatrixXd L = response_of(problem);
  const Index n = L.rows();
  std::vector<bool> redundant(problem.ties.size(), false);
  for (Index k = 0; k < n; ++k) {
    for (Index l = 0; l < k; ++l) {
      const double product = L.row(k).head(l).dot(L.row(l).head(l));
      L(k, l) = L(l, l) > 0.0 ? (L(k, l) - product) / L(l, l) : 0.0;
    }
    const double left = L(k, k) - L.row(k).head(k).squaredNorm();
    const auto row = static_cast<std::size_t>(k);
    const double slight =
        row < first ? kRedundant * greatest_response(problem.ties[row], problem) : least * L(k, k);
    redundant[row] = !(left > slight);
    L(k, k) = redundant[row] ? 0.0 : std::sqrt(left);
  }
  return redundant;
}

std::vector<bool> find_redundant(const ContactProblem& problem) {
  return find_redundant(problem, problem.ties.size(), kRedundant);
}

void take_out(TieRow& row) {
  row.least = 0.0;
  row.greatest = 0.0;
}

}  // namespace firstcontact::detail
