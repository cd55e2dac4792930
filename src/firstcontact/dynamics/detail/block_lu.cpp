#include <firstcontact/dynamics/detail/block_lu.h>

#include <algorithm>

#include <Eigen/LU>

namespace firstcontact::detail {

using Eigen::VectorXd;

BlockLu::BlockLu(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs)
    : pattern_(count, pairs), lower_(pattern_.blocks()), upper_(pattern_.blocks()) {}

void BlockLu::set_identity() {
  std::ranges::fill(lower_, Block::Zero());
  std::ranges::fill(upper_, Block::Zero());
  for (std::size_t column = 0; column < pattern_.columns(); ++column) {
    lower_[pattern_.first[column]].setIdentity();
  }
}

void BlockLu::factorise() {
  for (std::size_t column = 0; column < pattern_.columns(); ++column) {
    Block& diagonal = lower_[pattern_.first[column]];
    diagonal = diagonal.inverse().eval();
    const std::size_t begin = pattern_.first[column] + 1;
    const std::size_t end = pattern_.first[column + 1];
    for (std::size_t k = begin; k < end; ++k) {
      lower_[k] = (lower_[k] * diagonal).eval();
    }
    std::size_t update = pattern_.first_update[column];
    for (std::size_t k = begin; k < end; ++k) {
      lower_[pattern_.updated[update++]].noalias() -= lower_[k] * upper_[k];
      for (std::size_t i = k + 1; i < end; ++i, ++update) {
        lower_[pattern_.updated[update]].noalias() -= lower_[i] * upper_[k];
        upper_[pattern_.updated[update]].noalias() -= lower_[k] * upper_[i];
      }
    }
  }
}

VectorXd BlockLu::solve(const VectorXd& right) const {
  const auto part = [](VectorXd& x, std::size_t step) {
    return x.segment<6>(static_cast<Eigen::Index>(6 * step));
  };
  VectorXd x(right.size());
  for (std::size_t i = 0; i < pattern_.columns(); ++i) {
    part(x, pattern_.step[i]) = right.segment<6>(static_cast<Eigen::Index>(6 * i));
  }
  for (std::size_t column = 0; column < pattern_.columns(); ++column) {
    for (std::size_t k = pattern_.first[column] + 1; k < pattern_.first[column + 1]; ++k) {
      part(x, pattern_.row[k]) -= lower_[k] * part(x, column);
    }
  }
  for (std::size_t column = pattern_.columns(); column-- > 0;) {
    auto own = part(x, column);
    for (std::size_t k = pattern_.first[column] + 1; k < pattern_.first[column + 1]; ++k) {
      own -= upper_[k] * part(x, pattern_.row[k]);
    }
    own = (lower_[pattern_.first[column]] * own).eval();
  }
  VectorXd solved(right.size());
  for (std::size_t i = 0; i < pattern_.columns(); ++i) {
    solved.segment<6>(static_cast<Eigen::Index>(6 * i)) = part(x, pattern_.step[i]);
  }
  return solved;
}

}  // namespace firstcontact::detail
