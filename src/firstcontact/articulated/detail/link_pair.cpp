#include <firstcontact/articulated/detail/link_pair.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <firstcontact/math/root_isolation.h>
#include <firstcontact/narrowphase/separating_direction.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kUp = 1.0 + 0x1p-44;

/// At most of length 1, as LinkWindow asks; zero stays zero.
Vector3d direction(const Vector3d& v) {
  const double length = v.norm();
  return length > 0.0 ? Vector3d(v * ((1.0 - 0x1p-49) / length)) : Vector3d(Vector3d::Zero());
}

LinkPart part_of(const Hierarchy& hierarchy, LinkBox box) {
  const HierarchyNode& node = hierarchy.nodes[box.node];
  LinkPart part;
  for (int k = 0; k < 3; ++k) {
    part.centre[k] = static_cast<double>(node.centre[k][box.slot]) * hierarchy.unit;
    part.half_extents[k] = static_cast<double>(node.half_extent(k, box.slot)) * hierarchy.unit;
  }
  part.axes = box_axes(node, box.slot);
  // The axes are rounded to 2^-50.
  part.half_extents.array() += 0x1p-47 * part.half_extents.sum();
  return part;
}

/// A box in the frame of the windows.
struct Placed {
  Vector3d centre;
  Eigen::Matrix3d axes;
};

Placed place_box(const LinkPart& part, const LinkPose& pose) {
  return {pose.p_OL + pose.R_FL * part.centre, part.axes * pose.R_FL.transpose()};
}

double extent(const LinkPart& part, const Placed& placed, const Vector3d& n) {
  return part.half_extents.dot((placed.axes * n).cwiseAbs());
}

DirectedBound sum(const DirectedBound& a, const DirectedBound& b) {
  return {a.speed + b.speed, a.acceleration + b.acceleration};
}

/// Bounds are sums of a few rounded numbers, which may cancel.
double time_until(double gap, const DirectedBound& a, const DirectedBound& b) {
  const DirectedBound closing = sum(a, b);
  const double slip = 0x1p-50 * (std::abs(a.speed) + std::abs(b.speed));
  const double bend = 0x1p-50 * (std::abs(a.acceleration) + std::abs(b.acceleration));
  // A gap that opens ever faster is taken to open at its present rate.
  return time_to_close(gap, closing.speed + slip, 0.5 * std::max(closing.acceleration + bend, 0.0));
}

}  // namespace

LinkPair::LinkPair(const Hierarchy& A, const Hierarchy& B, const LinkWindow& at_A,
                   const LinkWindow& at_B)
    : A_(A), B_(B), at_A_(at_A), at_B_(at_B) {
  const LinkPose& a = at_A.pose();
  const LinkPose& b = at_B.pose();
  // Vertices are rounded when they are centred; placing, subtracting and the product with n add
  // some roundings of the sizes.
  const double size = A.radius + B.radius + a.p_OL.norm() + b.p_OL.norm();
  gap_error_ = kUp * (a.position_error + b.position_error + a.rotation_error * A.radius +
                      b.rotation_error * B.radius + 64.0 * 0x1p-53 * size);
}

double LinkPair::radius(const Hierarchy& hierarchy, LinkBox box) {
  return part_of(hierarchy, box).reach();
}

double LinkPair::balls_apart(double threshold) const {
  const LinkPart a{.radius = A_.radius * kUp};
  const LinkPart b{.radius = B_.radius * kUp};
  const Vector3d apart = at_B_.pose().p_OL - at_A_.pose().p_OL;
  const Vector3d n = direction(apart);
  const double gap = n.dot(apart) - a.radius - b.radius - threshold - gap_error_;
  return time_until(gap, at_A_.displacement(a, n), at_B_.displacement(b, Vector3d(-n)));
}

Separation LinkPair::boxes(LinkBox box_a, LinkBox box_b, double threshold) const {
  const LinkPart a = part_of(A_, box_a);
  const LinkPart b = part_of(B_, box_b);
  const Placed at_a = place_box(a, at_A_.pose());
  const Placed at_b = place_box(b, at_B_.pose());
  const Vector3d apart = at_b.centre - at_a.centre;
  std::array<Vector3d, 7> directions;
  directions[0] = apart;
  for (std::size_t k = 0; k < 3; ++k) {
    directions[1 + k] = at_a.axes.row(static_cast<Eigen::Index>(k)).transpose();
    directions[4 + k] = at_b.axes.row(static_cast<Eigen::Index>(k)).transpose();
  }
  Separation best{-std::numeric_limits<double>::infinity(), 0.0};
  for (const Vector3d& any : directions) {
    const Vector3d n = direction(apart.dot(any) < 0.0 ? Vector3d(-any) : any);
    const double gap =
        n.dot(apart) - extent(a, at_a, n) - extent(b, at_b, n) - threshold - gap_error_;
    best.gap = std::max(best.gap, gap);
    if (gap > 0.0) {
      best.time = std::max(best.time, time_until(gap, at_A_.displacement(a, n),
                                                 at_B_.displacement(b, Vector3d(-n))));
    }
  }
  return best;
}

Triangle LinkPair::place(const Hierarchy& hierarchy, const LinkPose& pose,
                         std::uint32_t triangle) const {
  Triangle placed;
  for (std::size_t k = 0; k < 3; ++k) {
    placed[k] = pose.p_OL + pose.R_FL * hierarchy.vertices[hierarchy.triangles[triangle][k]];
  }
  return placed;
}

ClosestFeatures LinkPair::distance(std::uint32_t a, std::uint32_t b) const {
  return triangle_distance(place(A_, at_A_.pose(), a), place(B_, at_B_.pose(), b));
}

double LinkPair::triangles_apart(std::uint32_t a, std::uint32_t b, const ClosestFeatures& closest,
                                 double threshold) const {
  const TrianglePair pair{place(A_, at_A_.pose(), a), place(B_, at_B_.pose(), b)};
  const Vector3d apart = closest.p_B - closest.p_A;
  double best = 0.0;
  for (const Vector3d& any : {apart, separating_direction(pair, closest)}) {
    const Vector3d n = direction(apart.dot(any) < 0.0 ? Vector3d(-any) : any);
    best = std::max(best, time_apart(pair.A, pair.B, a, b, n, threshold));
  }
  return best;
}

/// A triangle lies beyond a plane exactly if its corners do: the least time over the nine pairs.
double LinkPair::time_apart(const Triangle& a, const Triangle& b, std::uint32_t index_a,
                            std::uint32_t index_b, const Vector3d& n, double threshold) const {
  std::array<DirectedBound, 3> closing_a;
  std::array<DirectedBound, 3> closing_b;
  for (std::size_t k = 0; k < 3; ++k) {
    closing_a[k] = at_A_.displacement({.centre = A_.vertices[A_.triangles[index_a][k]]}, n);
    closing_b[k] =
        at_B_.displacement({.centre = B_.vertices[B_.triangles[index_b][k]]}, Vector3d(-n));
  }
  double time = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double gap = n.dot(b[j] - a[i]) - threshold - gap_error_;
      time = std::min(time, time_until(gap, closing_a[i], closing_b[j]));
    }
  }
  return time;
}

}  // namespace firstcontact::detail
