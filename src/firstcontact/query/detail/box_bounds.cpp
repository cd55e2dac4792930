#include <firstcontact/query/detail/box_bounds.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/query/detail/box_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Derivation of the slacks, u = 2^-24, lengths of a pair L = |c_A| + |c_B| + r_A + r_B with
// centres c relative to a point beside them (formed in double, then rounded).
//  - Centres: u |c|; their difference u |d|; its dot product with a direction 3 u |d|.
//  - Axes: the scalar part of the quaternion is at least 0.65 and within 3.5 u, entries of the
//    matrix within 8 u; after the body's rotation an axis is within 20 u of its box's.
//  - Directions are what they are, stored; only box extents along them have errors: at most
//    24 u sqrt(3) r for axes and products. The sum stays below 64 u L.
//  - Velocities: positions relative to the pivot, cross and dot products add up to 16 u of
//    |s| + w_A rho_A + w_B rho_B, w (n x u) to 4 u w, and as part of an extent to 4 u sqrt(3) w r.
//  - Extents at the horizon, along m = n + H w (n x u): 24 u sqrt(3) r |m|. Of two extents that are
//    interpolated each error counts by its share. With |m| <= 1 + H w |n x u| the gap's slack has
//    24 u sqrt(3) r, and 42 u r w |n x u| of the speed is left, for which there is kSwingSlack.
//  - Bodies that deform: boxes are interpolated in double; sums of the rates of centres and
//    extents, each at most 2 D, err by less than 80 u D, for which the frame's speed has 4 D more.
constexpr float kGapSlack = 0x1p-18f;
constexpr float kSpeedSlack = 0x1p-19f;
constexpr float kSwingSlack = 0x1p-18f;
constexpr float kTimeSlack = 1.0f - 0x1p-18f;
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
constexpr float kRoughness = HWY_TARGET <= HWY_AVX3 ? 0x1p-13f : 0x1p-11f;
#else
constexpr float kRoughness = 0x1p-18f;
#endif
constexpr float kTiny = 0x1p-60f;         // Above what underflow can lose in a square.
constexpr float kTinyLength = 0x1p-100f;  // Above what extents can lose when their unit is scaled.
constexpr float kExtentDoubt = 0x1p-9f;   // Of the radius: above what extents were rounded up by.
constexpr float kLargest = 1e30f;         // Beyond, products may overflow.
constexpr float kShortest = 0x1p-40f;     // Of the times until which extents are followed.

/// Boxes placed in the frame: four of A, then four of B.
struct alignas(64) Placed {
  float pivot[2][3];  // of the bodies, like centres
  alignas(64) float centre[3][8];
  float velocity[3][8];
  float axes[3][3][8];  // axis, component
  float extent[3][8];
  float radius[8];
  float distance[8];  // of any point from the pivot
  float reach[8];     // the same times the rate
  float size[8];      // |c| + r
  float doubt[8];     // of a triangle's box: how much it may be thicker than the triangle
  // For axes 0 and 1:
  float own_turn[2][8];       // w |n x u| of the box's own body
  float turn_of_other[2][8];  // and of the other one
  float swing[2][8];          // rate of the box's own extent, as it turns
  float seen[2][3][8];        // the axis as the other body sees it at the horizon
  // Of bodies that deform:
  float drift[3][8];   // velocity of the centre as its body sees it, in the frame's axes
  float growth[3][8];  // rate of the extent
};

/// [-]  The time until which extents are followed: to the horizon, and where that is so near that
/// its reciprocal could overflow, a little beyond it.
HWY_INLINE float chord_end(const BoxFrame& frame) {
  return frame.horizon > kShortest ? frame.horizon : kShortest;
}

/// Four boxes of a node at both ends of the step; the same twice of a body that does not deform.
struct NodeAtEnds {
  const HierarchyNode& from;
  const HierarchyNode& to;
};

template <class D>
using V = hn::Vec<D>;

template <class D>
HWY_INLINE V<D> dot(D, const V<D>* x, const V<D>* y) {
  return hn::MulAdd(x[0], y[0], hn::MulAdd(x[1], y[1], hn::Mul(x[2], y[2])));
}

