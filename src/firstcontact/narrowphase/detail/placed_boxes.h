/// @file
/// The boxes of two nodes, or of two pairs of nodes, placed at an instant.
///
/// Included once for each instruction set.

#if defined(FIRSTCONTACT_QUERY_DETAIL_PLACED_BOXES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRSTCONTACT_QUERY_DETAIL_PLACED_BOXES_H
#undef FIRSTCONTACT_QUERY_DETAIL_PLACED_BOXES_H
#else
#define FIRSTCONTACT_QUERY_DETAIL_PLACED_BOXES_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>
#include <firstcontact/narrowphase/detail/box_lanes.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// [-]  The time until which extents are followed: to the horizon, at least kShortest.
///
/// The reciprocal of a nearer horizon could overflow.
HWY_INLINE float chord_end(const BoxFrame& frame) {
  return frame.horizon > kShortest ? frame.horizon : kShortest;
}

/// Four boxes of a node at both ends of the step; twice the same node where the body does not
/// deform.
struct NodeAtEnds {
  const HierarchyNode& from;
  const HierarchyNode& to;
};

/// A node of A and a node of B.
using NodePair = std::array<NodeAtEnds, 2>;

/// Boxes placed in the frame: four of A's node in each pair of nodes, then those of B's.
template <std::size_t kPlaces>
struct alignas(64) Placed {
  alignas(64) float lever[3][kPlaces];  // Vector to the centre from its body's pivot.
  float centre[3][kPlaces];             // Relative to a point beside the pair of nodes.
  float velocity[3][kPlaces];
  float axes[3][3][kPlaces];  // axis, component
  float extent[3][kPlaces];
  float radius[kPlaces];
  float distance[kPlaces];  // Bound of the distance of any point from the pivot.
  float reach[kPlaces];     // The distance times the rate.
  float slack[kPlaces];     // The box's share of the gap's slack.
  float doubt[kPlaces];     // Half of the slack, and of the excess thickness of a triangle's box.
  float swept[3][kPlaces];  // Rotation vector of its body until the horizon, in the box's axes.
  // For axes 0 and 1:
  float own_turn[2][kPlaces];       // w |n x u| for the box's own body.
  float turn_of_other[2][kPlaces];  // Likewise for the other body.
  float swing[2][kPlaces];          // Rate of the box's own extent, as it turns.
  // For bodies that deform:
  float drift[3][kPlaces];   // Velocity of the centre as seen from its body, in the frame's axes.
  float growth[3][kPlaces];  // Rate of the extent.
};

template <class DF>
HWY_INLINE V<DF> widen(DF df, V<hn::Rebind<std::uint16_t, DF>> extent) {
  const hn::Rebind<std::uint32_t, DF> d32;
  const auto code = hn::PromoteTo(d32, extent);
  return hn::BitCast(df, hn::Add(hn::ShiftLeft<HierarchyNode::kExtentShift>(code),
                                 hn::Set(d32, HierarchyNode::kExtentOrigin)));
}

/// The product R v + origin.
template <class D>
HWY_INLINE void rotate(D d, const double* R, const V<D>* v, const V<D>* origin, V<D>* rotated) {
  for (std::size_t k = 0; k < 3; ++k) {
    rotated[k] = hn::MulAdd(hn::Set(d, R[3 * k]), v[0],
                            hn::MulAdd(hn::Set(d, R[3 * k + 1]), v[1],
                                       hn::MulAdd(hn::Set(d, R[3 * k + 2]), v[2], origin[k])));
  }
}

