#include <firstcontact/moving_pairs/detail/moving_pair.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_set.h>
#include <firstcontact/math/root_isolation.h>
#include <firstcontact/moving_pairs/detail/search_tuning.h>
#include <firstcontact/narrowphase/convex_pair.h>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// One box, in the frame of its hierarchy and in metres.
struct OwnBox {
  Vector3d centre;
  Vector3d extent;
};

OwnBox own_box(const HierarchyNode& node, int slot, double unit) {
  OwnBox box;
  for (int k = 0; k < 3; ++k) {
    box.centre[k] = static_cast<double>(node.centre[k][slot]) * unit;
    box.extent[k] = static_cast<double>(node.half_extent(k, slot)) * unit;
  }
  return box;
}

/// Turns a box placed as at t = 0 into one of t, and adds its rates of change.
void deform(const Hierarchy& hierarchy, BoxId box, double t, const Matrix3d& R, OwnBox& own,
            PlacedBox& placed) {
  const OwnBox to =
      own_box(hierarchy.nodes_to[box.node], static_cast<int>(box.slot), hierarchy.unit);
  placed.deforms = true;
  placed.growth = to.extent - own.extent;
  placed.velocity = R * (to.centre - own.centre);
  own.centre = (1.0 - t) * own.centre + t * to.centre;
  own.extent = (1.0 - t) * own.extent + t * to.extent;
}

void place_corners(const Hierarchy& hierarchy, const HierarchyNode& node, int slot, double t,
                   const Matrix3d& R, const Vector3d& origin, PlacedBox& placed) {
  const auto& corners = hierarchy.triangles[node.child_triangle(slot)];
  for (int k = 0; k < 3; ++k) {
    placed.corners.row(k) =
        (origin + R * hierarchy.vertex(corners[k], t) - placed.centre).transpose();
    if (placed.deforms) {
      placed.corner_growth.row(k) =
          (R * (hierarchy.vertices_to[corners[k]] - hierarchy.vertices[corners[k]]) -
           placed.velocity)
              .transpose();
    }
  }
}

/// Places a box. Its velocity is relative to its body.
PlacedBox place(const Hierarchy& hierarchy, BoxId box, double t, const Matrix3d& R,
                const Vector3d& origin, const Vector3d& pivot) {
  PlacedBox placed;
  const HierarchyNode& node = hierarchy.nodes[box.node];
  const auto slot = static_cast<int>(box.slot);
  OwnBox own = own_box(node, slot, hierarchy.unit);
  placed.velocity.setZero();
  if (hierarchy.deforms()) {
    deform(hierarchy, box, t, R, own, placed);
  }
  placed.extent = own.extent;
  placed.centre = origin + R * own.centre;
  placed.axes = box_axes(node, slot) * R.transpose();
  placed.radius = placed.extent.norm();
  placed.is_triangle = node.is_leaf(slot);
  if (placed.is_triangle) {
    place_corners(hierarchy, node, slot, t, R, origin, placed);
  }
  placed.reach = ((placed.centre - pivot).norm() + placed.radius) * (1.0 + 0x1p-48) +
                 hierarchy.deformation_speed;
  return placed;
}

/// [m]  The extent of the box along n from its centre.
double extent_along(const PlacedBox& box, const Vector3d& n) {
  if (box.core != nullptr) {
    return n.dot(box.p_core) + box.core->support_bound(box.R_core.transpose() * n);
  }
  return box.is_triangle ? (box.corners * n).maxCoeff() : box.extent.dot((box.axes * n).cwiseAbs());
}

/// [m per step]  Bound of the growth of that extent.
double growth_along(const PlacedBox& box, const Vector3d& n) {
  if (!box.deforms) {
    return 0.0;
  }
  return box.is_triangle ? (box.corner_growth * n).maxCoeff()
                         : box.growth.dot((box.axes * n).cwiseAbs());
}