/// Within 3/4 kRoughness of 1 / x and 1 / sqrt(x): x86 promises 2^-14 with AVX-512 and 1.5 x 2^-12
/// before; elsewhere they are exact up to rounding.
template <class D>
HWY_INLINE V<D> reciprocal(D d, V<D> x) {
  if constexpr (kRoughness > 0x1p-15f) {
    (void)d;
    return hn::ApproximateReciprocal(x);
  } else {
    return hn::Div(hn::Set(d, 1.0f), x);
  }
}
template <class D>
HWY_INLINE V<D> reciprocal_root(D d, V<D> x) {
  if constexpr (kRoughness > 0x1p-15f) {
    (void)d;
    return hn::ApproximateReciprocalSqrt(x);
  } else {
    return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(x));
  }
}

/// At least sqrt(x), and hardly more; x >= 0.
template <class D>
HWY_INLINE V<D> root_up(D d, V<D> x) {
  const V<D> positive = hn::Add(x, hn::Set(d, kTiny * kTiny));
  return hn::Mul(hn::Mul(positive, hn::Set(d, 1.0f + kRoughness)), reciprocal_root(d, positive));
}

template <class VD>
HWY_INLINE void cross(const VD* x, const VD* y, VD* product) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    product[k] = hn::NegMulAdd(x[j], y[i], hn::Mul(x[i], y[j]));
  }
}

/// At least w |n x u|, spin = w u; and the direction as a body with that spin sees it after a time.
template <class D>
HWY_INLINE V<D> turn_against(D d, const V<D>* n, const V<D>* spin, float duration, V<D>* seen) {
  V<D> turning[3];
  cross(n, spin, turning);
  for (int k = 0; k < 3; ++k) {
    seen[k] = hn::MulAdd(hn::Set(d, duration), turning[k], n[k]);
  }
  return root_up(d, dot(d, turning, turning));
}

template <class DF>
HWY_INLINE V<DF> widen(DF df, const std::uint16_t* extent) {
  const hn::Rebind<std::uint16_t, DF> d16;
  const hn::Rebind<std::uint32_t, DF> d32;
  const auto code = hn::PromoteTo(d32, hn::LoadU(d16, extent));
  return hn::BitCast(df, hn::Add(hn::ShiftLeft<HierarchyNode::kExtentShift>(code),
                                 hn::Set(d32, HierarchyNode::kExtentOrigin)));
}

/// R v.
template <class D>
HWY_INLINE void rotate(D d, const double* R, const V<D>* v, const V<D>* origin, V<D>* rotated) {
  for (std::size_t k = 0; k < 3; ++k) {
    rotated[k] = hn::MulAdd(hn::Set(d, R[3 * k]), v[0],
                            hn::MulAdd(hn::Set(d, R[3 * k + 1]), v[1],
                                       hn::MulAdd(hn::Set(d, R[3 * k + 2]), v[2], origin[k])));
  }
}

/// Interpolates some boxes of a body that deforms: moves their centres, places extents and rates.
template <class VD>
HWY_INLINE void deform(const BoxFrame& frame, const NodeAtEnds& node, VD ratio, std::size_t body,
                       std::size_t lane, VD* centre, Placed& placed) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  const std::size_t place = 4 * body + lane;
  const VD t = hn::Set(d, frame.t);
  const VD rest = hn::Set(d, 1.0 - frame.t);
  const VD zero[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  VD rate[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const VD to = hn::Mul(ratio, hn::PromoteTo(d, hn::LoadU(df, node.to.centre[k] + lane)));
    rate[k] = hn::Sub(to, centre[k]);
    centre[k] = hn::MulAdd(rest, centre[k], hn::Mul(t, to));
    const VD e = hn::Mul(ratio, hn::PromoteTo(d, widen(df, node.from.extent[k] + lane)));
    const VD e_to = hn::Mul(ratio, hn::PromoteTo(d, widen(df, node.to.extent[k] + lane)));
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

/// Centres in double precision, relative to the first of A's.
template <bool kDeforms>
HWY_INLINE void place_centres(const BoxFrame& frame, const NodeAtEnds* nodes, Placed& placed) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  using VD = V<decltype(d)>;
  HWY_ALIGN double p[3][8];
  for (std::size_t body = 0; body < 2; ++body) {
    const double* R = frame.rotation[body];
    const VD ratio = hn::Set(d, frame.ratio[body]);
    VD origin[3];
    for (std::size_t k = 0; k < 3; ++k) {
      origin[k] = hn::Set(d, frame.origin[body][k]);
    }
    for (std::size_t lane = 0; lane < 4; lane += hn::Lanes(d)) {
      const std::size_t place = 4 * body + lane;
      VD v[3];
      for (std::size_t k = 0; k < 3; ++k) {
        v[k] = hn::Mul(ratio, hn::PromoteTo(d, hn::LoadU(df, nodes[body].from.centre[k] + lane)));
      }
      if constexpr (kDeforms) {
        deform(frame, nodes[body], ratio, body, lane, v, placed);
      }
      VD rotated[3];
      rotate(d, R, v, origin, rotated);
      for (std::size_t k = 0; k < 3; ++k) {
        hn::StoreU(rotated[k], d, p[k] + place);
      }
    }
  }
  for (int k = 0; k < 3; ++k) {
    const double origin = p[k][0];
    for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
      const auto relative = hn::Sub(hn::LoadU(d, p[k] + lane), hn::Set(d, origin));
      hn::StoreU(hn::DemoteTo(df, relative), df, placed.centre[k] + lane);
    }
    for (int body = 0; body < 2; ++body) {
      placed.pivot[body][k] = static_cast<float>(frame.pivot[body][k] - origin);
    }
  }
}

