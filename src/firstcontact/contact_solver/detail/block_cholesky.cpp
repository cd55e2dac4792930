#include <firstcontact/contact_solver/detail/block_cholesky.h>

#include <algorithm>

#include <Eigen/Cholesky>

namespace firstcontact::detail {

using Eigen::VectorXd;

BlockCholesky::BlockCholesky(std::size_t count,
                             const std::vector<std::array<std::size_t, 2>>& pairs)
    : pattern_(count, pairs), blocks_(pattern_.blocks()) {}

void BlockCholesky::set_identity() {
  std::ranges::fill(blocks_, Block::Zero());
  for (std::size_t column = 0; column < pattern_.columns(); ++column) {
    blocks_[pattern_.first[column]].setIdentity();
  }
}

void BlockCholesky::factorise() {
  for (std::size_t column = 0; column < pattern_.columns(); ++column) {
    Block& diagonal = blocks_[pattern_.first[column]];
    const Block L = diagonal.llt().matrixL();
    diagonal.setIdentity();
    L.triangularView<Eigen::Lower>().solveInPlace(diagonal);
    const std::size_t begin = pattern_.first[column] + 1;
    const std::size_t end = pattern_.first[column + 1];
    for (std::size_t k = begin; k < end; ++k) {
      blocks_[k] = blocks_[k].lazyProduct(diagonal.transpose()).eval();
    }
    std::size_t update = pattern_.first_update[column];
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t i = k; i < end; ++i) {
        blocks_[pattern_.updated[update++]] -= blocks_[i].lazyProduct(blocks_[k].transpose());
      }
    }
  }
}

VectorXd BlockCholesky::solve(const VectorXd& right) const {
  const auto part = [](VectorXd& x, std::size_t step) {
    return x.segment<6>(static_cast<Eigen::Index>(6 * step));
  };
  VectorXd x(right.size());
  for (std::size_t i = 0; i < pattern_.columns(); ++i) {
    part(x, pattern_.step[i]) = right.segment<6>(static_cast<Eigen::Index>(6 * i));
  }
  for (std::size_t column = 0; column < pattern_.columns(); ++column) {
    auto own = part(x, column);
    own = (blocks_[pattern_.first[column]] * own).eval();
    for (std::size_t k = pattern_.first[column] + 1; k < pattern_.first[column + 1]; ++k) {
      part(x, pattern_.row[k]) -= blocks_[k] * own;
    }
  }
  for (std::size_t column = pattern_.columns(); column-- > 0;) {
    auto own = part(x, column);
    for (std::size_t k = pattern_.first[column] + 1; k < pattern_.first[column + 1]; ++k) {
      own -= blocks_[k].transpose() * part(x, pattern_.row[k]);
    }
    own = (blocks_[pattern_.first[column]].transpose() * own).eval();
  }
  VectorXd solved(right.size());
  for (std::size_t i = 0; i < pattern_.columns(); ++i) {
    solved.segment<6>(static_cast<Eigen::Index>(6 * i)) = part(x, pattern_.step[i]);
  }
  return solved;
}

}  // namespace firstcontact::detail
