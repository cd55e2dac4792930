#include <firstcontact/many_bodies/detail/box_join.h>

#include <algorithm>

namespace firstcontact::detail {
namespace {

constexpr std::uint32_t kLeafSize = 8;

}  // namespace

bool BoxJoin::join(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t most,
                   std::vector<BodyPair>& pairs) {
  items_.clear();
  nodes_.clear();
  for (std::uint32_t k = 0; k < boxes.size(); ++k) {
    items_.push_back({boxes[k], k});
  }
  if (items_.empty()) {
    return true;
  }
  build(0, static_cast<std::uint32_t>(items_.size()));
  pairs_ = &pairs;
  most_ = pairs.size() + most;
  return join_within(0);
}

void BoxJoin::build(std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.begin = begin;
  node.end = end;
  Eigen::AlignedBox3d centres;
  for (std::uint32_t k = begin; k < end; ++k) {
    node.box.extend(items_[k].box);
    centres.extend(items_[k].box.center());
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) {
    return;
  }
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const auto order = [axis](const Item& x, const Item& y) {
    const double cx = x.box.min()[axis] + x.box.max()[axis];
    const double cy = y.box.min()[axis] + y.box.max()[axis];
    return cx < cy || (cx == cy && x.index < y.index);
  };
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, order);
  build(begin, middle);
  nodes_[index].second = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

bool BoxJoin::test(const Item& a, const Item& b) {
  if (a.box.intersects(b.box)) {
    if (pairs_->size() == most_) {
      return false;
    }
    pairs_->push_back({std::min(a.index, b.index), std::max(a.index, b.index)});
  }
  return true;
}

bool BoxJoin::join_within(std::uint32_t index) {
  const Node& node = nodes_[index];
  if (node.second != 0) {
    return join_within(index + 1) && join_within(node.second) && join_both(index + 1, node.second);
  }
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    for (std::uint32_t j = i + 1; j < node.end; ++j) {
      if (!test(items_[i], items_[j])) {
        return false;
      }
    }
  }
  return true;
}

bool BoxJoin::join_both(std::uint32_t index_a, std::uint32_t index_b) {
  const Node& a = nodes_[index_a];
  const Node& b = nodes_[index_b];
  if (!a.box.intersects(b.box)) {
    return true;
  }
  // Opens the larger one; where one is a leaf, the other.
  const bool a_larger = a.box.sizes().squaredNorm() >= b.box.sizes().squaredNorm();
  if (a.second != 0 && (a_larger || b.second == 0)) {
    return join_both(index_a + 1, index_b) && join_both(a.second, index_b);
  }
  if (b.second != 0) {
    return join_both(index_a, index_b + 1) && join_both(index_a, b.second);
  }
  for (std::uint32_t i = a.begin; i < a.end; ++i) {
    if (!items_[i].box.intersects(b.box)) {
      continue;
    }
    for (std::uint32_t j = b.begin; j < b.end; ++j) {
      if (!test(items_[i], items_[j])) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace firstcontact::detail
