/// @file
/// Overlapping boxes among many.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

namespace firstcontact::detail {

/// A tree over boxes, halved at the median centre along the longest side.
class OverlapTree {
 public:
  explicit OverlapTree(const std::vector<Eigen::AlignedBox3d>& boxes);

  /// Calls use(k) for each box that overlaps or touches the given one. The order depends on the
  /// tree's boxes alone.
  template <class Use>
  void for_each_overlap(const Eigen::AlignedBox3d& box, const Use& use) const {
    for (std::size_t n = 0; n < nodes_.size();) {
      const Node& node = nodes_[n];
      if (!node.box.intersects(box)) {
        n = node.after;
        continue;
      }
      for (std::size_t i = node.begin; i < node.end; ++i) {
        if (items_[i].box.intersects(box)) {
          use(items_[i].index);
        }
      }
      ++n;
    }
  }

  /// Calls use(a, b), a < b, for each two of the tree's boxes that overlap or touch.
  template <class Use>
  void for_each_pair(const Use& use) const {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Node& leaf = nodes_[n];
      for (std::size_t i = leaf.begin; i < leaf.end; ++i) {
        use_overlaps(items_[i], i + 1, leaf.end, use);
      }
      // Leaves that follow; inner nodes hold no items.
      for (std::size_t other = n + 1; leaf.end > leaf.begin && other < nodes_.size();) {
        const Node& node = nodes_[other];
        if (!node.box.intersects(leaf.box)) {
          other = node.after;
          continue;
        }
        for (std::size_t i = leaf.begin; i < leaf.end && node.end > node.begin; ++i) {
          use_overlaps(items_[i], node.begin, node.end, use);
        }
        ++other;
      }
    }
  }

 private:
  struct Item {
    Eigen::AlignedBox3d box;
    std::size_t index = 0;
  };
  /// A node of the tree. Its children follow it. A leaf holds items_[begin, end), other nodes none.
  struct Node {
    Eigen::AlignedBox3d box;
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t after = 0;  // The node that follows its subtree.
  };
  void build(std::size_t begin, std::size_t end);

  /// Calls use for the overlaps of one item with items [begin, end).
  template <class Use>
  void use_overlaps(const Item& item, std::size_t begin, std::size_t end, const Use& use) const {
    for (std::size_t i = begin; i < end; ++i) {
      if (items_[i].box.intersects(item.box)) {
        use(std::min(item.index, items_[i].index), std::max(item.index, items_[i].index));
      }
    }
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

/// Finds all overlapping pairs {a, b}, a < b, sorted.
[[nodiscard]] std::vector<std::array<std::size_t, 2>> overlapping_pairs(
    const std::vector<Eigen::AlignedBox3d>& boxes);

}  // namespace firstcontact::detail
