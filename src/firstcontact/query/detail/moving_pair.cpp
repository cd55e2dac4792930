#include <firstcontact/query/detail/moving_pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

PlacedBox place(const Hierarchy& hierarchy, BoxId box, const Matrix3d& R, const Vector3d& origin,
                const Vector3d& pivot) {
  PlacedBox placed;
  const HierarchyNode& node = hierarchy.nodes[box.node];
  const auto slot = static_cast<int>(box.slot);
  Vector3d centre;
  for (int k = 0; k < 3; ++k) {
    centre[k] = static_cast<double>(node.centre[k][slot]);
    placed.extent[k] = static_cast<double>(node.half_extent(k, slot)) * hierarchy.unit;
  }
  placed.centre = origin + R * (centre * hierarchy.unit);
  placed.axes = box_axes(node, slot) * R.transpose();
  placed.radius = placed.extent.norm();
  placed.is_triangle = node.is_leaf(slot);
  if (placed.is_triangle) {
    const auto& corners = hierarchy.triangles[node.child_triangle(slot)];
    for (int k = 0; k < 3; ++k) {
      placed.corners.row(k) =
          (origin + R * hierarchy.vertices[corners[k]] - placed.centre).transpose();
    }
  }
  placed.reach = ((placed.centre - pivot).norm() + placed.radius) * (1.0 + 0x1p-48);
  return placed;
}

/// How far the box reaches from its centre.
double extent_along(const PlacedBox& box, const Vector3d& n) {
  return box.is_triangle ? (box.corners * n).maxCoeff() : box.extent.dot((box.axes * n).cwiseAbs());
}

/// The extent of a whole shape is its radius in every direction.
struct Separation {
  Vector3d n;  // from A to B
  double gap;
};

template <class Use>
void for_each_direction(const PlacedBox& a, const PlacedBox& b, const Use& use) {
  const Vector3d d = b.centre - a.centre;
  const auto consider = [&](Vector3d n) {
    double along = n.dot(d);
    if (along < 0.0) {
      n = -n;
      along = -along;
    }
    use(Separation{n, along - extent_along(a, n) - extent_along(b, -n)});
  };
  const double length = d.norm();
  if (length > 0.0) {
    consider(d / length);
  }
  for (int k = 0; k < 3; ++k) {
    consider(a.axes.row(k).transpose());
    consider(b.axes.row(k).transpose());
  }
}

}  // namespace

MovingPair::MovingPair(const Hierarchy& A, const Hierarchy& B, const RelativeMotion& motion)
    : A_(A),
      B_(B),
      motion_(motion),
      speed_bound_((motion.pivot_velocity().norm() +
                    motion.A().rate() * (motion.A().lever_length() + A.radius) +
                    motion.B().rate() * (motion.B().lever_length() + B.radius)) *
                   (1.0 + 0x1p-40)) {}

double MovingPair::gap_error(const RelativeState& state) const {
  return 0x1p-47 * (A_.radius + B_.radius + state.p_AB.norm()) + motion_.position_error() +
         motion_.A().rotation_error() * A_.radius + motion_.B().rotation_error() * B_.radius;
}

PlacedBox MovingPair::place_A(const RelativeState& state, BoxId box) const {
  PlacedBox placed = detail::place(A_, box, state.R_WA, Vector3d::Zero(), state.p_AQa);
  placed.velocity = motion_.A().rate() * motion_.A().axis().cross(placed.centre - state.p_AQa);
  return placed;
}

PlacedBox MovingPair::place_B(const RelativeState& state, BoxId box) const {
  PlacedBox placed = detail::place(B_, box, state.R_WB, state.p_AB, state.p_AQb);
  placed.velocity = motion_.pivot_velocity() +
                    motion_.B().rate() * motion_.B().axis().cross(placed.centre - state.p_AQb);
  return placed;
}

TrianglePair MovingPair::place(const RelativeState& state, std::uint32_t triangle_A,
                               std::uint32_t triangle_B) const {
  TrianglePair pair;
  const auto& ta = A_.triangles[triangle_A];
  const auto& tb = B_.triangles[triangle_B];
  for (int k = 0; k < 3; ++k) {
    pair.A[k] = state.R_WA * A_.vertices[ta[k]];
    pair.B[k] = state.p_AB + state.R_WB * B_.vertices[tb[k]];
  }
  return pair;
}

double MovingPair::time_apart(const PlacedBox& a, const PlacedBox& b, double threshold,
                              double error) const {
  const double wA = motion_.A().rate();
  const double wB = motion_.B().rate();
  const Vector3d velocity = b.velocity - a.velocity;
  const double slip = 0x1p-47 * (motion_.pivot_velocity().norm() + wA * a.reach + wB * b.reach);
  double best = 0.0;
  for_each_direction(a, b, [&](const Separation& s) {
    const double clear = s.gap - threshold - error;
    if (!(clear > 0.0)) {
      return;
    }
    const double turn_A = wA * s.n.cross(motion_.A().axis()).norm();
    const double turn_B = wB * s.n.cross(motion_.B().axis()).norm();
    const double speed = slip - s.n.dot(velocity) + turn_A * a.radius + turn_B * b.radius;
    const double half_acceleration =
        0.5 * (1.0 + 0x1p-46) * (wA * turn_A * a.reach + wB * turn_B * b.reach + slip * (wA + wB));
    best = std::max(best, time_to_close(clear, speed, half_acceleration));
  });
  return best;
}

double MovingPair::gap(const PlacedBox& a, const PlacedBox& b) {
  double best = -std::numeric_limits<double>::infinity();
  for_each_direction(a, b, [&](const Separation& s) { best = std::max(best, s.gap); });
  return best;
}

BoxFrame MovingPair::box_frame() const {
  BoxFrame frame{};
  const std::array<const ConstantRatePath*, 2> paths{&motion_.A(), &motion_.B()};
  const std::array<double, 2> units{A_.unit, B_.unit};
  for (int body = 0; body < 2; ++body) {
    frame.ratio[body] = units[body] / unit();
    frame.rate[body] = static_cast<float>(paths[body]->rate());
    for (int k = 0; k < 3; ++k) {
      frame.axis[body][k] = static_cast<float>(paths[body]->axis()[k]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    frame.velocity[1][k] = static_cast<float>(motion_.pivot_velocity()[k] / unit());
  }
  frame.speed = round_up(motion_.pivot_velocity().norm() / unit());
  return frame;
}

void MovingPair::place(const RelativeState& state, double threshold, BoxFrame& frame) const {
  const double scale = 1.0 / unit();  // A power of two: exact.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      frame.rotation[0][3 * i + j] = state.R_WA(i, j);
      frame.rotation[1][3 * i + j] = state.R_WB(i, j);
    }
    frame.origin[1][i] = state.p_AB[i] * scale;
    frame.pivot[0][i] = state.p_AQa[i] * scale;
    frame.pivot[1][i] = state.p_AQb[i] * scale;
  }
  frame.threshold = round_up(threshold * scale);
}

}  // namespace firstcontact::detail
