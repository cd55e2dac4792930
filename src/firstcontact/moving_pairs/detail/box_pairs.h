/// @file
/// Walks pairs of boxes of two hierarchies: some boxes of one node with some of another.

#pragma once

#include <bit>
#include <cstdint>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>

namespace firstcontact::detail {

/// A node and some of its boxes.
struct NodeBoxes {
  std::uint32_t node = 0;
  unsigned used = 0;
};

/// All boxes of the root node.
inline NodeBoxes root(const Hierarchy& hierarchy) { return {0, hierarchy.nodes[0].used()}; }

/// The boxes inside box `slot` of a node; or that box alone, where `keep` is set.
inline NodeBoxes opened(const Hierarchy& hierarchy, std::uint32_t node, int slot, bool keep) {
  if (keep) {
    return {node, 1u << slot};
  }
  const std::uint32_t child = hierarchy.nodes[node].child_node(slot);
  return {child, hierarchy.nodes[child].used()};
}

/// The lanes 4 i + j for each used box i of one node and j of another.
inline std::uint16_t lanes_of(unsigned boxes_a, unsigned boxes_b) {
  // Bit i of A's boxes moves to bit 4 i, where the product puts B's.
  const unsigned spread =
      (boxes_a & 1u) | (boxes_a & 2u) << 3 | (boxes_a & 4u) << 6 | (boxes_a & 8u) << 9;
  return static_cast<std::uint16_t>(spread * boxes_b);
}

/// Two triangles, as indices in their hierarchies' order; or two sets of boxes.
struct BoxPair {
  bool is_triangle_pair = false;
  std::uint32_t triangle_A = 0;
  std::uint32_t triangle_B = 0;
  NodeBoxes A;
  NodeBoxes B;
};

/// Opens one lane: its two triangles, or the boxes inside its boxes.
///
/// Where one box is much larger than the other, only the larger one is opened.
inline BoxPair open_lane(const MovingPair& pair, std::uint32_t node_a, std::uint32_t node_b,
                         int lane, bool larger_a, bool larger_b) {
  const HierarchyNode& a = pair.A().nodes[node_a];
  const HierarchyNode& b = pair.B().nodes[node_b];
  const int i = lane / HierarchyNode::kWidth;
  const int j = lane % HierarchyNode::kWidth;
  const bool leaf_a = a.is_leaf(i);
  const bool leaf_b = b.is_leaf(j);
  if (leaf_a && leaf_b) {
    return {true, a.child_triangle(i), b.child_triangle(j), {}, {}};
  }
  return {false, 0, 0, opened(pair.A(), node_a, i, leaf_a || (!leaf_b && larger_b)),
          opened(pair.B(), node_b, j, leaf_b || (!leaf_a && larger_a))};
}

/// Opens pairs of boxes at one instant by lower bounds of their distance.
class BoxesAtInstant {
 public:
  BoxesAtInstant(const MovingPair& pair, const RelativeState& state)
      : pair_(pair), state_(state), frame_(pair.box_frame()) {
    pair.place(state, 0.0, frame_);
    frame_.horizon = 0.0f;
  }

  /// A pair of boxes.
  struct Lane {
    const BoxesAtInstant& boxes;
    const BoxBounds& bounds;
    std::uint32_t node_a;
    std::uint32_t node_b;
    int index;

    /// [m]  A lower bound of the distance of the boxes, in positions as computed from the state.
    [[nodiscard]] double gap() const {
      return static_cast<double>(bounds.gap[index]) * boxes.pair_.unit();
    }
    /// [m]  The same bound in double precision.
    [[nodiscard]] double precise_gap() const {
      const BoxId a{node_a, static_cast<std::uint32_t>(index / HierarchyNode::kWidth)};
      const BoxId b{node_b, static_cast<std::uint32_t>(index % HierarchyNode::kWidth)};
      return MovingPair::gap(boxes.pair_.place_A(boxes.state_, a),
                             boxes.pair_.place_B(boxes.state_, b));
    }
    /// [m]  The same bound in double precision, along the unit vector n only.
    [[nodiscard]] double gap_along(const Eigen::Vector3d& n) const {
      const BoxId a{node_a, static_cast<std::uint32_t>(index / HierarchyNode::kWidth)};
      const BoxId b{node_b, static_cast<std::uint32_t>(index % HierarchyNode::kWidth)};
      return MovingPair::gap_along(n, boxes.pair_.place_A(boxes.state_, a),
                                   boxes.pair_.place_B(boxes.state_, b));
    }
    /// The contents of the lane, as open_lane() has them.
    [[nodiscard]] BoxPair inside() const {
      return open_lane(boxes.pair_, node_a, node_b, index, (bounds.larger_a >> index & 1u) != 0,
                       (bounds.larger_b >> index & 1u) != 0);
    }
  };

  /// Calls use(lane) for each pair of boxes.
  template <class Use>
  void open(const NodeBoxes& a, const NodeBoxes& b, const Use& use) const {
    BoxBounds bounds;
    bound(a.node, b.node, bounds);
    for (unsigned lanes = lanes_of(a.used, b.used); lanes != 0; lanes &= lanes - 1) {
      use(Lane{*this, bounds, a.node, b.node, std::countr_zero(lanes)});
    }
  }

  /// Bounds the boxes of a pair of nodes.
  void bound(std::uint32_t a, std::uint32_t b, BoxBounds& bounds) const {
    pair_.bound(frame_, a, b, bounds);
  }
  /// Bounds the boxes of two pairs of nodes in less than twice the time.
  void bound(std::uint32_t a, std::uint32_t b, BoxBounds& bounds, std::uint32_t other_a,
             std::uint32_t other_b, BoxBounds& other_bounds) const {
    pair_.bound(frame_, a, b, bounds, other_a, other_b, other_bounds);
  }

 private:
  const MovingPair& pair_;
  const RelativeState& state_;
  BoxFrame frame_;
};

}  // namespace firstcontact::detail
