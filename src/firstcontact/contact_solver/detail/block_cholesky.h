/// @file
/// Sparse symmetric systems of equations in blocks of six, one for the velocity of each body.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/contact_solver/detail/block_pattern.h>

namespace firstcontact::detail {

/// The factor L L^T of a symmetric, positive definite matrix of 6 x 6 blocks.
///
/// The blocks on the diagonal are stored as their inverses.
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;

  /// Makes a matrix with these blocks, as BlockPattern.
  BlockCholesky(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);

  [[nodiscard]] BlockPattern::Place place(std::size_t i, std::size_t j) const {
    return pattern_.place(i, j);
  }

  void set_identity();

  [[nodiscard]] Block& at(const BlockPattern::Place& place) { return blocks_[place.index]; }

  /// Factorises the matrix in its place.
  void factorise();

  /// Solves with the factor.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  BlockPattern pattern_;
  std::vector<Block> blocks_;
};

}  // namespace firstcontact::detail
