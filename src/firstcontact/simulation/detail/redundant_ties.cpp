#include <firstcontact/simulation/detail/redundant_ties.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Core>

#include <firstcontact/simulation/detail/island_state.h>
#include <firstcontact/simulation/detail/island_ties.h>
#include <firstcontact/simulation_model/detail/simulation_model.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// [-]  What is left of a row's response, as a part of the greatest that it could have.
constexpr double kRedundant = 1e-12;

/// Sets of bodies that ties connect.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// Whether the two were in different sets.
  bool join(std::size_t one, std::size_t other) {
    one = root(one);
    other = root(other);
    parent_[one] = other;
    return one != other;
  }

 private:
  [[nodiscard]] std::size_t root(std::size_t k) const {
    while (parent_[k] != k) {
      k = parent_[k];
    }
    return k;
  }

  std::vector<std::size_t> parent_;
};

bool moves_freely(const SimBody& body) {
  const auto is_set = [](bool lock) { return lock; };
  return body.kind == BodyKind::free && !body.link_body &&
         std::ranges::none_of(body.inertia.locked_translation, is_set) &&
         std::ranges::none_of(body.inertia.locked_rotation, is_set);
}

/// [1/kg]  The response of a row in the direction in which its bodies yield most: below a tiny part
/// of it a response is rounding.
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

/// J M^-1 J^T
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

bool may_be_redundant(const IslandState& state) {
  Sets sets(state.size() + 1);
  for (const std::size_t t : state.ties) {
    const SimTie& tie = state.model.ties[t];
    std::array<std::size_t, 2> ends{state.size(), state.size()};
    for (std::size_t s = 0; s < 2; ++s) {
      const std::optional<std::size_t>& body = tie.ends[s].body;
      if (body && moves_freely(state.model.bodies[*body]) && state.place.contains(*body)) {
        ends[s] = state.place.at(*body);
      }
    }
    if (tie.is_joint() && !sets.join(ends[0], ends[1])) {
      return true;
    }
  }
  return false;
}

std::vector<bool> find_redundant(const ContactProblem& problem) {
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
    redundant[row] = !(left > kRedundant * greatest_response(problem.ties[row], problem));
    L(k, k) = redundant[row] ? 0.0 : std::sqrt(left);
  }
  return redundant;
}

void take_out(TieRow& row) {
  row.least = 0.0;
  row.greatest = 0.0;
}

}  // namespace firstcontact::detail
