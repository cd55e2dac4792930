#include <firstcontact/dynamics/detail/block_cholesky.h>

#include <algorithm>
#include <iterator>
#include <queue>
#include <utility>

#include <Eigen/Cholesky>

namespace firstcontact::detail {
namespace {

using Eigen::VectorXd;
using Degree = std::pair<std::size_t, std::size_t>;  // Of a block, and its number.

/// Those connected with each, sorted.
std::vector<std::vector<std::size_t>> neighbours(
    std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs) {
  std::vector<std::vector<std::size_t>> all(count);
  for (const auto& [i, j] : pairs) {
    if (i != j) {
      all[i].push_back(j);
      all[j].push_back(i);
    }
  }
  for (auto& of : all) {
    std::ranges::sort(of);
    of.erase(std::unique(of.begin(), of.end()), of.end());
  }
  return all;
}

}  // namespace

BlockCholesky::BlockCholesky(std::size_t count,
                             const std::vector<std::array<std::size_t, 2>>& pairs)
    : step_(count) {
  find_order(count, pairs);
  find_updates();
  blocks_.resize(row_.size());
}

void BlockCholesky::find_order(std::size_t count,
                               const std::vector<std::array<std::size_t, 2>>& pairs) {
  std::vector<std::vector<std::size_t>> left = neighbours(count, pairs);
  std::vector<bool> is_done(count, false);
  std::priority_queue<Degree, std::vector<Degree>, std::greater<>> queue;
  for (std::size_t i = 0; i < count; ++i) {
    queue.emplace(left[i].size(), i);
  }
  std::vector<std::size_t> order;
  std::vector<std::size_t> merged;
  while (!queue.empty()) {
    const auto [degree, i] = queue.top();
    queue.pop();
    if (is_done[i] || degree != left[i].size()) {
      continue;  // Out of date.
    }
    is_done[i] = true;
    step_[i] = order.size();
    order.push_back(i);
    // What is connected with it becomes connected with each other.
    for (const std::size_t k : left[i]) {
      merged.clear();
      std::ranges::set_union(left[k], left[i], std::back_inserter(merged));
      std::erase_if(merged, [i = i, k](std::size_t other) { return other == i || other == k; });
      left[k] = merged;
      queue.emplace(left[k].size(), k);
    }
  }
  for (const std::size_t i : order) {
    first_.push_back(row_.size());
    row_.push_back(step_[i]);
    for (const std::size_t k : left[i]) {
      row_.push_back(step_[k]);
    }
    std::sort(row_.begin() + static_cast<std::ptrdiff_t>(first_.back()), row_.end());
  }
  first_.push_back(row_.size());
}

void BlockCholesky::find_updates() {
  for (std::size_t column = 0; column + 1 < first_.size(); ++column) {
    first_update_.push_back(updated_.size());
    for (std::size_t k = first_[column] + 1; k < first_[column + 1]; ++k) {
      for (std::size_t i = k; i < first_[column + 1]; ++i) {
        updated_.push_back(find(row_[i], row_[k]));
      }
    }
  }
}

std::size_t BlockCholesky::find(std::size_t row, std::size_t column) const {
  const auto begin = row_.begin();
  const auto found = std::lower_bound(begin + static_cast<std::ptrdiff_t>(first_[column]),
                                      begin + static_cast<std::ptrdiff_t>(first_[column + 1]), row);
  return static_cast<std::size_t>(found - begin);
}

BlockCholesky::Place BlockCholesky::place(std::size_t i, std::size_t j) const {
  const bool is_turned = step_[i] < step_[j];
  return {is_turned ? find(step_[j], step_[i]) : find(step_[i], step_[j]), is_turned};
}

void BlockCholesky::set_identity() {
  std::ranges::fill(blocks_, Block::Zero());
  for (std::size_t column = 0; column + 1 < first_.size(); ++column) {
    blocks_[first_[column]].setIdentity();
  }
}

void BlockCholesky::factorise() {
  for (std::size_t column = 0; column + 1 < first_.size(); ++column) {
    Block& diagonal = blocks_[first_[column]];
    diagonal = Block(diagonal.llt().matrixL());
    const std::size_t begin = first_[column] + 1;
    const std::size_t end = first_[column + 1];
    for (std::size_t k = begin; k < end; ++k) {
      diagonal.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(
          blocks_[k]);
    }
    std::size_t update = first_update_[column];
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t i = k; i < end; ++i) {
        blocks_[updated_[update++]].noalias() -= blocks_[i] * blocks_[k].transpose();
      }
    }
  }
}

VectorXd BlockCholesky::solve(const VectorXd& right) const {
  const auto part = [](VectorXd& x, std::size_t step) {
    return x.segment<6>(static_cast<Eigen::Index>(6 * step));
  };
  VectorXd x(right.size());
  for (std::size_t i = 0; i < step_.size(); ++i) {
    part(x, step_[i]) = right.segment<6>(static_cast<Eigen::Index>(6 * i));
  }
  for (std::size_t column = 0; column + 1 < first_.size(); ++column) {
    auto own = part(x, column);
    blocks_[first_[column]].triangularView<Eigen::Lower>().solveInPlace(own);
    for (std::size_t k = first_[column] + 1; k < first_[column + 1]; ++k) {
      part(x, row_[k]) -= blocks_[k] * own;
    }
  }
  for (std::size_t column = first_.size() - 1; column-- > 0;) {
    auto own = part(x, column);
    for (std::size_t k = first_[column] + 1; k < first_[column + 1]; ++k) {
      own -= blocks_[k].transpose() * part(x, row_[k]);
    }
    blocks_[first_[column]].triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  VectorXd solved(right.size());
  for (std::size_t i = 0; i < step_.size(); ++i) {
    solved.segment<6>(static_cast<Eigen::Index>(6 * i)) = part(x, step_[i]);
  }
  return solved;
}

}  // namespace firstcontact::detail
