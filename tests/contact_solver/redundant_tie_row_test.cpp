// Rows of joints that others imply, and fixed points by mixing, beside linear algebra.

#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <firstcontact/contact_solver/detail/anderson_mixing.h>
#include <firstcontact/contact_solver/detail/tie_rows.h>

namespace firstcontact::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class Draw {
 public:
  explicit Draw(std::uint32_t seed) : generator_(seed) {}
  double number() { return -1.0 + 2.0 * static_cast<double>(generator_()) / 4294967295.0; }
  VectorXd vector(Eigen::Index size) {
    VectorXd drawn(size);
    for (Eigen::Index k = 0; k < size; ++k) {
      drawn[k] = number();
    }
    return drawn;
  }

 private:
  std::mt19937 generator_;
};

/// Makes a row of two bodies from twelve numbers.
TieRow row_of(const VectorXd& numbers) {
  TieRow row;
  for (std::size_t b = 0; b < 2; ++b) {
    row.sides.push_back({.body = b, .row = numbers.segment<6>(6 * static_cast<Eigen::Index>(b))});
  }
  return row;
}

Eigen::Index rank_of(const MatrixXd& rows) {
  if (rows.rows() == 0) {
    return 0;
  }
  Eigen::JacobiSVD<MatrixXd> svd(rows);
  svd.setThreshold(1e-9);
  return svd.rank();
}

// A row is redundant exactly where it does not raise the rank.
TEST(RedundantTies, AreThoseThatDoNotRaiseTheRank) {
  Draw draw(1);
  for (int trial = 0; trial < 200; ++trial) {
    ContactProblem problem;
    for (int b = 0; b < 2; ++b) {
      ContactBody body;
      body.inverse_inertia.mass.setConstant(1.5 + draw.number());
      const Eigen::Matrix3d root =
          Eigen::Matrix3d::Identity() + 0.3 * MatrixXd(draw.vector(9)).reshaped(3, 3);
      body.inverse_inertia.rotation = root * root.transpose();
      problem.bodies.push_back(body);
    }
    MatrixXd rows(0, 12);
    std::vector<bool> right;
    for (int k = 0; k < 16; ++k) {
      VectorXd next = draw.vector(12);
      if (draw.number() > 0.0 && rows.rows() > 0) {  // A combination of those before it.
        next = rows.transpose() * draw.vector(rows.rows());
      }
      MatrixXd more(rows.rows() + 1, 12);
      more << rows, next.transpose();
      right.push_back(rank_of(more) == rank_of(rows));
      rows = more;
      problem.ties.push_back(row_of(next));
    }
    EXPECT_EQ(find_redundant(problem), right) << trial;
  }
}

TEST(RedundantTies, AreRowsThatNothingCanMoveAlong) {
  ContactProblem problem;
  ContactBody body;
  body.inverse_inertia.mass = {1.0, 0.0, 1.0};
  problem.bodies.push_back(body);
  for (int k = 0; k < 6; ++k) {
    TieRow row;
    row.sides.push_back({.body = 0, .row = Eigen::Matrix<double, 6, 1>::Unit(k)});
    problem.ties.push_back(row);
  }
  EXPECT_EQ(find_redundant(problem), (std::vector<bool>{false, true, false, true, true, true}));
}

// Repeats of these maps grow: n + 1 guesses suffice for n unknowns, but for rounding.
TEST(AndersonMixing, FindsTheFixedPointOfALinearMapInOneGuessMoreThanUnknowns) {
  Draw draw(2);
  for (Eigen::Index n = 1; n <= 8; ++n) {
    const MatrixXd A =
        3.0 * MatrixXd(draw.vector(n * n)).reshaped(n, n) + 4.0 * MatrixXd::Identity(n, n);
    const VectorXd b = draw.vector(n);
    const VectorXd right = (MatrixXd::Identity(n, n) - A).lu().solve(b);
    AndersonMixing mixing;
    VectorXd x = VectorXd::Zero(n);
    for (Eigen::Index k = 0; k <= n; ++k) {
      x = mixing.next(x, A * x + b - x);
    }
    EXPECT_LE((x - right).norm(), 1e-6 * right.norm()) << n;
  }
}

}  // namespace
}  // namespace firstcontact::detail
