/// @file
/// Sparse systems of equations in blocks of six that are not symmetric.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/dynamics/detail/block_pattern.h>

namespace firstcontact::detail {

/// A matrix of 6 x 6 blocks with a symmetric pattern and its factors L U. Blocks are not exchanged:
/// it is for matrices that are not far from positive definite.
class BlockLu {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;

  /// As BlockPattern.
  BlockLu(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);

  [[nodiscard]] BlockPattern::Place place(std::size_t i, std::size_t j) const {
    return pattern_.place(i, j);
  }

  void set_identity();

  /// The block of row i and column j for their place, and the one of row j and column i.
  [[nodiscard]] Block& at(const BlockPattern::Place& place) {
    return place.is_turned ? upper_[place.index] : lower_[place.index];
  }
  [[nodiscard]] Block& opposite(const BlockPattern::Place& place) {
    return place.is_turned ? lower_[place.index] : upper_[place.index];
  }

  /// Puts the factors in the place of the matrix.
  void factorise();

  /// Solves with the factors.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  BlockPattern pattern_;
  std::vector<Block> lower_;  // Along the diagonal the inverse of U's, once factorised.
  std::vector<Block> upper_;  // Opposite of those of lower_.
};

}  // namespace firstcontact::detail