/// Everything else, in single precision: the boxes of both bodies at once where the processor has
/// eight lanes, else of one after the other.
template <class D, bool kDeforms>
struct Placer {
  D d;
  static constexpr std::size_t kLanes = hn::MaxLanes(D());
  static constexpr bool kBoth = kLanes == 8;

  /// One value for the lanes of A, another for those of B.
  HWY_INLINE V<D> each(std::size_t first, float a, float b) const {
    if constexpr (kBoth) {
      const hn::Half<D> half;
      return Combine(d, hn::Set(half, b), hn::Set(half, a));
    } else {
      return hn::Set(d, first < 4 ? a : b);
    }
  }
  HWY_INLINE V<D> load(std::size_t first, const float* a, const float* b) const {
    if constexpr (kBoth) {
      const hn::Half<D> half;
      return Combine(d, hn::LoadU(half, b), hn::LoadU(half, a));
    } else {
      return hn::LoadU(d, (first < 4 ? a : b) + first % 4);
    }
  }
  HWY_INLINE hn::Mask<D> each_mask(std::size_t first, unsigned a, unsigned b) const {
    const auto bits = static_cast<std::uint8_t>((a | b << 4) >> first);
    std::uint8_t bytes[8] = {bits};
    return hn::LoadMaskBits(d, bytes);
  }
  HWY_INLINE V<D> load_extent(std::size_t first, const std::uint16_t* a,
                              const std::uint16_t* b) const {
    if constexpr (kBoth) {
      const hn::Half<D> half;
      return Combine(d, widen(half, b), widen(half, a));
    } else {
      return widen(d, (first < 4 ? a : b) + first % 4);
    }
  }

