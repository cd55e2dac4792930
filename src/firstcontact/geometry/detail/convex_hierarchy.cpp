#include <firstcontact/geometry/detail/convex_hierarchy.h>

#include <algorithm>
#include <cmath>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Finds the middle of the core along the axes of its frame.
Vector3d middle_of(const ConvexCore& core) {
  Vector3d middle;
  for (int k = 0; k < 3; ++k) {
    middle[k] =
        0.5 * (core.support_bound(Vector3d::Unit(k)) - core.support_bound(-Vector3d::Unit(k)));
  }
  return middle;
}

/// Finds the axis along which the core is longest.
int longest_axis(const ConvexCore& core) {
  int longest = 2;
  double most = 0.0;
  for (const int k : {2, 1, 0}) {
    const double length =
        core.support_bound(Vector3d::Unit(k)) + core.support_bound(-Vector3d::Unit(k));
    if (length > most) {
      most = length;
      longest = k;
    }
  }
  return longest;
}

}  // namespace

Hierarchy convex_hierarchy(const ConvexCore& core, const Vector3d& centre) {
  Hierarchy hierarchy;
  hierarchy.centre = centre;
  hierarchy.radius = core.reach;
  hierarchy.unit = core.reach > 0.0 ? std::exp2(std::ceil(std::log2(core.reach))) : 1.0;
  HierarchyNode node{};
  node.node_base_and_used = 1u;
  node.triangle_base_and_leaf = 1u;
  const Vector3d middle = middle_of(core) / hierarchy.unit;
  for (int k = 0; k < 3; ++k) {
    node.centre[k][0] = static_cast<float>(middle[k]);
  }
  // The longest extent comes last: a quarter turn about another axis brings it there.
  constexpr float kQuarterTurn = 0.70710677f;
  const int longest = longest_axis(core);
  if (longest != 2) {
    node.rotation[1 - longest][0] = kQuarterTurn;
  }
  const Eigen::Matrix3d axes = box_axes(node, 0);
  const Vector3d placed(node.centre[0][0], node.centre[1][0], node.centre[2][0]);
  for (int k = 0; k < 3; ++k) {
    const Vector3d axis = axes.row(k).transpose();
    const double shift = axis.dot(placed);
    const double extent = std::max(core.support_bound(axis) / hierarchy.unit - shift,
                                   core.support_bound(-axis) / hierarchy.unit + shift);
    // 2^-46 covers the axes (2^-50) and this arithmetic, all of it below 4.
    node.extent[k][0] = HierarchyNode::extent_code(extent + 0x1p-46);
  }
  hierarchy.nodes = {node};
  hierarchy.vertices = {Vector3d::Zero()};
  hierarchy.triangles = {{0, 0, 0}};
  hierarchy.vertex_index = {0};
  hierarchy.triangle_index = {0};
  return hierarchy;
}

}  // namespace firstcontact::detail
