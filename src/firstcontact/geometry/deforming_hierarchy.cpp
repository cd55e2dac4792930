#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d centre_of(const HierarchyNode& node, int slot) {
  return {static_cast<double>(node.centre[0][slot]), static_cast<double>(node.centre[1][slot]),
          static_cast<double>(node.centre[2][slot])};
}

Vector3d extent_of(const HierarchyNode& node, int slot) {
  return {static_cast<double>(node.half_extent(0, slot)),
          static_cast<double>(node.half_extent(1, slot)),
          static_cast<double>(node.half_extent(2, slot))};
}

/// Stores a box: rounds the centre, and makes the extents larger by as much.
///
/// @param slack  covers all other roundings
void store(const Vector3d& centre, const Vector3d& extent, double slack, int slot,
           HierarchyNode& node) {
  for (int k = 0; k < 3; ++k) {
    node.centre[k][slot] = static_cast<float>(centre[k]);
  }
  const double shift = (centre_of(node, slot) - centre).norm();
  for (int k = 0; k < 3; ++k) {
    node.extent[k][slot] = HierarchyNode::extent_code(extent[k] + shift + slack);
  }
}

/// A range of triangles in the hierarchy's order, from first to before last. Those of a subtree are
/// neighbours.
struct Range {
  std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t last = 0;

  void extend(const Range& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
};

/// Fits boxes with unchanged axes around vertices that have moved.
class Refit {
 public:
  Refit(const Hierarchy& hierarchy, std::vector<HierarchyNode>& nodes)
      : hierarchy_(hierarchy), nodes_(nodes), scale_(1.0 / hierarchy.unit) {}

  Range node(std::uint32_t index) {
    Range all;
    const unsigned used = nodes_[index].used();
    for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
      if ((used >> slot & 1u) == 0) {
        continue;
      }
      HierarchyNode& box = nodes_[index];
      const Range range = box.is_leaf(slot)
                              ? Range{box.child_triangle(slot), box.child_triangle(slot) + 1}
                              : node(box.child_node(slot));
      fit(range, slot, box);
      all.extend(range);
    }
    return all;
  }

 private:
  void fit(const Range& range, int slot, HierarchyNode& node) const {
    const Matrix3d axes = box_axes(node, slot);
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d high = -low;
    for (std::uint32_t k = range.first; k < range.last; ++k) {
      for (const std::uint32_t v : hierarchy_.triangles[k]) {
        const Vector3d q = axes * (hierarchy_.vertices_to[v] * scale_);
        low = low.cwiseMin(q);
        high = high.cwiseMax(q);
      }
    }
    // 2^-47 covers the axes (2^-50, and their inverse), the vertices and these products, all below
    // 2.
    store(axes.transpose() * (0.5 * (low + high)), 0.5 * (high - low), 0x1p-47, slot, node);
  }

  const Hierarchy& hierarchy_;
  std::vector<HierarchyNode>& nodes_;
  double scale_;
};

/// Expresses the boxes of a hierarchy in a larger unit; a power of two, so that only extents are
/// rounded.
void shrink(double ratio, std::vector<HierarchyNode>& nodes) {
  for (HierarchyNode& node : nodes) {
    for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
      store(ratio * centre_of(node, slot), ratio * extent_of(node, slot), 0x1p-60, slot, node);
    }
  }
}

}  // namespace

Hierarchy deforming_hierarchy(const Hierarchy& rest, std::vector<Vector3d> to) {
  Hierarchy hierarchy = rest;
  double radius = 0.0;
  double speed = 0.0;
  for (std::size_t v = 0; v < to.size(); ++v) {
    radius = std::max(radius, to[v].norm());
    speed = std::max(speed, (to[v] - rest.vertices[v]).norm());
  }
  hierarchy.radius = std::max(rest.radius, radius * (1.0 + 0x1p-48));
  hierarchy.deformation_speed = speed * (1.0 + 0x1p-48) + 0x1p-50 * hierarchy.radius;
  hierarchy.vertices_to = std::move(to);
  if (hierarchy.radius > rest.unit) {
    hierarchy.unit = std::exp2(std::ceil(std::log2(hierarchy.radius)));
    shrink(rest.unit / hierarchy.unit, hierarchy.nodes);
  }
  hierarchy.nodes_to = hierarchy.nodes;
  Refit(hierarchy, hierarchy.nodes_to).node(0);
  return hierarchy;
}

const HierarchyNode& Hierarchy::node(std::uint32_t index, double t, HierarchyNode& scratch) const {
  const HierarchyNode& from = nodes[index];
  if (!deforms()) {
    return from;
  }
  scratch = from;
  const HierarchyNode& to = nodes_to[index];
  for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
    // Four roundings of numbers below 2.
    store((1.0 - t) * centre_of(from, slot) + t * centre_of(to, slot),
          (1.0 - t) * extent_of(from, slot) + t * extent_of(to, slot), 0x1p-49, slot, scratch);
  }
  return scratch;
}

}  // namespace firstcontact