  HWY_INLINE void place(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                        std::size_t first, Placed& placed) const {
    V<D> v[3];
    V<D> e[3];
    V<D> c[3];
    V<D> lever[3];
    const V<D> ratio =
        each(first, static_cast<float>(frame.ratio[0]), static_cast<float>(frame.ratio[1]));
    for (int k = 0; k < 3; ++k) {
      v[k] = load(first, a.rotation[k], b.rotation[k]);
      if constexpr (kDeforms) {
        e[k] = hn::Load(d, placed.extent[k] + first);
      } else {
        e[k] = hn::Mul(ratio, load_extent(first, a.extent[k], b.extent[k]));
      }
      c[k] = hn::Load(d, placed.centre[k] + first);
      lever[k] = hn::Sub(c[k], each(first, placed.pivot[0][k], placed.pivot[1][k]));
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
    V<D> axes[3][3];
    place_axes(frame, first, v, axes, placed);
    place_turning(frame, first, axes, e, placed);
    place_velocity(frame, first, rate, lever, placed);
    for (int k = 0; k < 3 && !kDeforms; ++k) {
      hn::Store(e[k], d, placed.extent[k] + first);
    }
    hn::Store(radius, d, placed.radius + first);
    hn::Store(distance, d, placed.distance + first);
    hn::Store(reach, d, placed.reach + first);
    hn::Store(size, d, placed.size + first);
    const auto leaves = each_mask(first, a.leaves(), b.leaves());
    hn::Store(hn::IfThenElseZero(leaves, hn::Mul(hn::Set(d, kExtentDoubt), radius)), d,
              placed.doubt + first);
  }

  HWY_INLINE void place_velocity(const BoxFrame& frame, std::size_t first, V<D> rate,
                                 const V<D>* lever, Placed& placed) const {
    V<D> w[3];
    for (int k = 0; k < 3; ++k) {
      w[k] = hn::Mul(rate, each(first, frame.axis[0][k], frame.axis[1][k]));
    }
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3;
      const int j = (k + 2) % 3;
      const V<D> turning = hn::NegMulAdd(w[j], lever[i], hn::Mul(w[i], lever[j]));
      const V<D> pivot = each(first, frame.velocity[0][k], frame.velocity[1][k]);
      V<D> velocity = hn::Add(pivot, turning);
      if constexpr (kDeforms) {
        velocity = hn::Add(velocity, hn::Load(d, placed.drift[k] + first));
      }
      hn::Store(velocity, d, placed.velocity[k] + first);
    }
  }

  /// Box axes from the quaternion (w, x, y, z), turned by the body's rotation.
  HWY_INLINE void place_axes(const BoxFrame& frame, std::size_t first, const V<D>* v,
                             V<D> (*axes)[3], Placed& placed) const {
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

  /// How the two thinner axes turn against both bodies.
  HWY_INLINE void place_turning(const BoxFrame& frame, std::size_t first, const V<D> (*axes)[3],
                                const V<D>* e, Placed& placed) const {
    V<D> own[3];
    V<D> other[3];
    for (int k = 0; k < 3; ++k) {
      own[k] = each(first, frame.rate[0] * frame.axis[0][k], frame.rate[1] * frame.axis[1][k]);
      other[k] = each(first, frame.rate[1] * frame.axis[1][k], frame.rate[0] * frame.axis[0][k]);
    }
    for (int axis = 0; axis < 2; ++axis) {
      const V<D>* n = axes[axis];
      V<D> turning[3];
      cross(n, own, turning);
      hn::Store(root_up(d, dot(d, turning, turning)), d, placed.own_turn[axis] + first);
      const int i = 1 - axis;
      hn::Store(hn::MulAdd(e[i], hn::Abs(dot(d, axes[i], turning)),
                           hn::Mul(e[2], hn::Abs(dot(d, axes[2], turning)))),
                d, placed.swing[axis] + first);
      V<D> seen[3];
      hn::Store(turn_against(d, n, other, chord_end(frame), seen), d,
                placed.turn_of_other[axis] + first);
      for (int k = 0; k < 3; ++k) {
        hn::Store(seen[k], d, placed.seen[axis][k] + first);
      }
    }
  }
};

/// The pairs of lanes [first, first + N).
template <class D, bool kDeforms>
struct Pairs {
  D d;

  /// The four values of A's boxes, each for four lanes.
  HWY_INLINE V<D> box_of_a(const float* field, std::size_t first) const {
    if constexpr (hn::MaxLanes(D()) == 1) {
      return hn::Set(d, field[first / 4]);
    } else {
      alignas(64) static constexpr std::int32_t kBoxOfLane[16] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                                  2, 2, 2, 2, 3, 3, 3, 3};
      return hn::TableLookupLanes(hn::LoadDup128(d, field),
                                  hn::SetTableIndices(d, kBoxOfLane + first));
    }
  }
  /// The four values of B's boxes, again and again.
  HWY_INLINE V<D> box_of_b(const float* field, std::size_t first) const {
    if constexpr (hn::MaxLanes(D()) == 1) {
      return hn::Set(d, field[first % 4]);
    } else {
      return hn::LoadDup128(d, field);
    }
  }

  struct Best {
    V<D> gap;  // net of slack, along the direction that seems to stay open longest
    V<D> speed;
    V<D> twice_acceleration;
    V<D> largest_gap;  // of any direction, net of slack
    V<D> nearness;     // least distance of any gap from the middle of the band of doubt
  };

