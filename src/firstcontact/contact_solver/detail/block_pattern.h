/// @file
/// The non-zero blocks of sparse matrices in blocks of six, and of their factors.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace firstcontact::detail {

/// The blocks of the lower triangle of a symmetric matrix of 6 x 6 blocks, and of its factors.
///
/// Blocks are eliminated in an order that keeps their number small (of least degree first). The
/// order is found once for all values.
class BlockPattern {
 public:
  /// Finds the order and the blocks.
  ///
  /// @param count  number of blocks along the diagonal
  /// @param pairs  pairs (i, j) with a block between them, repeated or not; i = j is permitted
  BlockPattern(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);

  /// The place of the block between i and j.
  struct Place {
    std::size_t index = 0;
    bool is_turned = false;  ///< Whether it is stored as the block of row j and column i.
  };
  [[nodiscard]] Place place(std::size_t i, std::size_t j) const;

  [[nodiscard]] std::size_t columns() const { return step.size(); }
  [[nodiscard]] std::size_t blocks() const { return row.size(); }

  std::vector<std::size_t> step;  ///< Step in which each block along the diagonal is eliminated.
  // In the order of elimination. In a column the diagonal block comes first, then those below it.
  std::vector<std::size_t> first;    ///< First block of each column; one more than columns.
  std::vector<std::size_t> row;      ///< Row of each block.
  std::vector<std::size_t> updated;  ///< The block that each pair of blocks of a column changes.
  std::vector<std::size_t> first_update;  ///< First entry of each column in `updated`.

 private:
  void find_order(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs);
  void find_updates();
  [[nodiscard]] std::size_t find(std::size_t in_row, std::size_t column) const;
};

}  // namespace firstcontact::detail