/// A direction and the gap of two boxes along it. The extent of a whole shape is its radius in
/// every direction.
struct Separation {
  Vector3d n;  // from A to B
  double gap;
};

/// Calls use(direction) for each direction until it returns true.
template <class Use>
void for_each_direction(const PlacedBox& a, const PlacedBox& b, const Use& use) {
  const Vector3d d = b.centre - a.centre;
  const auto consider = [&](Vector3d n) {
    double along = n.dot(d);
    if (along < 0.0) {
      n = -n;
      along = -along;
    }
    return use(Separation{n, along - extent_along(a, n) - extent_along(b, -n)});
  };
  const double length = d.norm();
  bool done = length > 0.0 && consider(d / length);
  for (int k = 0; k < 3 && !done; ++k) {
    done = consider(a.axes.row(k).transpose()) || consider(b.axes.row(k).transpose());
  }
}

}  // namespace

namespace {

/// The most corners of a hull that is taken as a set: each support point visits all of them.
constexpr std::size_t kMostCorners = 64;

bool has_small_set(const Shape& shape) {
  const ConvexSet* set = shape.convex_set();
  return set != nullptr && set->core().points.size() <= kMostCorners;
}

std::optional<ConvexCore> core_of(const Shape& shape, const Shape& partner) {
  return is_asked_as_convex(shape, partner) ? std::optional(shape.convex_core()) : std::nullopt;
}

const Hierarchy& hierarchy_of(const Shape& shape, const Shape& partner) {
  return is_asked_as_convex(shape, partner) ? shape.convex_hierarchy() : shape.hierarchy();
}

/// Replaces a box by the core in it.
void place_core(const ConvexCore* core, const Matrix3d& R, const Vector3d& origin,
                PlacedBox& placed) {
  if (core != nullptr) {
    placed.core = core;
    placed.R_core = R;
    placed.p_core = origin - placed.centre;
    placed.is_triangle = false;
  }
}

}  // namespace

bool is_asked_as_convex(const Shape& shape, const Shape& partner) {
  if (shape.hierarchy().deforms() || partner.hierarchy().deforms()) {
    return false;
  }
  return shape.is_curved() || (partner.is_curved() && has_small_set(shape));
}

double enclosure_error(const Shape& A, const Shape& B) {
  return (is_asked_as_convex(A, B) ? 0.0 : A.enclosure_error()) +
         (is_asked_as_convex(B, A) ? 0.0 : B.enclosure_error());
}

MovingPair::MovingPair(const Shape& A, const Shape& B, const PairMotion& motion)
    : MovingPair(hierarchy_of(A, B), hierarchy_of(B, A), motion) {
  convex_A_ = core_of(A, B);
  convex_B_ = core_of(B, A);
}

MovingPair::MovingPair(const Hierarchy& A, const Hierarchy& B, const PairMotion& motion)
    : A_(A),
      B_(B),
      motion_(motion),
      speed_bound_(
          (motion.speed_bound(A.radius, B.radius) + A.deformation_speed + B.deformation_speed) *
          (1.0 + 0x1p-50)) {}

double MovingPair::gap_error(const RelativeState& state) const {
  if (is_convex()) {
    return convex_gap_error(state, A_.radius, B_.radius);
  }
  return 0x1p-47 * (A_.radius + B_.radius + state.p_AB.norm()) + state.position_error +
         state.rotation_error_A * A_.radius + state.rotation_error_B * B_.radius;
}

PlacedBox MovingPair::place_A(const RelativeState& state, BoxId box) const {
  PlacedBox placed = detail::place(A_, box, state.t, state.R_WA, Vector3d::Zero(), state.p_AQa);
  place_core(convex_A(), state.R_WA, Vector3d::Zero(), placed);
  placed.velocity += state.rate_A * state.axis_A.cross(placed.centre - state.p_AQa);
  return placed;
}