  struct Sizes {
    V<D> radius_a;
    V<D> radius_b;
    V<D> reach_a;
    V<D> reach_b;
    V<D> charge;    // threshold and slack
    V<D> spread_a;  // times its turn: what the extent may grow faster by than was told
    V<D> spread_b;
    V<D> slip;
    V<D> slip_acceleration;
    V<D> doubt_middle;
  };

  /// A direction n, |n| within kRoughness of 1; its length does not enter the time, as gap, speed
  /// and acceleration are all in proportion to it.
  struct Direction {
    V<D> raw_gap;
    V<D> opening;  // by the centres
    V<D> swing;    // how fast the extents grow; of bodies that deform without their turning
    V<D> turn_a;
    V<D> turn_b;
  };
  static constexpr int kDirections = 5;

  /// Each line is written for all directions before the next one, as processors wait for one
  /// direction's results otherwise.
  HWY_INLINE Best best_of(const Sizes& s, const Direction* n) const {
    V<D> gap[kDirections];
    V<D> speed[kDirections];
    V<D> twice_acceleration[kDirections];
    V<D> twice_open[kDirections];
    V<D> root[kDirections];
    V<D> estimate[kDirections];
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      gap[k] = hn::Sub(n[k].raw_gap, s.charge);
      speed[k] = hn::Add(n[k].swing, hn::Sub(s.slip, n[k].opening));
      twice_acceleration[k] = hn::MulAdd(n[k].turn_b, s.reach_b, s.slip_acceleration);
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      speed[k] = hn::MulAdd(n[k].turn_b, s.spread_b, speed[k]);
      twice_open[k] = hn::Max(hn::Add(gap[k], gap[k]), hn::Zero(d));
      twice_acceleration[k] = hn::MulAdd(n[k].turn_a, s.reach_a, twice_acceleration[k]);
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      speed[k] = hn::MulAdd(n[k].turn_a, s.spread_a, speed[k]);
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      root[k] =
          root_up(d, hn::MulAdd(twice_acceleration[k], twice_open[k], hn::Mul(speed[k], speed[k])));
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      const V<D> closing =
          hn::Max(hn::Add(speed[k], root[k]),
                  hn::MulAdd(hn::Abs(speed[k]), hn::Set(d, 1e-3f), hn::Set(d, kTiny)));
      estimate[k] = hn::Mul(twice_open[k], reciprocal(d, closing));
    }
    const V<D> longest = hn::Max(
        hn::Max(hn::Max(estimate[0], estimate[1]), hn::Max(estimate[2], estimate[3])), estimate[4]);
    Best best;
    best.gap = best.speed = best.twice_acceleration = hn::Zero(d);
    HWY_UNROLL(5)
    for (int k = kDirections - 1; k >= 0; --k) {
      const auto is_best = hn::Eq(estimate[k], longest);
      best.gap = hn::IfThenElse(is_best, gap[k], best.gap);
      best.speed = hn::IfThenElse(is_best, speed[k], best.speed);
      best.twice_acceleration =
          hn::IfThenElse(is_best, twice_acceleration[k], best.twice_acceleration);
    }
    best.largest_gap = gap[0];
    best.nearness = hn::Abs(hn::Add(gap[0], s.doubt_middle));
    HWY_UNROLL(5)
    for (int k = 1; k < kDirections; ++k) {
      best.largest_gap = hn::Max(best.largest_gap, gap[k]);
      best.nearness = hn::Min(best.nearness, hn::Abs(hn::Add(gap[k], s.doubt_middle)));
    }
    return best;
  }

  /// The extent of boxes along n; or, of the rates of their half extents, its rate.
  HWY_INLINE V<D> extent_along(const V<D>* n, const V<D> (*axes)[3], const V<D>* extent) const {
    V<D> sum = hn::Zero(d);
    for (int k = 0; k < 3; ++k) {
      sum = hn::MulAdd(hn::Abs(dot(d, n, axes[k])), extent[k], sum);
    }
    return sum;
  }

  /// The rate of the chord from an extent now to that along the direction that a box sees at the
  /// horizon; in between it is not more, as it is convex.
  HWY_INLINE V<D> chord(const BoxFrame& frame, V<D> now, V<D> at_horizon) const {
    return hn::Mul(hn::Sub(at_horizon, now), hn::Set(d, 1.0f / chord_end(frame)));
  }

  /// x with its sign turned where y is negative.
  HWY_INLINE V<D> with_sign(V<D> x, V<D> y) const { return hn::Xor(x, hn::And(y, hn::SignBit(d))); }

  /// time_to_close() of narrowphase/advance.h for half the acceleration, in single precision:
  /// 2 g / (m + sqrt(m^2 + 2 K g)); 0 where the gap is not open, or not a number. Exact roots and
  /// quotients, as tied pairs must stay tied.
  HWY_INLINE V<D> time_to_close(const BoxFrame& frame, const Best& best) const {
    const V<D> twice_open = hn::Max(hn::Add(best.gap, best.gap), hn::Zero(d));
    const V<D> root =
        hn::Sqrt(hn::MulAdd(best.twice_acceleration, twice_open, hn::Mul(best.speed, best.speed)));
    const V<D> closing =
        hn::Add(hn::Add(best.speed, root),
                hn::MulAdd(hn::Abs(best.speed), hn::Set(d, 0x1p-20f), hn::Set(d, kTiny)));
    const V<D> time = hn::Div(hn::Mul(twice_open, hn::Set(d, kTimeSlack)), closing);
    return hn::IfThenElseZero(hn::Gt(time, hn::Zero(d)),
                              hn::Min(time, hn::Set(d, chord_end(frame))));
  }

  template <class Mask>
  HWY_INLINE void store_bits(Mask mask, std::size_t first, std::uint16_t& bits) const {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    const unsigned value = bytes[0] | static_cast<unsigned>(bytes[1]) << 8;
    bits = static_cast<std::uint16_t>(bits | value << first);
  }

  HWY_INLINE void bound(const BoxFrame& frame, const Placed& placed, std::size_t first,
                        BoxBounds& bounds) const {
    const auto of_a = [&](const float* field) HWY_ATTR { return box_of_a(field, first); };
    const auto of_b = [&](const float* field) HWY_ATTR { return box_of_b(field + 4, first); };

    Sizes s;
    s.radius_a = of_a(placed.radius);
    s.radius_b = of_b(placed.radius);
    s.spread_a = hn::Mul(s.radius_a, hn::Set(d, kDeforms ? 1.0f : kSwingSlack));
    s.spread_b = hn::Mul(s.radius_b, hn::Set(d, kDeforms ? 1.0f : kSwingSlack));
    s.reach_a = of_a(placed.reach);
    s.reach_b = of_b(placed.reach);
    const V<D> slack = hn::MulAdd(hn::Add(of_a(placed.size), of_b(placed.size)),
                                  hn::Set(d, kGapSlack), hn::Set(d, kTinyLength));
    s.charge = hn::MulAdd(hn::Set(d, frame.threshold), hn::Set(d, 1.0f + 2.0f * kRoughness), slack);
    s.slip = hn::MulAdd(hn::Set(d, kSpeedSlack),
                        hn::Add(hn::Set(d, frame.speed), hn::Add(s.reach_a, s.reach_b)),
                        hn::Set(d, (1.0f + kRoughness) * frame.drift));
    constexpr float kLength = 1.0f + 2.0f * kRoughness;  // Of a direction, at most.
    const V<D> bend = hn::MulAdd(
        of_a(placed.distance), hn::Set(d, kLength * frame.bend_by_distance[0]),
        hn::MulAdd(of_b(placed.distance), hn::Set(d, kLength * frame.bend_by_distance[1]),
                   hn::Set(d, kLength * frame.bend)));
    s.slip_acceleration =
        hn::MulAdd(s.slip, hn::Set(d, 2.0f * (frame.rate[0] + frame.rate[1])), bend);

    const V<D> doubt = hn::Add(of_a(placed.doubt), of_b(placed.doubt));
    s.doubt_middle = hn::Mul(hn::Set(d, 0.5f), hn::Add(slack, doubt));

    V<D> between[3];
    V<D> velocity[3];
    V<D> axes_a[3][3];
    V<D> axes_b[3][3];
    V<D> extent_a[3];
    V<D> extent_b[3];
    V<D> growth_a[3];
    V<D> growth_b[3];
    for (int k = 0; k < 3; ++k) {
      growth_a[k] = kDeforms ? of_a(placed.growth[k]) : hn::Zero(d);
      growth_b[k] = kDeforms ? of_b(placed.growth[k]) : hn::Zero(d);
      between[k] = hn::Sub(of_b(placed.centre[k]), of_a(placed.centre[k]));
      velocity[k] = hn::Sub(of_b(placed.velocity[k]), of_a(placed.velocity[k]));
      extent_a[k] = of_a(placed.extent[k]);
      extent_b[k] = of_b(placed.extent[k]);
      for (int m = 0; m < 3; ++m) {
        axes_a[k][m] = of_a(placed.axes[k][m]);
        axes_b[k][m] = of_b(placed.axes[k][m]);
      }
    }

    V<D> extent_b_along[2] = {hn::Zero(d), hn::Zero(d)};
    V<D> extent_a_along[2] = {hn::Zero(d), hn::Zero(d)};
    V<D> growth_along_a[2] = {growth_a[0], growth_a[1]};  // Of both boxes, along A's axes.
    V<D> growth_along_b[2] = {growth_b[0], growth_b[1]};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (i == 2 && j == 2) {
          continue;
        }
        const V<D> cosine = hn::Abs(dot(d, axes_a[i], axes_b[j]));
        if (i < 2) {
          extent_b_along[i] = hn::MulAdd(cosine, extent_b[j], extent_b_along[i]);
          if constexpr (kDeforms) {
            growth_along_a[i] = hn::MulAdd(cosine, growth_b[j], growth_along_a[i]);
          }
        }
        if (j < 2) {
          extent_a_along[j] = hn::MulAdd(cosine, extent_a[i], extent_a_along[j]);
          if constexpr (kDeforms) {
            growth_along_b[j] = hn::MulAdd(cosine, growth_a[i], growth_along_b[j]);
          }
        }
      }
    }
    Direction directions[kDirections];
    HWY_UNROLL(2)
    for (int k = 0; k < 2; ++k) {
      V<D> swing_a = growth_along_a[k];
      V<D> swing_b = growth_along_b[k];
      if constexpr (!kDeforms) {
        V<D> seen_by_b[3];
        V<D> seen_by_a[3];
        for (int m = 0; m < 3; ++m) {
          seen_by_b[m] = of_a(placed.seen[k][m]);
          seen_by_a[m] = of_b(placed.seen[k][m]);
        }
        swing_a = hn::Add(of_a(placed.swing[k]), chord(frame, extent_b_along[k],
                                                       extent_along(seen_by_b, axes_b, extent_b)));
        swing_b = hn::Add(of_b(placed.swing[k]), chord(frame, extent_a_along[k],
                                                       extent_along(seen_by_a, axes_a, extent_a)));
      }
      const V<D> along_a = dot(d, axes_a[k], between);
      directions[2 * k] = {hn::Sub(hn::Abs(along_a), hn::Add(extent_a[k], extent_b_along[k])),
                           with_sign(dot(d, axes_a[k], velocity), along_a), swing_a,
                           of_a(placed.own_turn[k]), of_a(placed.turn_of_other[k])};
      const V<D> along_b = dot(d, axes_b[k], between);
      directions[2 * k + 1] = {hn::Sub(hn::Abs(along_b), hn::Add(extent_b[k], extent_a_along[k])),
                               with_sign(dot(d, axes_b[k], velocity), along_b), swing_b,
                               of_b(placed.turn_of_other[k]), of_b(placed.own_turn[k])};
    }
    directions[4] = centre_line(frame, between, velocity, axes_a, axes_b, extent_a, extent_b,
                                growth_a, growth_b);
    const Best best = best_of(s, directions);

    const V<D> time = time_to_close(frame, best);
    hn::Store(time, d, bounds.time + first);
    // A direction may be longer than 1, and the gap along it by as much.
    const V<D> gap =
        hn::MulAdd(best.largest_gap, hn::Set(d, 1.0f - kRoughness), hn::Set(d, frame.threshold));
    hn::Store(gap, d, bounds.gap + first);
    store_bits(hn::Not(hn::Ge(time, hn::Set(d, frame.horizon))), first, bounds.live);
    store_bits(hn::Gt(gap, hn::Mul(hn::Set(d, frame.far), hn::Add(s.radius_a, s.radius_b))), first,
               bounds.far);
    store_bits(hn::Gt(s.radius_a, hn::Mul(hn::Set(d, frame.larger), s.radius_b)), first,
               bounds.larger_a);
    store_bits(hn::Gt(s.radius_b, hn::Mul(hn::Set(d, frame.larger), s.radius_a)), first,
               bounds.larger_b);
    // A gap of -(slack + doubt) to 2 slack may be one that double precision finds open.
    const auto sure = hn::And(hn::Gt(best.nearness, hn::Add(s.doubt_middle, slack)),
                              hn::Lt(s.charge, hn::Set(d, kLargest)));
    store_bits(hn::Not(sure), first, bounds.unsure);
  }

  HWY_INLINE Direction centre_line(const BoxFrame& frame, const V<D>* between, const V<D>* velocity,
                                   const V<D> (*axes_a)[3], const V<D> (*axes_b)[3],
                                   const V<D>* extent_a, const V<D>* extent_b, const V<D>* growth_a,
                                   const V<D>* growth_b) const {
    const V<D> square = dot(d, between, between);
    const V<D> scale = reciprocal_root(d, hn::Add(square, hn::Set(d, kTiny * kTiny)));
    V<D> n[3];
    for (int k = 0; k < 3; ++k) {
      n[k] = hn::Mul(between[k], scale);
    }
    const V<D> extent =
        hn::Add(extent_along(n, axes_a, extent_a), extent_along(n, axes_b, extent_b));
    V<D> turn[2];
    V<D> seen[2][3];  // by A and B at the horizon
    for (int body = 0; body < 2; ++body) {
      V<D> spin[3];
      for (int k = 0; k < 3; ++k) {
        spin[k] = hn::Set(d, frame.rate[body] * frame.axis[body][k]);
      }
      turn[body] = turn_against(d, n, spin, chord_end(frame), seen[body]);
    }
    V<D> swing;
    if constexpr (kDeforms) {
      swing = hn::Add(extent_along(n, axes_a, growth_a), extent_along(n, axes_b, growth_b));
    } else {
      swing = chord(frame, extent,
                    hn::Add(extent_along(seen[0], axes_a, extent_a),
                            extent_along(seen[1], axes_b, extent_b)));
    }
    return {hn::Sub(dot(d, n, between), extent), dot(d, n, velocity), swing, turn[0], turn[1]};
  }
};

