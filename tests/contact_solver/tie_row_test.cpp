// Rows that tie two bodies, against a dense reference that tries every state of every row.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <firstcontact/contact_solver/contact_problem.h>

#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::Random;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// [m/s]  Rounding leaves up to 2e-11 in motion space.
constexpr double kTieTolerance = 1e-10;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

ContactBody random_body_of(Random& random) {
  ContactBody body;
  body.inverse_inertia.mass = Vector3d::Constant(random.logarithmic(0.3, 3.0));
  const Eigen::Matrix3d R = random.rotation().toRotationMatrix();
  const Vector3d inverse(random.uniform(1.0, 3.0), random.uniform(1.0, 3.0),
                         random.uniform(1.0, 3.0));
  body.inverse_inertia.rotation = R * inverse.asDiagonal() * R.transpose();
  body.v = random.vector(0.0, 2.0);
  body.w = random.vector(0.0, 2.0);
  return body;
}

TieRow along(std::size_t a, std::size_t b, const Vector3d& direction, const Vector3d& arm_A,
             const Vector3d& arm_B) {
  TieRow tie;
  Vector6d row;
  row << -direction, -arm_A.cross(direction);
  tie.sides.push_back({a, row});
  row << direction, arm_B.cross(direction);
  tie.sides.push_back({b, row});
  return tie;
}

/// A row of the reference: u = J V, and the law of a drive.
struct ReferenceRow {
  VectorXd J;
  double target;
  double compliance;
  double least;
  double greatest;
};

/// Velocities of bodies, then of mechanisms, and the inverse of their mass matrix.
struct ReferenceProblem {
  VectorXd V;
  MatrixXd inverse_mass;
  std::vector<ReferenceRow> rows;
};

ReferenceProblem reference_of(const ContactProblem& problem) {
  std::vector<Index> at;
  Index size = 0;
  for (const ContactBody& body : problem.bodies) {
    at.push_back(size);
    size += body.link ? 0 : 6;
  }
  std::vector<Index> mechanism;
  for (const ContactMechanism& m : problem.mechanisms) {
    mechanism.push_back(size);
    size += m.velocity.size();
  }
  ReferenceProblem made{VectorXd::Zero(size), MatrixXd::Zero(size, size), {}};
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    if (!problem.bodies[b].link) {
      const InverseInertia& inverse = problem.bodies[b].inverse_inertia;
      made.V.segment<6>(at[b]) << problem.bodies[b].v, problem.bodies[b].w;
      made.inverse_mass.block<3, 3>(at[b], at[b]) = inverse.mass.asDiagonal();
      made.inverse_mass.block<3, 3>(at[b] + 3, at[b] + 3) = inverse.rotation;
    }
  }
  for (std::size_t m = 0; m < problem.mechanisms.size(); ++m) {
    const Index n = problem.mechanisms[m].velocity.size();
    made.V.segment(mechanism[m], n) = problem.mechanisms[m].velocity;
    made.inverse_mass.block(mechanism[m], mechanism[m], n, n) = problem.mechanisms[m].inverse_mass;
  }
  const auto add = [&](std::size_t b, const Vector6d& row, VectorXd& J) {
    if (const auto& link = problem.bodies[b].link) {
      J.segment(mechanism[link->mechanism], link->J.cols()) += link->J.transpose() * row;
    } else {
      J.segment<6>(at[b]) += row;
    }
  };
  for (const ContactPoint& contact : problem.contacts) {
    const TieRow normal = along(contact.bodies[0], contact.bodies[1],
                                contact.frame.row(0).transpose(), contact.arm_A, contact.arm_B);
    ReferenceRow row{VectorXd::Zero(size), contact.least_normal_velocity, 0.0, 0.0, kInfinity};
    for (const TieSide& side : normal.sides) {
      add(side.body, side.row, row.J);
    }
    made.rows.push_back(row);
  }
  for (const TieRow& tie : problem.ties) {
    ReferenceRow row{VectorXd::Zero(size), tie.target, tie.compliance, tie.least, tie.greatest};
    for (const TieSide& side : tie.sides) {
      add(side.body, side.row, row.J);
    }
    made.rows.push_back(row);
  }
  return made;
}