/// Interpolates some boxes of a body that deforms: moves their centres, places extents and rates.
template <class DD, std::size_t kPlaces>
HWY_INLINE void deform(DD d, const BoxFrame& frame, const NodeAtEnds& node, V<DD> ratio,
                       std::size_t body, std::size_t lane, V<DD>* centre, Placed<kPlaces>& placed) {
  const hn::Rebind<float, DD> df;
  const hn::Rebind<std::uint16_t, DD> d16;
  using VD = V<DD>;
  const std::size_t place = 4 * body + lane;
  const VD t = hn::Set(d, frame.t);
  const VD rest = hn::Set(d, 1.0 - frame.t);
  const VD zero[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  VD rate[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const VD to = hn::Mul(ratio, hn::PromoteTo(d, hn::LoadU(df, node.to.centre[k] + lane)));
    rate[k] = hn::Sub(to, centre[k]);
    centre[k] = hn::MulAdd(rest, centre[k], hn::Mul(t, to));
    const VD e =
        hn::Mul(ratio, hn::PromoteTo(d, widen(df, hn::LoadU(d16, node.from.extent[k] + lane))));
    const VD e_to =
        hn::Mul(ratio, hn::PromoteTo(d, widen(df, hn::LoadU(d16, node.to.extent[k] + lane))));
    const VD extent = hn::MulAdd(rest, e, hn::Mul(t, e_to));
    hn::StoreU(hn::DemoteTo(df, extent), df, placed.extent[k] + place);
    hn::StoreU(hn::DemoteTo(df, hn::Sub(e_to, e)), df, placed.growth[k] + place);
  }
  VD drift[3];
  rotate(d, frame.rotation[body], rate, zero, drift);
  for (std::size_t k = 0; k < 3; ++k) {
    hn::StoreU(hn::DemoteTo(df, drift[k]), df, placed.drift[k] + place);
  }
}

/// Centres in double precision, relative to the first of A's node and to the pivots.
template <bool kDeforms, std::size_t kPairs>
HWY_INLINE void place_centres(const BoxFrame& frame, const NodePair* pairs,
                              Placed<8 * kPairs>& placed) {
  constexpr std::size_t kBoxes = 4 * kPairs;  // Number of boxes of each body.
  const hn::CappedTag<double, kBoxes> d;
  const hn::Rebind<float, decltype(d)> df;
  using VD = V<decltype(d)>;
  HWY_ALIGN double p[2][3][kBoxes];
  for (std::size_t body = 0; body < 2; ++body) {
    const VD ratio = hn::Set(d, frame.ratio[body]);
    VD origin[3];
    for (std::size_t k = 0; k < 3; ++k) {
      origin[k] = hn::Set(d, frame.origin[body][k]);
    }
    for (std::size_t lane = 0; lane < kBoxes; lane += hn::Lanes(d)) {
      VD v[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto centre = of_parts(df, lane, [&](auto part, std::size_t box) HWY_ATTR {
          return hn::LoadU(part, pairs[box / 4][body].from.centre[k] + box % 4);
        });
        v[k] = hn::Mul(ratio, hn::PromoteTo(d, centre));
      }
      if constexpr (kDeforms) {
        deform(d, frame, pairs[0][body], ratio, body, lane, v, placed);
      }
      VD rotated[3];
      rotate(d, frame.rotation[body], v, origin, rotated);
      for (std::size_t k = 0; k < 3; ++k) {
        const VD lever = hn::Sub(rotated[k], hn::Set(d, frame.pivot[body][k]));
        hn::StoreU(hn::DemoteTo(df, lever), df, placed.lever[k] + kBoxes * body + lane);
        hn::StoreU(rotated[k], d, p[body][k] + lane);
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t lane = 0; lane < kBoxes; lane += hn::Lanes(d)) {
      const VD first = of_parts(d, lane, [&p, k](auto part, std::size_t place) HWY_ATTR {
        return hn::Set(part, p[0][k][place & ~3]);
      });
      for (std::size_t body = 0; body < 2; ++body) {
        const VD relative = hn::Sub(hn::Load(d, p[body][k] + lane), first);
        hn::StoreU(hn::DemoteTo(df, relative), df, placed.centre[k] + kBoxes * body + lane);
      }
    }
  }
}

/// Places all but the centres, in single precision: as many boxes at once as the processor has
/// lanes.
template <class D, bool kDeforms, std::size_t kPairs>
struct Placer {
  D d;
  const BoxFrame& frame;
  const NodePair* pairs;
  Placed<8 * kPairs>& placed;
  static constexpr std::size_t kBoxes = 4 * kPairs;  // Number of boxes of each body.
  static constexpr bool kBoth = hn::MaxLanes(D()) == 2 * kBoxes;

  /// One value for the lanes of A, another for those of B.
  HWY_INLINE V<D> each(std::size_t first, float a, float b) const {
    if constexpr (kBoth) {
      const hn::Half<D> half;
      return Combine(d, hn::Set(half, b), hn::Set(half, a));
    } else {
      return hn::Set(d, first < kBoxes ? a : b);
    }
  }
  /// The node of a place.
  HWY_INLINE const HierarchyNode& node(std::size_t place) const {
    return pairs[place % kBoxes / 4][place / kBoxes].from;
  }
  HWY_INLINE hn::Mask<D> leaves(std::size_t first) const {
    unsigned bits = 0;
    for (std::size_t k = 0; k < kPairs; ++k) {
      bits |= pairs[k][0].from.leaves() << (4 * k);
      bits |= pairs[k][1].from.leaves() << (kBoxes + 4 * k);
    }
    bits >>= first;
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                   static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(d, bytes);
  }

  HWY_INLINE void place(std::size_t first) const {
    const hn::Rebind<std::uint16_t, D> d16;
    V<D> v[3];
    V<D> e[3];
    V<D> c[3];
    V<D> lever[3];
    const V<D> ratio =
        each(first, static_cast<float>(frame.ratio[0]), static_cast<float>(frame.ratio[1]));
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = of_parts(d, first, [&](auto part, std::size_t place) HWY_ATTR {
        return hn::LoadU(part, node(place).rotation[k] + place % 4);
      });
      if constexpr (kDeforms) {
        e[k] = hn::Load(d, placed.extent[k] + first);
      } else {
        const auto extent = of_parts(d16, first, [&](auto part, std::size_t place) HWY_ATTR {
          return hn::LoadU(part, node(place).extent[k] + place % 4);
        });
        e[k] = hn::Mul(ratio, widen(d, extent));
      }
      c[k] = hn::Load(d, placed.centre[k] + first);
      lever[k] = hn::Load(d, placed.lever[k] + first);
    }
    const V<D> radius = root_up(d, dot(d, e, e));
    const V<D> rate = each(first, frame.rate[0], frame.rate[1]);
    const V<D> distance = hn::Add(root_up(d, dot(d, lever, lever)), radius);
    V<D> reach = hn::Mul(rate, distance);
    if constexpr (kDeforms) {
      // w (|rho| + D) + 2 D takes the place of w |rho|.
      const V<D> speed = each(first, frame.deformation[0], frame.deformation[1]);
      reach = hn::Add(reach, hn::MulAdd(rate, speed, hn::Add(speed, speed)));
    }
    const V<D> size =
        hn::Add(hn::Add(hn::Abs(c[0]), hn::Abs(c[1])), hn::Add(hn::Abs(c[2]), radius));
    const V<D> slack = hn::MulAdd(size, hn::Set(d, kGapSlack), hn::Set(d, kTinyLength));
    const V<D> doubt =
        hn::MulAdd(hn::IfThenElseZero(leaves(first), radius), hn::Set(d, kExtentDoubt), slack);
    V<D> axes[3][3];
    place_axes(first, v, axes);
    V<D> spin[3];
    for (int k = 0; k < 3; ++k) {
      spin[k] = each(first, frame.spin[0][k], frame.spin[1][k]);
    }
    place_turning(first, axes, spin, e);
    place_velocity(first, spin, lever);
    for (int k = 0; k < 3 && !kDeforms; ++k) {
      hn::Store(e[k], d, placed.extent[k] + first);
    }
    hn::Store(radius, d, placed.radius + first);
    hn::Store(distance, d, placed.distance + first);
    hn::Store(reach, d, placed.reach + first);
    hn::Store(slack, d, placed.slack + first);
    hn::Store(hn::Mul(hn::Set(d, 0.5f), doubt), d, placed.doubt + first);
  }

  HWY_INLINE void place_velocity(std::size_t first, const V<D>* spin, const V<D>* lever) const {
    V<D> turning[3];
    cross(spin, lever, turning);
    for (int k = 0; k < 3; ++k) {
      const V<D> pivot = each(first, frame.velocity[0][k], frame.velocity[1][k]);
      V<D> velocity = hn::Add(pivot, turning[k]);
      if constexpr (kDeforms) {
        velocity = hn::Add(velocity, hn::Load(d, placed.drift[k] + first));
      }
      hn::Store(velocity, d, placed.velocity[k] + first);
    }
  }

  /// Box axes from the quaternion (w, x, y, z), turned by the body's rotation.
  HWY_INLINE void place_axes(std::size_t first, const V<D>* v, V<D> (*axes)[3]) const {
    const V<D> one = hn::Set(d, 1.0f);
    const V<D> x = v[0];
    const V<D> y = v[1];
    const V<D> z = v[2];
    const V<D> w = hn::Sqrt(hn::Sub(one, dot(d, v, v)));
    const V<D> x2 = hn::Add(x, x);
    const V<D> y2 = hn::Add(y, y);
    const V<D> z2 = hn::Add(z, z);
    const V<D> xx = hn::Mul(x, x2);
    const V<D> yy = hn::Mul(y, y2);
    const V<D> zz = hn::Mul(z, z2);
    const V<D> xy = hn::Mul(x, y2);
    const V<D> xz = hn::Mul(x, z2);
    const V<D> yz = hn::Mul(y, z2);
    const V<D> wx = hn::Mul(w, x2);
    const V<D> wy = hn::Mul(w, y2);
    const V<D> wz = hn::Mul(w, z2);
    // Rows of the rotation matrix of q are the axes, as in box_axes().
    const V<D> rows[3][3] = {{hn::Sub(one, hn::Add(yy, zz)), hn::Sub(xy, wz), hn::Add(xz, wy)},
                             {hn::Add(xy, wz), hn::Sub(one, hn::Add(xx, zz)), hn::Sub(yz, wx)},
                             {hn::Sub(xz, wy), hn::Add(yz, wx), hn::Sub(one, hn::Add(xx, yy))}};
    V<D> R[3][3];
    for (int k = 0; k < 3; ++k) {
      for (int m = 0; m < 3; ++m) {
        R[k][m] = each(first, frame.rounded[0][3 * k + m], frame.rounded[1][3 * k + m]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 3; ++k) {
        axes[axis][k] = dot(d, R[k], rows[axis]);
        hn::Store(axes[axis][k], d, placed.axes[axis][k] + first);
      }
    }
  }

  /// Places the rates at which the two thinner axes turn against both bodies.
  HWY_INLINE void place_turning(std::size_t first, const V<D> (*axes)[3], const V<D>* spin,
                                const V<D>* e) const {
    V<D> other[3];
    for (int k = 0; k < 3; ++k) {
      other[k] = each(first, frame.spin[1][k], frame.spin[0][k]);
      const V<D> own = dot(d, axes[k], spin);
      hn::Store(hn::Mul(own, hn::Set(d, chord_end(frame))), d, placed.swept[k] + first);
    }
    for (int axis = 0; axis < 2; ++axis) {
      V<D> turning[3];
      cross(axes[axis], spin, turning);
      hn::Store(root_up(d, dot(d, turning, turning)), d, placed.own_turn[axis] + first);
      const int i = 1 - axis;
      hn::Store(hn::MulAdd(e[i], hn::Abs(dot(d, axes[i], turning)),
                           hn::Mul(e[2], hn::Abs(dot(d, axes[2], turning)))),
                d, placed.swing[axis] + first);
      cross(axes[axis], other, turning);
      hn::Store(root_up(d, dot(d, turning, turning)), d, placed.turn_of_other[axis] + first);
    }
  }
};

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