template <bool kDeforms>
HWY_INLINE void bound(const BoxFrame& frame, const NodeAtEnds& a, const NodeAtEnds& b,
                      BoxBounds& bounds) {
  Placed placed;
  const NodeAtEnds nodes[2] = {a, b};
  place_centres<kDeforms>(frame, nodes, placed);
  const Placer<hn::CappedTag<float, 8>, kDeforms> placer;
  for (std::size_t first = 0; first < 8; first += hn::Lanes(placer.d)) {
    placer.place(frame, a.from, b.from, first, placed);
  }
  bounds.live = bounds.far = bounds.larger_a = bounds.larger_b = bounds.unsure = 0;
  const Pairs<hn::CappedTag<float, 16>, kDeforms> pairs;
  for (std::size_t first = 0; first < 16; first += hn::Lanes(pairs.d)) {
    pairs.bound(frame, placed, first, bounds);
  }
}

void BoundBoxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                BoxBounds& bounds) {
  bound<false>(frame, {a, a}, {b, b}, bounds);
}

void BoundDeformingBoxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& a_to,
                         const HierarchyNode& b, const HierarchyNode& b_to, BoxBounds& bounds) {
  bound<true>(frame, {a, a_to}, {b, b_to}, bounds);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {

HWY_EXPORT(BoundBoxes);
HWY_EXPORT(BoundDeformingBoxes);

void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(BoundBoxes)(frame, a, b, bounds);
}

void bound_deforming_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& a_to,
                           const HierarchyNode& b, const HierarchyNode& b_to, BoxBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(BoundDeformingBoxes)(frame, a, a_to, b, b_to, bounds);
}

std::int64_t box_bounds_targets() { return HWY_TARGETS & hwy::SupportedTargets(); }

}  // namespace firstcontact::detail
#endif
