/// @file
/// Finds all pairs of boxes that overlap.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/many_bodies/pair_rules.h>

namespace firstcontact::detail {

/// A tree over boxes, joined with itself to find the boxes that overlap.
///
/// It is halved at the median centre along the longest side. For boxes of any sizes that overlap
/// few others this takes O(n log n + pairs).
class BoxJoin {
 public:
  /// Appends the overlapping pairs, touching ones included. Their order depends on the boxes alone.
  /// Returns false where there are more than `most`; then some are missing.
  bool join(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t most,
            std::vector<BodyPair>& pairs);

 private:
  /// A node of the tree. Its boxes are items_[begin, end). The first child follows it; a leaf has
  /// no second one.
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t second = 0;
  };
  struct Item {
    Eigen::AlignedBox3d box;
    std::uint32_t index = 0;
  };

  void build(std::uint32_t begin, std::uint32_t end);
  bool join_within(std::uint32_t node);
  bool join_both(std::uint32_t a, std::uint32_t b);
  bool test(const Item& a, const Item& b);

  std::vector<Item> items_;
  std::vector<Node> nodes_;
  std::vector<BodyPair>* pairs_ = nullptr;
  std::size_t most_ = 0;
};

}  // namespace firstcontact::detail
