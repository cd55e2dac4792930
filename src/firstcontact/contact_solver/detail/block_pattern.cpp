#include <firstcontact/contact_solver/detail/block_pattern.h>

#include <algorithm>
#include <iterator>
#include <queue>
#include <utility>

namespace firstcontact::detail {
namespace {

using Degree = std::pair<std::size_t, std::size_t>;  // Degree of a block, and its number.

/// Lists the blocks that are connected with each block, sorted.
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

BlockPattern::BlockPattern(std::size_t count, const std::vector<std::array<std::size_t, 2>>& pairs)
    : step(count) {
  find_order(count, pairs);
  find_updates();
}

void BlockPattern::find_order(std::size_t count,
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
      continue;  // An outdated entry.
    }
    is_done[i] = true;
    step[i] = order.size();
    order.push_back(i);
    // All neighbours of the eliminated block become connected with each other.
    for (const std::size_t k : left[i]) {
      merged.clear();
      std::ranges::set_union(left[k], left[i], std::back_inserter(merged));
      std::erase_if(merged, [i = i, k](std::size_t other) { return other == i || other == k; });
      left[k] = merged;
      queue.emplace(left[k].size(), k);
    }
  }
  for (const std::size_t i : order) {
    first.push_back(row.size());
    row.push_back(step[i]);
    for (const std::size_t k : left[i]) {
      row.push_back(step[k]);
    }
    std::sort(row.begin() + static_cast<std::ptrdiff_t>(first.back()), row.end());
  }
  first.push_back(row.size());
}

void BlockPattern::find_updates() {
  for (std::size_t column = 0; column + 1 < first.size(); ++column) {
    first_update.push_back(updated.size());
    for (std::size_t k = first[column] + 1; k < first[column + 1]; ++k) {
      for (std::size_t i = k; i < first[column + 1]; ++i) {
        updated.push_back(find(row[i], row[k]));
      }
    }
  }
}

std::size_t BlockPattern::find(std::size_t in_row, std::size_t column) const {
  const auto begin = row.begin();
  const auto found =
      std::lower_bound(begin + static_cast<std::ptrdiff_t>(first[column]),
                       begin + static_cast<std::ptrdiff_t>(first[column + 1]), in_row);
  return static_cast<std::size_t>(found - begin);
}

BlockPattern::Place BlockPattern::place(std::size_t i, std::size_t j) const {
  const bool is_turned = step[i] < step[j];
  return {is_turned ? find(step[j], step[i]) : find(step[i], step[j]), is_turned};
}

}  // namespace firstcontact::detail