PlacedBox MovingPair::place_B(const RelativeState& state, BoxId box) const {
  PlacedBox placed = detail::place(B_, box, state.t, state.R_WB, state.p_AB, state.p_AQb);
  place_core(convex_B(), state.R_WB, state.p_AB, placed);
  placed.velocity +=
      state.pivot_velocity + state.rate_B * state.axis_B.cross(placed.centre - state.p_AQb);
  return placed;
}

TrianglePair MovingPair::place(const RelativeState& state, std::uint32_t triangle_A,
                               std::uint32_t triangle_B) const {
  TrianglePair pair;
  const auto& ta = A_.triangles[triangle_A];
  const auto& tb = B_.triangles[triangle_B];
  for (int k = 0; k < 3; ++k) {
    pair.A[k] = state.R_WA * A_.vertex(ta[k], state.t);
    pair.B[k] = state.p_AB + state.R_WB * B_.vertex(tb[k], state.t);
  }
  return pair;
}

TrianglePair MovingPair::rates(const RelativeState& state, std::uint32_t triangle_A,
                               std::uint32_t triangle_B) const {
  const auto rates_of = [](const Hierarchy& hierarchy, const Matrix3d& R, std::uint32_t triangle) {
    Triangle rates{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
    for (std::size_t k = 0; k < 3 && hierarchy.deforms(); ++k) {
      const std::uint32_t v = hierarchy.triangles[triangle][k];
      rates[k] = R * (hierarchy.vertices_to[v] - hierarchy.vertices[v]);
    }
    return rates;
  };
  return {rates_of(A_, state.R_WA, triangle_A), rates_of(B_, state.R_WB, triangle_B)};
}

double MovingPair::time_apart(const RelativeState& state, const PlacedBox& a, const PlacedBox& b,
                              double threshold, double error, double enough) const {
  const double wA = state.rate_A;
  const double wB = state.rate_B;
  const double dA = A_.deformation_speed;
  const double dB = B_.deformation_speed;
  const Vector3d velocity = b.velocity - a.velocity;
  const double slip =
      state.drift + 0x1p-47 * (state.pivot_velocity.norm() + wA * a.reach + wB * b.reach + dA + dB);
  double best = 0.0;
  for_each_direction(a, b, [&](const Separation& s) {
    const double clear = s.gap - threshold - error;
    if (!(clear > 0.0)) {
      return false;
    }
    const double turn_A = wA * s.n.cross(state.axis_A).norm();
    const double turn_B = wB * s.n.cross(state.axis_B).norm();
    const double speed = slip - s.n.dot(velocity) + turn_A * a.radius + turn_B * b.radius +
                         growth_along(a, s.n) + growth_along(b, -s.n);
    const double half_acceleration =
        0.5 * (1.0 + 0x1p-46) *
        (turn_A * (wA * a.reach + 2.0 * dA) + turn_B * (wB * b.reach + 2.0 * dB) +
         slip * (wA + wB) + state.bend_of(a.reach, b.reach));
    best = std::max(best, time_to_close(clear, speed, half_acceleration));
    return best >= enough;
  });
  return best;
}

void MovingPair::bound(const BoxFrame& frame, std::uint32_t node_a, std::uint32_t node_b,
                       BoxBounds& bounds) const {
  if (!deforms()) {
    bound_boxes(frame, A_.nodes[node_a], B_.nodes[node_b], bounds);
    return;
  }
  const auto at_end = [](const Hierarchy& hierarchy, std::uint32_t node) -> const HierarchyNode& {
    return hierarchy.deforms() ? hierarchy.nodes_to[node] : hierarchy.nodes[node];
  };
  bound_deforming_boxes(frame, A_.nodes[node_a], at_end(A_, node_a), B_.nodes[node_b],
                        at_end(B_, node_b), bounds);
}

void MovingPair::bound(const BoxFrame& frame, std::uint32_t node_a, std::uint32_t node_b,
                       BoxBounds& bounds, std::uint32_t other_a, std::uint32_t other_b,
                       BoxBounds& other_bounds) const {
  if (!deforms()) {
    bound_boxes(frame, A_.nodes[node_a], B_.nodes[node_b], bounds, A_.nodes[other_a],
                B_.nodes[other_b], other_bounds);
    return;
  }
  bound(frame, node_a, node_b, bounds);
  bound(frame, other_a, other_b, other_bounds);
}

double MovingPair::gap(const PlacedBox& a, const PlacedBox& b) {
  double best = -std::numeric_limits<double>::infinity();
  for_each_direction(a, b, [&](const Separation& s) {
    best = std::max(best, s.gap);
    return false;
  });
  return best;
}

double MovingPair::gap_along(const Vector3d& n, const PlacedBox& a, const PlacedBox& b) {
  return n.dot(b.centre - a.centre) - extent_along(a, n) - extent_along(b, -n);
}

BoxFrame MovingPair::box_frame() const {
  BoxFrame frame{};
  const SearchTuning& tuning = search_tuning(motion_.follows_joints());
  frame.far = static_cast<float>(tuning.far_boxes);
  frame.larger = static_cast<float>(tuning.larger_boxes);
  const std::array<double, 2> units{A_.unit, B_.unit};
  const std::array<double, 2> deformation{A_.deformation_speed, B_.deformation_speed};
  for (int body = 0; body < 2; ++body) {
    frame.ratio[body] = units[body] / unit();
    frame.deformation[body] = deformation[body] > 0.0 ? round_up(deformation[body] / unit()) : 0.0f;
  }
  return frame;
}

/// Sets the bends. Distances from the pivots are differences of positions in single precision.
void MovingPair::place_bend(const RelativeState& state, BoxFrame& frame) const {
  constexpr double kDistanceError = 0x1p-20;
  const double size =
      A_.radius + B_.radius + state.p_AB.norm() + state.p_AQa.norm() + state.p_AQb.norm();
  const double bend = state.bend + kDistanceError * size * (state.bend_A + state.bend_B);
  const auto rounded = [](double value) { return value == 0.0 ? 0.0f : round_up(value); };
  frame.bend = rounded(bend / unit());
  frame.bend_by_distance[0] = rounded(state.bend_A);
  frame.bend_by_distance[1] = rounded(state.bend_B);
}

void MovingPair::place(const RelativeState& state, double threshold, BoxFrame& frame) const {
  const double scale = 1.0 / unit();  // A power of two: exact.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      frame.rotation[0][3 * i + j] = state.R_WA(i, j);
      frame.rotation[1][3 * i + j] = state.R_WB(i, j);
      frame.rounded[0][3 * i + j] = static_cast<float>(state.R_WA(i, j));
      frame.rounded[1][3 * i + j] = static_cast<float>(state.R_WB(i, j));
    }
    frame.origin[1][i] = state.p_AB[i] * scale;
    frame.pivot[0][i] = state.p_AQa[i] * scale;
    frame.pivot[1][i] = state.p_AQb[i] * scale;
    frame.spin[0][i] = static_cast<float>(state.rate_A * state.axis_A[i]);
    frame.spin[1][i] = static_cast<float>(state.rate_B * state.axis_B[i]);
    frame.velocity[1][i] = static_cast<float>(state.pivot_velocity[i] * scale);
  }
  frame.rate[0] = static_cast<float>(state.rate_A);
  frame.rate[1] = static_cast<float>(state.rate_B);
  // A body that deforms adds rounding of its own: box_bounds.cpp.
  frame.speed = round_up(
      (state.pivot_velocity.norm() + 4.0 * (A_.deformation_speed + B_.deformation_speed)) * scale);
  frame.drift = state.drift == 0.0 ? 0.0f : round_up(state.drift * scale);
  place_bend(state, frame);
  frame.threshold = round_up(threshold * scale);
  frame.t = state.t;
}

}  // namespace firstcontact::detail
