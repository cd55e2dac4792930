// The sparse factorisations against dense ones.

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <firstcontact/contact_solver/detail/block_cholesky.h>

namespace firstcontact::detail {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Pairs = std::vector<std::array<std::size_t, 2>>;

/// The identity and, for each pair, G^T G with random columns for both blocks.
struct System {
  BlockCholesky blocks;
  MatrixXd dense;
};

System random_system(std::mt19937& rng, std::size_t count, const Pairs& pairs) {
  std::normal_distribution<double> normal;
  const auto size = static_cast<Index>(6 * count);
  System system{BlockCholesky(count, pairs), MatrixXd::Identity(size, size)};
  system.blocks.set_identity();
  for (const auto& [i, k] : pairs) {
    const MatrixXd G = MatrixXd::NullaryExpr(3, 12, [&] { return normal(rng); });
    for (const auto& [a, b] : {std::array{i, k}, std::array{i, i}, std::array{k, k}}) {
      const MatrixXd G_a = a == i ? G.leftCols(6) : G.rightCols(6);
      const MatrixXd G_b = b == i ? G.leftCols(6) : G.rightCols(6);
      const BlockCholesky::Block block = G_a.transpose() * G_b;
      const BlockPattern::Place place = system.blocks.place(a, b);
      system.blocks.at(place) += place.is_turned ? BlockCholesky::Block(block.transpose()) : block;
      const auto row = static_cast<Index>(6 * a);
      const auto column = static_cast<Index>(6 * b);
      system.dense.block(row, column, 6, 6) += block;
      if (a != b) {
        system.dense.block(column, row, 6, 6) += block.transpose();
      }
    }
  }
  return system;
}

void expect_same(std::mt19937& rng, std::size_t count, const Pairs& pairs) {
  std::normal_distribution<double> normal;
  System system = random_system(rng, count, pairs);
  const VectorXd right = VectorXd::NullaryExpr(system.dense.rows(), [&] { return normal(rng); });
  system.blocks.factorise();
  const VectorXd expected = system.dense.llt().solve(right);
  EXPECT_LE((system.blocks.solve(right) - expected).norm(), 1e-10 * (1.0 + expected.norm()));
}

TEST(BlockCholesky, SolvesAsADenseOne) {
  std::mt19937 rng(1);
  for (int i = 0; i < 50; ++i) {
    const std::size_t count = 1 + rng() % 20;
    Pairs pairs;
    for (std::size_t k = 0; count > 1 && k < 2 * count; ++k) {
      const std::size_t a = rng() % count;
      const std::size_t b = (a + 1 + rng() % (count - 1)) % count;
      pairs.push_back({a, b});
    }
    expect_same(rng, count, pairs);
  }
}

// Blocks coupled like a star give no further blocks where the middle comes last.
TEST(BlockCholesky, TakesAStarAndWhatIsAlone) {
  std::mt19937 rng(2);
  Pairs pairs;
  for (std::size_t k = 1; k < 300; ++k) {
    pairs.push_back({0, k});
  }
  expect_same(rng, 302, pairs);
  expect_same(rng, 3, {});
}

}  // namespace
}  // namespace firstcontact::detail
