#include <firstcontact/geometry/detail/overlap_tree.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kLeafSize = 4;

}  // namespace

OverlapTree::OverlapTree(const std::vector<Eigen::AlignedBox3d>& boxes) {
  items_.reserve(boxes.size());
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    items_.push_back({boxes[k], k});
  }
  if (!items_.empty()) {
    nodes_.reserve(boxes.size());
    build(0, items_.size());
  }
}

void OverlapTree::build(std::size_t begin, std::size_t end) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d box;
  Eigen::AlignedBox3d centres;
  for (std::size_t k = begin; k < end; ++k) {
    box.extend(items_[k].box);
    centres.extend(items_[k].box.center());
  }
  nodes_[node].box = box;
  if (end - begin <= kLeafSize) {
    nodes_[node].begin = begin;
    nodes_[node].end = end;
  } else {
    Eigen::Index axis = 0;
    (void)centres.sizes().maxCoeff(&axis);
    const auto key = [axis](const Item& item) {
      return std::pair(item.box.min()[axis] + item.box.max()[axis], item.index);
    };
    const std::size_t middle = begin + (end - begin) / 2;
    Item* const items = items_.data();
    std::ranges::nth_element(items + begin, items + middle, items + end, {}, key);
    build(begin, middle);
    build(middle, end);
  }
  nodes_[node].after = nodes_.size();
}

std::vector<std::array<std::size_t, 2>> overlapping_pairs(
    const std::vector<Eigen::AlignedBox3d>& boxes) {
  using Pair = std::array<std::size_t, 2>;
  std::vector<Pair> found;
  OverlapTree(boxes).for_each_pair([&](std::size_t a, std::size_t b) { found.push_back({a, b}); });
  // Sorted by rows of the same first box; rows are short.
  std::vector<std::size_t> row(boxes.size() + 1, 0);
  for (const Pair& pair : found) {
    ++row[pair[0] + 1];
  }
  std::partial_sum(row.begin(), row.end(), row.begin());
  std::vector<std::size_t> next = row;
  std::vector<Pair> pairs(found.size());
  for (const Pair& pair : found) {
    pairs[next[pair[0]]++] = pair;
  }
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    std::sort(pairs.data() + row[a], pairs.data() + row[a + 1]);
  }
  return pairs;
}

}  // namespace firstcontact::detail
