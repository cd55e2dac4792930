/// @file
/// Where sparse matrices in blocks of six, as velocities of bodies have, and their factors are not
/// zero.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace firstcontact::detail {

/// The blocks of the lower triangle of a matrix of 6 x 6 blocks, and of its factors. Those of the
/// upper one lie symmetrically. Blocks are eliminated in an order that keeps few of them (of least
/// degree first), which is found once for all values.
class BlockPattern {
 public:
  /// @param count  of the blocks along the diagonal
  /// @param pairs  of those that have a block between them, each as often as one likes; i = i too
  BlockPattern(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);

  /// The place of the block between i and j.
  struct Place {
    std::size_t index = 0;
    bool is_turned = false;  ///< It is the one of row j and column i.
  };
  [[nodiscard]] Place place(std::size_t i, std::size_t j) const;

  [[nodiscard]] std::size_t columns() const { return step.size(); }
  [[nodiscard]] std::size_t blocks() const { return row.size(); }

  std::vector<std::size_t> step;  ///< When each block along the diagonal is eliminated.
  // By elimination: the diagonal block comes first, then those below it.
  std::vector<std::size_t> first;         ///< Of each column; one more than columns.
  std::vector<std::size_t> row;           ///< Of each block.
  std::vector<std::size_t> updated;       ///< What each pair of blocks of a column is taken from.
  std::vector<std::size_t> first_update;  ///< Of each column in `updated`.

 private:
  void find_order(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);
  void find_updates();
  [[nodiscard]] std::size_t find(std::size_t in_row, std::size_t column) const;
};

}  // namespace firstcontact::detail
