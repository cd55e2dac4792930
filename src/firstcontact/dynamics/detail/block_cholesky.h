/// @file
/// Sparse systems of equations in blocks of six, as velocities of bodies have.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace firstcontact::detail {

/// A symmetric, positive definite matrix of 6 x 6 blocks and its factor L L^T. Blocks are
/// eliminated in an order that keeps few of L (of least degree first), which is found once for all
/// values.
class BlockCholesky {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;

  /// @param count  of the blocks along the diagonal
  /// @param pairs  of those that have a block between them, each as often as one likes; i = i too
  BlockCholesky(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);

  /// Of the block between i and j.
  struct Place {
    std::size_t index = 0;
    bool is_turned = false;  ///< It holds the block of row j and column i.
  };
  [[nodiscard]] Place place(std::size_t i, std::size_t j) const;

  void set_identity();

  [[nodiscard]] Block& at(const Place& place) { return blocks_[place.index]; }

  /// Puts the factor in the place of the matrix.
  void factorise();

  /// Solves with the factor.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  void find_order(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);
  void find_updates();
  [[nodiscard]] std::size_t find(std::size_t row, std::size_t column) const;

  std::vector<std::size_t> step_;  // When each block is eliminated.
  // By elimination: the diagonal block comes first, then those below it.
  std::vector<std::size_t> first_;         // Of each column in blocks_; one more than columns.
  std::vector<std::size_t> row_;           // Of each block.
  std::vector<std::size_t> updated_;       // What each pair of blocks of a column is taken from.
  std::vector<std::size_t> first_update_;  // Of each column in updated_.
  std::vector<Block> blocks_;
};

}  // namespace firstcontact::detail