/// The velocities of the problem without friction: of all states of its rows (within the bounds of
/// the impulse, at the least, at the greatest) the one in which every law holds.
std::optional<VectorXd> reference_velocities(const ReferenceProblem& problem) {
  const std::size_t count = problem.rows.size();
  std::size_t states = 1;
  for (std::size_t k = 0; k < count; ++k) {
    states *= 3;
  }
  constexpr double kSlack = 1e-9;
  for (std::size_t number = 0; number < states; ++number) {
    std::vector<std::size_t> inner;
    VectorXd V = problem.V;
    std::vector<int> state(count);
    bool is_possible = true;
    for (std::size_t k = 0, rest = number; k < count; ++k, rest /= 3) {
      state[k] = static_cast<int>(rest % 3);
      const ReferenceRow& row = problem.rows[k];
      if (state[k] == 0) {
        inner.push_back(k);
        continue;
      }
      const double impulse = state[k] == 1 ? row.least : row.greatest;
      is_possible = is_possible && std::isfinite(impulse);
      if (is_possible) {
        V += impulse * (problem.inverse_mass * row.J);
      }
    }
    if (!is_possible) {
      continue;
    }
    const auto n = static_cast<Index>(inner.size());
    MatrixXd J(n, problem.V.size());
    VectorXd missing(n);
    MatrixXd compliance = MatrixXd::Zero(n, n);
    for (Index i = 0; i < n; ++i) {
      const ReferenceRow& row = problem.rows[inner[static_cast<std::size_t>(i)]];
      J.row(i) = row.J.transpose();
      missing[i] = row.target - row.J.dot(V);
      compliance(i, i) = row.compliance;
    }
    const VectorXd r = n == 0 ? VectorXd()
                              : VectorXd((J * problem.inverse_mass * J.transpose() + compliance)
                                             .completeOrthogonalDecomposition()
                                             .solve(missing));
    const VectorXd found = n == 0 ? V : VectorXd(V + problem.inverse_mass * J.transpose() * r);
    for (std::size_t k = 0; k < count; ++k) {
      const ReferenceRow& row = problem.rows[k];
      const auto i = std::ranges::find(inner, k) - inner.begin();
      const double impulse = state[k] == 0 ? r[i] : state[k] == 1 ? row.least : row.greatest;
      const double excess = row.J.dot(found) + row.compliance * impulse - row.target;
      is_possible = is_possible &&
                    (state[k] == 0 ? std::abs(excess) <= kSlack && impulse >= row.least - kSlack &&
                                         impulse <= row.greatest + kSlack
                     : state[k] == 1 ? excess >= -kSlack
                                     : excess <= kSlack);
    }
    if (is_possible) {
      return found;
    }
  }
  return std::nullopt;
}

/// Three free bodies, a fixed one and two links of a mechanism. Ties of every kind are among them,
/// and contacts without friction.
ContactProblem random_ties(Random& random) {
  ContactProblem problem;
  for (int b = 0; b < 3; ++b) {
    problem.bodies.push_back(random_body_of(random));
  }
  problem.bodies.emplace_back();  // Fixed, and moved by a script.
  problem.bodies.back().v = random.vector(0.0, 1.0);
  const Index n = 3;
  MatrixXd A(n, n);
  for (double& number : A.reshaped()) {
    number = random.uniform(-1.0, 1.0);
  }
  problem.mechanisms.push_back(
      {A * A.transpose() + MatrixXd::Identity(n, n), VectorXd(random.vector(0.0, 1.0))});
  for (int l = 0; l < 2; ++l) {
    ContactBody link;
    MechanismLink moved{0, Eigen::Matrix<double, 6, Eigen::Dynamic>(6, n)};
    for (double& number : moved.J.reshaped()) {
      number = random.uniform(-1.0, 1.0);
    }
    link.link = moved;
    problem.bodies.push_back(link);
  }
  const auto any_tie = [&](std::size_t a, std::size_t b) {
    return along(a, b, random.direction(), random.vector(0.0, 1.0), random.vector(0.0, 1.0));
  };
  problem.ties.push_back(any_tie(0, 1));  // One direction of a joint.
  problem.ties.push_back(any_tie(1, 2));  // A cable.
  problem.ties.back().greatest = 0.0;
  problem.ties.back().target = random.uniform(-0.5, 0.5);
  problem.ties.push_back(any_tie(3, 2));  // A spring.
  problem.ties.back().compliance = random.logarithmic(1e-3, 1e3);
  problem.ties.back().target = random.uniform(-1.0, 1.0);
  problem.ties.push_back(any_tie(4, 0));  // A damper that slips.
  problem.ties.back().compliance = 0.1;
  problem.ties.back().least = -0.1;
  problem.ties.back().greatest = 0.2;
  problem.ties.push_back(any_tie(4, 5));  // A loop of links.
  for (int k = 0; k < 3; ++k) {
    ContactPoint contact;
    contact.bodies = {k == 0 ? std::size_t{3} : std::size_t{0},
                      k == 2 ? std::size_t{5} : 1 + static_cast<std::size_t>(k)};
    contact.arm_A = random.vector(0.0, 1.0);
    contact.arm_B = random.vector(0.0, 1.0);
    contact.frame = random.rotation().toRotationMatrix();
    contact.least_normal_velocity = random.uniform(-0.3, 0.1);
    problem.contacts.push_back(contact);
  }
  return problem;
}

VectorXd velocities_of_solution(const ContactProblem& problem, const ContactSolution& solution,
                                Index size) {
  VectorXd V(size);
  Index at = 0;
  for (std::size_t b = 0; b < problem.bodies.size(); ++b) {
    if (!problem.bodies[b].link) {
      V.segment<6>(at) << solution.bodies[b].v, solution.bodies[b].w;
      at += 6;
    }
  }
  for (const VectorXd& velocities : solution.mechanisms) {
    V.segment(at, velocities.size()) = velocities;
    at += velocities.size();
  }
  return V;
}

