#include <firstcontact/query/detail/box_bounds.h>

#include <algorithm>
#include <array>

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
//  - Velocities: cross and dot products add up to 10 u of |s| + w_A rho_A + w_B rho_B, as positions
//    relative to the pivot are formed in double; w (n x u) to 4 u w, and as part of an extent to
//    4 u sqrt(3) w r.
//  - Extents at the horizon, along m = n + H w (n x u): 24 u sqrt(3) r |m|. Of two extents that are
//    interpolated each error counts by its share; with |m| <= 1 + H w |n x u| the gap's slack has
//    24 u sqrt(3) r. The other box's axes b see w (n x u) . b_k as (n . b_i) (w . b_j) - (n . b_j)
//    (w . b_i), which is w (n x u) . (b_i x b_j) and thus within 40 u w |n x u|, and 9 u w for
//    rounding. All in all 16 u w r of the speed, and 70 u r w |n x u|, for which is kSwingSlack.
//  - Bodies that deform: boxes are interpolated in double; sums of the rates of centres and
//    extents, each at most 2 D, err by less than 80 u D, for which the frame's speed has 4 D more.
constexpr float kGapSlack = 0x1p-18f;
constexpr float kSpeedSlack = 0x1p-19f;
constexpr float kSwingSlack = 0x1p-17f;
constexpr float kTimeSlack = 1.0f - 0x1p-18f;
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
constexpr float kRoughness = HWY_TARGET <= HWY_AVX3 ? 0x1p-13f : 0x1p-11f;
#else
constexpr float kRoughness = 0x1p-18f;
#endif
constexpr float kSmallestGap = 0x1p-40f;  // Of which the reciprocal is taken.
constexpr float kTiny = 0x1p-60f;         // Above what underflow can lose in a square.
constexpr float kTinyLength = 0x1p-100f;  // Above what extents can lose when their unit is scaled.
constexpr float kExtentDoubt = 0x1p-9f;   // Of the radius: above what extents were rounded up by.
constexpr float kLargest = 1e30f;         // Beyond, products may overflow.
constexpr float kShortest = 0x1p-40f;     // Of the times until which extents are followed.

template <class D>
using V = hn::Vec<D>;

/// Boxes placed in the frame: four of A's node in each pair of nodes, then those of B's.
template <std::size_t kPlaces>
struct alignas(64) Placed {
  alignas(64) float lever[3][kPlaces];  // of the centre, from its body's pivot
  float centre[3][kPlaces];             // relative to a point beside the pair of nodes
  float velocity[3][kPlaces];
  float axes[3][3][kPlaces];  // axis, component
  float extent[3][kPlaces];
  float radius[kPlaces];
  float distance[kPlaces];  // of any point from the pivot
  float reach[kPlaces];     // the same times the rate
  float slack[kPlaces];     // its share of the gap's
  float doubt[kPlaces];     // half of it, and of how much a triangle's box may be too thick
  float swept[3][kPlaces];  // rotation vector of its body until the horizon, in its own axes
  // For axes 0 and 1:
  float own_turn[2][kPlaces];       // w |n x u| of the box's own body
  float turn_of_other[2][kPlaces];  // and of the other one
  float swing[2][kPlaces];          // rate of the box's own extent, as it turns
  // Of bodies that deform:
  float drift[3][kPlaces];   // velocity of the centre as its body sees it, in the frame's axes
  float growth[3][kPlaces];  // rate of the extent
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

/// One of A, one of B.
using NodePair = std::array<NodeAtEnds, 2>;

/// What get(tag, lane) says of the lanes from that one on, which are at most four, of one node.
template <class D, class Get>
HWY_INLINE V<D> of_parts(D d, std::size_t first, const Get& get) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return Combine(d, of_parts(half, first + hn::MaxLanes(half), get), of_parts(half, first, get));
  } else {
    return get(d, first);
  }
}

template <class D>
HWY_INLINE V<D> dot(D, const V<D>* x, const V<D>* y) {
  return hn::MulAdd(x[0], y[0], hn::MulAdd(x[1], y[1], hn::Mul(x[2], y[2])));
}