TEST(TieRow, IsThatOfTheDenseReference) {
  Random random(1);
  for (int i = 0; i < 30; ++i) {
    const ContactProblem problem = random_ties(random);
    const ReferenceProblem reference = reference_of(problem);
    const std::optional<VectorXd> right = reference_velocities(reference);
    ASSERT_TRUE(right) << i;
    for (const ProjectionSpace space :
         {ProjectionSpace::automatic, ProjectionSpace::contact, ProjectionSpace::motion}) {
      const ContactSolution solution = project_on_contacts(
          problem, {.tolerance = kTieTolerance, .space = space, .sweeps = 100000});
      SCOPED_TRACE("problem " + std::to_string(i) + ", space " +
                   std::to_string(static_cast<int>(space)));
      ASSERT_LE(solution.residual, kTieTolerance);
      ASSERT_LE(contact_residual(problem, solution), 2.0 * kTieTolerance);
      ASSERT_EQ(solution.ties.size(), problem.ties.size());
      ASSERT_TRUE(solution.drives.empty());
      const VectorXd V = velocities_of_solution(problem, solution, reference.V.size());
      ASSERT_LE((V - *right).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

// Its guess is the answer: then there is nothing to do.
TEST(TieRow, StartsFromItsGuess) {
  Random random(2);
  ContactProblem problem = random_ties(random);
  const ContactSolution first = project_on_contacts(problem, {.tolerance = kTieTolerance});
  for (std::size_t k = 0; k < problem.ties.size(); ++k) {
    problem.ties[k].guess = first.ties[k];
  }
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    problem.contacts[k].guess = first.impulses[k];
  }
  EXPECT_EQ(project_on_contacts(problem, {.tolerance = 2.0 * kTieTolerance}).iterations, 0);
}

// Momentum goes from one body to the other.
TEST(TieRow, KeepsTheMomentumOfFreeBodies) {
  Random random(3);
  ContactProblem problem;
  problem.bodies = {random_body_of(random), random_body_of(random)};
  const Vector3d point = random.vector(0.0, 1.0);
  for (int k = 0; k < 3; ++k) {
    problem.ties.push_back(along(0, 1, Vector3d::Unit(k), point, point));
  }
  const ContactSolution solution = project_on_contacts(problem, {.tolerance = kTieTolerance});
  Vector6d change = Vector6d::Zero();
  for (std::size_t b = 0; b < 2; ++b) {
    const InverseInertia& inverse = problem.bodies[b].inverse_inertia;
    change.head<3>() += (solution.bodies[b].v - problem.bodies[b].v).cwiseQuotient(inverse.mass);
    change.tail<3>() += inverse.rotation.inverse() * (solution.bodies[b].w - problem.bodies[b].w);
  }
  EXPECT_LE(change.norm(), 1e-12);
  const auto at_point = [&](std::size_t b) -> Vector3d {
    return solution.bodies[b].v + solution.bodies[b].w.cross(point);
  };
  EXPECT_LE((at_point(1) - at_point(0)).norm(), 1e-10);
}

// The same joint three times, and one between two bodies that nothing moves, are no obstacle.
TEST(TieRow, TakesRedundantRows) {
  Random random(4);
  ContactProblem problem;
  problem.bodies = {random_body_of(random), random_body_of(random), ContactBody(), ContactBody()};
  const Vector3d point = random.vector(0.0, 1.0);
  for (int k = 0; k < 9; ++k) {
    problem.ties.push_back(along(0, 1, Vector3d::Unit(k % 3), point, point));
  }
  problem.ties.push_back(along(2, 3, Vector3d::UnitX(), point, point));
  for (const ProjectionSpace space : {ProjectionSpace::contact, ProjectionSpace::motion}) {
    const ContactSolution solution =
        project_on_contacts(problem, {.tolerance = kTieTolerance, .space = space, .sweeps = 10000});
    EXPECT_LE(solution.residual, kTieTolerance);
    EXPECT_EQ(solution.ties.back(), 0.0);
  }
}

// A chain of many ties is solved as exactly as one tie.
TEST(TieRow, HoldsAlongAChain) {
  ContactProblem problem;
  problem.bodies.resize(1);
  for (std::size_t b = 1; b <= 100; ++b) {
    ContactBody body;
    body.inverse_inertia.mass.setOnes();
    body.inverse_inertia.rotation.setIdentity();
    body.v = Vector3d(0.0, 0.0, -0.1);
    problem.bodies.push_back(body);
    problem.ties.push_back(along(b - 1, b, Vector3d::UnitZ(), Vector3d::Zero(), Vector3d::Zero()));
  }
  const ContactSolution solution = project_on_contacts(problem, {.tolerance = 1e-10});
  EXPECT_LE(solution.residual, 1e-10);
  for (std::size_t b = 1; b <= 100; ++b) {
    EXPECT_NEAR(solution.bodies[b].v.z(), 0.0, 1e-8);
    EXPECT_NEAR(solution.ties[b - 1], 0.1 * static_cast<double>(101 - b), 1e-6);
  }
}

}  // namespace
}  // namespace firstcontact