/// Within 3/4 kRoughness of 1 / x and 1 / sqrt(x): x86 promises 2^-14 for the whole registers of
/// AVX-512 and 1.5 x 2^-12 for others; elsewhere they are exact up to rounding.
template <class D>
HWY_INLINE V<D> reciprocal(D d, V<D> x) {
  static_assert(kRoughness > 0x1p-12f || kRoughness < 0x1p-15f || hn::MaxLanes(D()) == 16);
  if constexpr (kRoughness > 0x1p-15f) {
    (void)d;
    return hn::ApproximateReciprocal(x);
  } else {
    return hn::Div(hn::Set(d, 1.0f), x);
  }
}
template <class D>
HWY_INLINE V<D> reciprocal_root(D d, V<D> x) {
  static_assert(kRoughness > 0x1p-12f || kRoughness < 0x1p-15f || hn::MaxLanes(D()) == 16);
  if constexpr (kRoughness > 0x1p-15f) {
    (void)d;
    return hn::ApproximateReciprocalSqrt(x);
  } else {
    return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(x));
  }
}

/// At least sqrt(x), and hardly more, if x >= 0 is below by a few units in the last place.
template <class D>
HWY_INLINE V<D> root_up(D d, V<D> x) {
  return hn::Mul(hn::Sqrt(hn::Add(x, hn::Set(d, kTiny * kTiny))), hn::Set(d, 1.0f + 0x1p-21f));
}

template <class VD>
HWY_INLINE void cross(const VD* x, const VD* y, VD* product) {
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    product[k] = hn::NegMulAdd(x[j], y[i], hn::Mul(x[i], y[j]));
  }
}

template <class DF>
HWY_INLINE V<DF> widen(DF df, V<hn::Rebind<std::uint16_t, DF>> extent) {
  const hn::Rebind<std::uint32_t, DF> d32;
  const auto code = hn::PromoteTo(d32, extent);
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
  constexpr std::size_t kBoxes = 4 * kPairs;  // Of each body.
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

/// Everything else, in single precision: of as many boxes at once as the processor has lanes.
template <class D, bool kDeforms, std::size_t kPairs>
struct Placer {
  D d;
  const BoxFrame& frame;
  const NodePair* pairs;
  Placed<8 * kPairs>& placed;
  static constexpr std::size_t kBoxes = 4 * kPairs;  // Of each body.
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

  /// How the two thinner axes turn against both bodies.
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

/// The pairs of lanes [first, first + N) of one pair of nodes.
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
    V<D> twice_reach_a;
    V<D> twice_reach_b;
    V<D> charge;    // threshold and slack
    V<D> spread_a;  // times its turn: what the extent may grow faster by than was told
    V<D> spread_b;
    V<D> slip;
    V<D> twice_slip_acceleration;
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

  /// The direction along which the gap seems to stay open longest: by twice the reciprocal of that
  /// time, m / g + sqrt((m / g)^2 + 2 K / g), which is about 0 where the gap opens.
  ///
  /// Each line is written for all directions before the next one, as processors wait for one
  /// direction's results otherwise.
  HWY_INLINE Best best_of(const Sizes& s, const Direction* n) const {
    V<D> gap[kDirections];
    V<D> speed[kDirections];
    V<D> twice_acceleration[kDirections];
    V<D> per_gap[kDirections];
    V<D> slope[kDirections];
    V<D> square[kDirections];
    V<D> haste[kDirections];
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      gap[k] = hn::Sub(n[k].raw_gap, s.charge);
      speed[k] = hn::Add(n[k].swing, hn::Sub(s.slip, n[k].opening));
      twice_acceleration[k] = hn::MulAdd(n[k].turn_b, s.twice_reach_b, s.twice_slip_acceleration);
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      per_gap[k] = reciprocal(d, gap[k]);
      speed[k] = hn::MulAdd(n[k].turn_b, s.spread_b, speed[k]);
      twice_acceleration[k] = hn::MulAdd(n[k].turn_a, s.twice_reach_a, twice_acceleration[k]);
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      speed[k] = hn::MulAdd(n[k].turn_a, s.spread_a, speed[k]);
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      slope[k] = hn::Mul(speed[k], per_gap[k]);
      square[k] = hn::MulAdd(twice_acceleration[k], per_gap[k], hn::Set(d, kTiny));
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      square[k] = hn::MulAdd(slope[k], slope[k], square[k]);
    }
    HWY_UNROLL(5)
    for (int k = 0; k < kDirections; ++k) {
      haste[k] = hn::MulAdd(square[k], reciprocal_root(d, square[k]), slope[k]);
      haste[k] =
          hn::IfThenElse(hn::Gt(gap[k], hn::Set(d, kSmallestGap)), haste[k], hn::Set(d, kLargest));
    }
    const V<D> least =
        hn::Min(hn::Min(hn::Min(haste[0], haste[1]), hn::Min(haste[2], haste[3])), haste[4]);
    Best best;
    best.gap = best.speed = best.twice_acceleration = hn::Zero(d);
    HWY_UNROLL(5)
    for (int k = kDirections - 1; k >= 0; --k) {
      const auto is_best = hn::Eq(haste[k], least);
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

  /// The extent of a box along a direction that has these components along its axes; or, of the
  /// rates of its half extents, its rate.
  HWY_INLINE V<D> extent_along(const V<D>* n, const V<D>* extent) const {
    return hn::MulAdd(hn::Abs(n[0]), extent[0],
                      hn::MulAdd(hn::Abs(n[1]), extent[1], hn::Mul(hn::Abs(n[2]), extent[2])));
  }

  /// The same at the horizon, along the direction that the turning box then sees.
  HWY_INLINE V<D> extent_at_horizon(const V<D>* n, const V<D>* swept, const V<D>* extent) const {
    V<D> seen[3];
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3;
      const int j = (k + 2) % 3;
      seen[k] = hn::MulAdd(n[i], swept[j], hn::NegMulAdd(n[j], swept[i], n[k]));
    }
    return extent_along(seen, extent);
  }

  /// At least w |n x u| of a body that turns, from what it turns until the horizon; n as above.
  HWY_INLINE V<D> turn_against(const BoxFrame& frame, const V<D>* n, const V<D>* swept) const {
    V<D> turning[3];
    cross(n, swept, turning);
    const V<D> square = hn::Add(dot(d, turning, turning), hn::Set(d, kTiny * kTiny));
    return hn::Mul(hn::Mul(square, reciprocal_root(d, square)),
                   hn::Set(d, (1.0f + kRoughness) / chord_end(frame)));
  }

  /// The rate of the chord from an extent now to that at the horizon, and more; in between it is
  /// not more, as it is convex.
  HWY_INLINE V<D> chord(const BoxFrame& frame, V<D> now, V<D> at_horizon, V<D> more) const {
    return hn::MulAdd(hn::Sub(at_horizon, now), hn::Set(d, 1.0f / chord_end(frame)), more);
  }

  /// x with its sign turned where y is negative.
  HWY_INLINE V<D> with_sign(V<D> x, V<D> y) const { return hn::Xor(x, hn::And(y, hn::SignBit(d))); }

  /// time_to_close() of math/root_isolation.h for half the acceleration, in single precision:
  /// 2 g / (m + sqrt(m^2 + 2 K g)); 0 where the gap is not open, or not a number. Exact roots and
  /// quotients, as tied pairs must stay tied.
  HWY_INLINE V<D> time_to_close(const BoxFrame& frame, const Best& best) const {
    const V<D> open = hn::Max(best.gap, hn::Zero(d));
    const V<D> root =
        hn::Sqrt(hn::MulAdd(best.twice_acceleration, open, hn::Mul(best.speed, best.speed)));
    const V<D> closing =
        hn::Add(hn::Add(best.speed, root),
                hn::MulAdd(hn::Abs(best.speed), hn::Set(d, 0x1p-20f), hn::Set(d, kTiny)));
    const V<D> time = hn::Div(hn::Mul(open, hn::Set(d, 2.0f * kTimeSlack)), closing);
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

  template <std::size_t kPlaces>
  HWY_INLINE void bound(const BoxFrame& frame, const Placed<kPlaces>& placed, std::size_t pair,
                        std::size_t first, BoxBounds& bounds) const {
    const auto of_a = [&](const float* field)
                          HWY_ATTR { return box_of_a(field + 4 * pair, first); };
    const auto of_b = [&](const float* field)
                          HWY_ATTR { return box_of_b(field + kPlaces / 2 + 4 * pair, first); };

    Sizes s;
    s.radius_a = of_a(placed.radius);
    s.radius_b = of_b(placed.radius);
    s.spread_a = hn::Mul(s.radius_a, hn::Set(d, kDeforms ? 1.0f : kSwingSlack));
    s.spread_b = hn::Mul(s.radius_b, hn::Set(d, kDeforms ? 1.0f : kSwingSlack));
    const V<D> reach_a = of_a(placed.reach);
    const V<D> reach_b = of_b(placed.reach);
    s.twice_reach_a = hn::Add(reach_a, reach_a);
    s.twice_reach_b = hn::Add(reach_b, reach_b);
    const V<D> slack = hn::Add(of_a(placed.slack), of_b(placed.slack));
    s.charge = hn::MulAdd(hn::Set(d, frame.threshold), hn::Set(d, 1.0f + 2.0f * kRoughness), slack);
    s.slip = hn::MulAdd(hn::Set(d, kSpeedSlack),
                        hn::Add(hn::Set(d, frame.speed), hn::Add(reach_a, reach_b)),
                        hn::Set(d, (1.0f + kRoughness) * frame.drift));
    constexpr float kLength =
        2.0f * (1.0f + 2.0f * kRoughness);  // Twice that of a direction, at most.
    const V<D> bend = hn::MulAdd(
        of_a(placed.distance), hn::Set(d, kLength * frame.bend_by_distance[0]),
        hn::MulAdd(of_b(placed.distance), hn::Set(d, kLength * frame.bend_by_distance[1]),
                   hn::Set(d, kLength * frame.bend)));
    s.twice_slip_acceleration =
        hn::MulAdd(s.slip, hn::Set(d, 4.0f * (frame.rate[0] + frame.rate[1])), bend);

    s.doubt_middle = hn::Add(of_a(placed.doubt), of_b(placed.doubt));

    V<D> between[3];
    V<D> velocity[3];
    V<D> axes_a[3][3];
    V<D> axes_b[3][3];
    V<D> extent_a[3];
    V<D> extent_b[3];
    V<D> growth_a[3];
    V<D> growth_b[3];
    V<D> swept_a[3];
    V<D> swept_b[3];
    for (int k = 0; k < 3; ++k) {
      growth_a[k] = kDeforms ? of_a(placed.growth[k]) : hn::Zero(d);
      growth_b[k] = kDeforms ? of_b(placed.growth[k]) : hn::Zero(d);
      between[k] = hn::Sub(of_b(placed.centre[k]), of_a(placed.centre[k]));
      velocity[k] = hn::Sub(of_b(placed.velocity[k]), of_a(placed.velocity[k]));
      extent_a[k] = of_a(placed.extent[k]);
      extent_b[k] = of_b(placed.extent[k]);
      swept_a[k] = of_a(placed.swept[k]);
      swept_b[k] = of_b(placed.swept[k]);
      for (int m = 0; m < 3; ++m) {
        axes_a[k][m] = of_a(placed.axes[k][m]);
        axes_b[k][m] = of_b(placed.axes[k][m]);
      }
    }

    V<D> along_a[3];  // Between the centres.
    V<D> along_b[3];
    for (int k = 0; k < 3; ++k) {
      along_a[k] = dot(d, axes_a[k], between);
      along_b[k] = dot(d, axes_b[k], between);
    }
    V<D> a_in_b[2][3];  // The thinner axes of each box along those of the other.
    V<D> b_in_a[2][3];
    for (int k = 0; k < 2; ++k) {
      for (int m = 0; m < 3; ++m) {
        a_in_b[k][m] = dot(d, axes_a[k], axes_b[m]);
      }
    }
    for (int k = 0; k < 2; ++k) {
      b_in_a[k][0] = a_in_b[0][k];
      b_in_a[k][1] = a_in_b[1][k];
      b_in_a[k][2] = dot(d, axes_a[2], axes_b[k]);
    }
    Direction directions[kDirections];
    HWY_UNROLL(2)
    for (int k = 0; k < 2; ++k) {
      const V<D> extent_b_along = extent_along(a_in_b[k], extent_b);
      const V<D> extent_a_along = extent_along(b_in_a[k], extent_a);
      V<D> swing_a;
      V<D> swing_b;
      if constexpr (kDeforms) {
        swing_a = hn::Add(growth_a[k], extent_along(a_in_b[k], growth_b));
        swing_b = hn::Add(growth_b[k], extent_along(b_in_a[k], growth_a));
      } else {
        swing_a = chord(frame, extent_b_along, extent_at_horizon(a_in_b[k], swept_b, extent_b),
                        of_a(placed.swing[k]));
        swing_b = chord(frame, extent_a_along, extent_at_horizon(b_in_a[k], swept_a, extent_a),
                        of_b(placed.swing[k]));
      }
      directions[2 * k] = {hn::Sub(hn::Abs(along_a[k]), hn::Add(extent_a[k], extent_b_along)),
                           with_sign(dot(d, axes_a[k], velocity), along_a[k]), swing_a,
                           of_a(placed.own_turn[k]), of_a(placed.turn_of_other[k])};
      directions[2 * k + 1] = {hn::Sub(hn::Abs(along_b[k]), hn::Add(extent_b[k], extent_a_along)),
                               with_sign(dot(d, axes_b[k], velocity), along_b[k]), swing_b,
                               of_b(placed.turn_of_other[k]), of_b(placed.own_turn[k])};
    }
    const V<D> square = dot(d, between, between);
    const V<D> scale = reciprocal_root(d, hn::Add(square, hn::Set(d, kTiny * kTiny)));
    V<D> line_in_a[3];
    V<D> line_in_b[3];
    for (int k = 0; k < 3; ++k) {
      line_in_a[k] = hn::Mul(scale, along_a[k]);
      line_in_b[k] = hn::Mul(scale, along_b[k]);
    }
    const V<D> extent =
        hn::Add(extent_along(line_in_a, extent_a), extent_along(line_in_b, extent_b));
    V<D> swing;
    if constexpr (kDeforms) {
      swing = hn::Add(extent_along(line_in_a, growth_a), extent_along(line_in_b, growth_b));
    } else {
      swing = chord(frame, extent,
                    hn::Add(extent_at_horizon(line_in_a, swept_a, extent_a),
                            extent_at_horizon(line_in_b, swept_b, extent_b)),
                    hn::Zero(d));
    }
    directions[4] = {
        hn::Sub(hn::Mul(square, scale), extent), hn::Mul(dot(d, between, velocity), scale), swing,
        turn_against(frame, line_in_a, swept_a), turn_against(frame, line_in_b, swept_b)};
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
};

template <bool kDeforms, std::size_t kPairs>
HWY_INLINE void bound(const BoxFrame& frame, const NodePair (&pairs)[kPairs],
                      BoxBounds* const* bounds) {
  Placed<8 * kPairs> placed;
  place_centres<kDeforms, kPairs>(frame, pairs, placed);
  using D = hn::CappedTag<float, 8 * kPairs>;
  const Placer<D, kDeforms, kPairs> placer{D(), frame, pairs, placed};
  for (std::size_t first = 0; first < 8 * kPairs; first += hn::Lanes(placer.d)) {
    placer.place(first);
  }
  if constexpr (kPairs > 1) {
    // Compilers would keep what is placed in registers and shuffle it from there for each pair. The
    // processor does that while it loads, and has better use for the ports of shuffles.
    asm volatile("" : : "r"(&placed) : "memory");
  }
  const Pairs<hn::CappedTag<float, 16>, kDeforms> lanes;
  HWY_UNROLL(2)
  for (std::size_t k = 0; k < kPairs; ++k) {
    bounds[k]->live = bounds[k]->far = bounds[k]->unsure = 0;
    bounds[k]->larger_a = bounds[k]->larger_b = 0;
    for (std::size_t first = 0; first < 16; first += hn::Lanes(lanes.d)) {
      lanes.bound(frame, placed, k, first, *bounds[k]);
    }
  }
}

void BoundBoxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                BoxBounds& bounds) {
  const NodePair pairs[] = {{{{a, a}, {b, b}}}};
  BoxBounds* const all[] = {&bounds};
  bound<false>(frame, pairs, all);
}

void BoundTwice(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                BoxBounds& bounds, const HierarchyNode& other_a, const HierarchyNode& other_b,
                BoxBounds& other_bounds) {
  const NodePair pairs[] = {{{{a, a}, {b, b}}}, {{{other_a, other_a}, {other_b, other_b}}}};
  BoxBounds* const all[] = {&bounds, &other_bounds};
  bound<false>(frame, pairs, all);
}

void BoundDeformingBoxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& a_to,
                         const HierarchyNode& b, const HierarchyNode& b_to, BoxBounds& bounds) {
  const NodePair pairs[] = {{{{a, a_to}, {b, b_to}}}};
  BoxBounds* const all[] = {&bounds};
  bound<true>(frame, pairs, all);
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact::detail {

HWY_EXPORT(BoundBoxes);
HWY_EXPORT(BoundTwice);
HWY_EXPORT(BoundDeformingBoxes);

void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(BoundBoxes)(frame, a, b, bounds);
}

void bound_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& b,
                 BoxBounds& bounds, const HierarchyNode& other_a, const HierarchyNode& other_b,
                 BoxBounds& other_bounds) {
  HWY_DYNAMIC_DISPATCH(BoundTwice)(frame, a, b, bounds, other_a, other_b, other_bounds);
}

void bound_deforming_boxes(const BoxFrame& frame, const HierarchyNode& a, const HierarchyNode& a_to,
                           const HierarchyNode& b, const HierarchyNode& b_to, BoxBounds& bounds) {
  HWY_DYNAMIC_DISPATCH(BoundDeformingBoxes)(frame, a, a_to, b, b_to, bounds);
}

std::int64_t box_bounds_targets() { return HWY_TARGETS & hwy::SupportedTargets(); }

}  // namespace firstcontact::detail
#endif
