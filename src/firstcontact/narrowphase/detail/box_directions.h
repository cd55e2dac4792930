/// @file
/// The time for which pairs of placed boxes stay apart, along five directions.
///
/// Included once for each instruction set.

#if defined(FIRSTCONTACT_QUERY_DETAIL_BOX_DIRECTIONS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRSTCONTACT_QUERY_DETAIL_BOX_DIRECTIONS_H
#undef FIRSTCONTACT_QUERY_DETAIL_BOX_DIRECTIONS_H
#else
#define FIRSTCONTACT_QUERY_DETAIL_BOX_DIRECTIONS_H
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include <firstcontact/narrowphase/detail/box_bounds.h>
#include <firstcontact/narrowphase/detail/box_lanes.h>
#include <firstcontact/narrowphase/detail/placed_boxes.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
  /// The four values of B's boxes, repeated.
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
    V<D> largest_gap;  // The largest gap of any direction, net of slack.
    V<D> nearness;     // least distance of any gap from the middle of the band of doubt
  };

  struct Sizes {
    V<D> radius_a;
    V<D> radius_b;
    V<D> twice_reach_a;
    V<D> twice_reach_b;
    V<D> charge;    // Threshold and slack.
    V<D> spread_a;  // Times its turn: addition to the rate of the extent.
    V<D> spread_b;
    V<D> slip;
    V<D> twice_slip_acceleration;
    V<D> slack;
    V<D> doubt_middle;
  };

  /// Both boxes of each lane, placed.
  struct Boxes {
    V<D> between[3];  // The centres, from A to B.
    V<D> velocity[3];
    V<D> axes_a[3][3];
    V<D> axes_b[3][3];
    V<D> extent_a[3];
    V<D> extent_b[3];
    V<D> growth_a[3];
    V<D> growth_b[3];
    V<D> swept_a[3];
    V<D> swept_b[3];
    V<D> along_a[3];  // Between the centres, along the axes.
    V<D> along_b[3];
  };

  /// A direction n, with |n| within kRoughness of 1.
  ///
  /// Its length does not enter the time, as gap, speed and acceleration are all in proportion to
  /// it.
  struct Direction {
    V<D> raw_gap;
    V<D> opening;  // Rate of the gap by the centres.
    V<D> swing;    // Rate at which the extents grow; for deforming bodies without their turning.
    V<D> turn_a;
    V<D> turn_b;
  };
  static constexpr int kDirections = 5;

  /// The direction along which the gap seems to stay open longest.
  ///
  /// Directions are compared by twice the reciprocal of that time, m / g + sqrt((m / g)^2 + 2
  /// K / g). It is about 0 where the gap opens.
  ///
  /// Each line is written for all directions before the next one. Otherwise processors wait for the
  /// results of one direction.
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

  /// The extent of a box along a direction with these components along its axes; for the rates of
  /// half extents, the rate of the extent.
  HWY_INLINE V<D> extent_along(const V<D>* n, const V<D>* extent) const {
    return hn::MulAdd(hn::Abs(n[0]), extent[0],
                      hn::MulAdd(hn::Abs(n[1]), extent[1], hn::Mul(hn::Abs(n[2]), extent[2])));
  }

  /// The extent at the horizon, along the direction as seen from the turning box.
  HWY_INLINE V<D> extent_at_horizon(const V<D>* n, const V<D>* swept, const V<D>* extent) const {
    V<D> seen[3];
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3;
      const int j = (k + 2) % 3;
      seen[k] = hn::MulAdd(n[i], swept[j], hn::NegMulAdd(n[j], swept[i], n[k]));
    }
    return extent_along(seen, extent);
  }

  /// At least w |n x u| of a body that turns, from its turn until the horizon; n as above.
  HWY_INLINE V<D> turn_against(const BoxFrame& frame, const V<D>* n, const V<D>* swept) const {
    V<D> turning[3];
    cross(n, swept, turning);
    const V<D> square = hn::Add(dot(d, turning, turning), hn::Set(d, kTiny * kTiny));
    return hn::Mul(hn::Mul(square, reciprocal_root(d, square)),
                   hn::Set(d, (1.0f + kRoughness) / chord_end(frame)));
  }

  /// The rate of the chord from an extent now to that at the horizon, plus `more`.
  ///
  /// An extent is convex, so in between it is not above the chord.
  HWY_INLINE V<D> chord(const BoxFrame& frame, V<D> now, V<D> at_horizon, V<D> more) const {
    return hn::MulAdd(hn::Sub(at_horizon, now), hn::Set(d, 1.0f / chord_end(frame)), more);
  }

  /// x with its sign turned where y is negative.
  HWY_INLINE V<D> with_sign(V<D> x, V<D> y) const { return hn::Xor(x, hn::And(y, hn::SignBit(d))); }

  /// The time until the gap closes: 2 g / (m + sqrt(m^2 + 2 K g)).
  ///
  /// It is 0 where the gap is not open, or not a number. See time_to_close() of
  /// math/root_isolation.h; K here is half of the acceleration there, in single precision. Roots
  /// and quotients are exact, as tied pairs must stay tied.
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

  template <class OfA, class OfB, std::size_t kPlaces>
  HWY_INLINE Sizes sizes_of(const BoxFrame& frame, const Placed<kPlaces>& placed, const OfA& of_a,
                            const OfB& of_b) const {
    Sizes s;
    s.radius_a = of_a(placed.radius);
    s.radius_b = of_b(placed.radius);
    s.spread_a = hn::Mul(s.radius_a, hn::Set(d, kDeforms ? 1.0f : kSwingSlack));
    s.spread_b = hn::Mul(s.radius_b, hn::Set(d, kDeforms ? 1.0f : kSwingSlack));
    const V<D> reach_a = of_a(placed.reach);
    const V<D> reach_b = of_b(placed.reach);
    s.twice_reach_a = hn::Add(reach_a, reach_a);
    s.twice_reach_b = hn::Add(reach_b, reach_b);
    s.slack = hn::Add(of_a(placed.slack), of_b(placed.slack));
    s.charge =
        hn::MulAdd(hn::Set(d, frame.threshold), hn::Set(d, 1.0f + 2.0f * kRoughness), s.slack);
    s.slip = hn::MulAdd(hn::Set(d, kSpeedSlack),
                        hn::Add(hn::Set(d, frame.speed), hn::Add(reach_a, reach_b)),
                        hn::Set(d, (1.0f + kRoughness) * frame.drift));
    constexpr float kLength =
        2.0f * (1.0f + 2.0f * kRoughness);  // At most twice the length of a direction.
    const V<D> bend = hn::MulAdd(
        of_a(placed.distance), hn::Set(d, kLength * frame.bend_by_distance[0]),
        hn::MulAdd(of_b(placed.distance), hn::Set(d, kLength * frame.bend_by_distance[1]),
                   hn::Set(d, kLength * frame.bend)));
    s.twice_slip_acceleration =
        hn::MulAdd(s.slip, hn::Set(d, 4.0f * (frame.rate[0] + frame.rate[1])), bend);
    s.doubt_middle = hn::Add(of_a(placed.doubt), of_b(placed.doubt));
    return s;
  }

  template <class OfA, class OfB, std::size_t kPlaces>
  HWY_INLINE Boxes boxes_of(const Placed<kPlaces>& placed, const OfA& of_a, const OfB& of_b) const {
    Boxes boxes;
    for (int k = 0; k < 3; ++k) {
      boxes.growth_a[k] = kDeforms ? of_a(placed.growth[k]) : hn::Zero(d);
      boxes.growth_b[k] = kDeforms ? of_b(placed.growth[k]) : hn::Zero(d);
      boxes.between[k] = hn::Sub(of_b(placed.centre[k]), of_a(placed.centre[k]));
      boxes.velocity[k] = hn::Sub(of_b(placed.velocity[k]), of_a(placed.velocity[k]));
      boxes.extent_a[k] = of_a(placed.extent[k]);
      boxes.extent_b[k] = of_b(placed.extent[k]);
      boxes.swept_a[k] = of_a(placed.swept[k]);
      boxes.swept_b[k] = of_b(placed.swept[k]);
      for (int m = 0; m < 3; ++m) {
        boxes.axes_a[k][m] = of_a(placed.axes[k][m]);
        boxes.axes_b[k][m] = of_b(placed.axes[k][m]);
      }
    }
    for (int k = 0; k < 3; ++k) {
      boxes.along_a[k] = dot(d, boxes.axes_a[k], boxes.between);
      boxes.along_b[k] = dot(d, boxes.axes_b[k], boxes.between);
    }
    return boxes;
  }

  /// The directions of the two thinner axes of each box.
  template <class OfA, class OfB, std::size_t kPlaces>
  HWY_INLINE void set_axes(const BoxFrame& frame, const Placed<kPlaces>& placed, const Boxes& boxes,
                           const OfA& of_a, const OfB& of_b, Direction* directions) const {
    V<D> a_in_b[2][3];  // The thinner axes of each box along those of the other.
    V<D> b_in_a[2][3];
    for (int k = 0; k < 2; ++k) {
      for (int m = 0; m < 3; ++m) {
        a_in_b[k][m] = dot(d, boxes.axes_a[k], boxes.axes_b[m]);
      }
    }
    for (int k = 0; k < 2; ++k) {
      b_in_a[k][0] = a_in_b[0][k];
      b_in_a[k][1] = a_in_b[1][k];
      b_in_a[k][2] = dot(d, boxes.axes_a[2], boxes.axes_b[k]);
    }
    HWY_UNROLL(2)
    for (int k = 0; k < 2; ++k) {
      const V<D> extent_b_along = extent_along(a_in_b[k], boxes.extent_b);
      const V<D> extent_a_along = extent_along(b_in_a[k], boxes.extent_a);
      V<D> swing_a;
      V<D> swing_b;
      if constexpr (kDeforms) {
        swing_a = hn::Add(boxes.growth_a[k], extent_along(a_in_b[k], boxes.growth_b));
        swing_b = hn::Add(boxes.growth_b[k], extent_along(b_in_a[k], boxes.growth_a));
      } else {
        swing_a = chord(frame, extent_b_along,
                        extent_at_horizon(a_in_b[k], boxes.swept_b, boxes.extent_b),
                        of_a(placed.swing[k]));
        swing_b = chord(frame, extent_a_along,
                        extent_at_horizon(b_in_a[k], boxes.swept_a, boxes.extent_a),
                        of_b(placed.swing[k]));
      }
      directions[2 * k] = {
          hn::Sub(hn::Abs(boxes.along_a[k]), hn::Add(boxes.extent_a[k], extent_b_along)),
          with_sign(dot(d, boxes.axes_a[k], boxes.velocity), boxes.along_a[k]), swing_a,
          of_a(placed.own_turn[k]), of_a(placed.turn_of_other[k])};
      directions[2 * k + 1] = {
          hn::Sub(hn::Abs(boxes.along_b[k]), hn::Add(boxes.extent_b[k], extent_a_along)),
          with_sign(dot(d, boxes.axes_b[k], boxes.velocity), boxes.along_b[k]), swing_b,
          of_b(placed.turn_of_other[k]), of_b(placed.own_turn[k])};
    }
  }

  /// The direction of the line of centres.
  HWY_INLINE Direction line_of_centres(const BoxFrame& frame, const Boxes& boxes) const {
    const V<D> square = dot(d, boxes.between, boxes.between);
    const V<D> scale = reciprocal_root(d, hn::Add(square, hn::Set(d, kTiny * kTiny)));
    V<D> line_in_a[3];
    V<D> line_in_b[3];
    for (int k = 0; k < 3; ++k) {
      line_in_a[k] = hn::Mul(scale, boxes.along_a[k]);
      line_in_b[k] = hn::Mul(scale, boxes.along_b[k]);
    }
    const V<D> extent =
        hn::Add(extent_along(line_in_a, boxes.extent_a), extent_along(line_in_b, boxes.extent_b));
    V<D> swing;
    if constexpr (kDeforms) {
      swing =
          hn::Add(extent_along(line_in_a, boxes.growth_a), extent_along(line_in_b, boxes.growth_b));
    } else {
      swing = chord(frame, extent,
                    hn::Add(extent_at_horizon(line_in_a, boxes.swept_a, boxes.extent_a),
                            extent_at_horizon(line_in_b, boxes.swept_b, boxes.extent_b)),
                    hn::Zero(d));
    }
    return {hn::Sub(hn::Mul(square, scale), extent),
            hn::Mul(dot(d, boxes.between, boxes.velocity), scale), swing,
            turn_against(frame, line_in_a, boxes.swept_a),
            turn_against(frame, line_in_b, boxes.swept_b)};
  }

  HWY_INLINE void store(const BoxFrame& frame, const Sizes& s, const Best& best, std::size_t first,
                        BoxBounds& bounds) const {
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
    const auto sure = hn::And(hn::Gt(best.nearness, hn::Add(s.doubt_middle, s.slack)),
                              hn::Lt(s.charge, hn::Set(d, kLargest)));
    store_bits(hn::Not(sure), first, bounds.unsure);
  }

  template <std::size_t kPlaces>
  HWY_INLINE void bound(const BoxFrame& frame, const Placed<kPlaces>& placed, std::size_t pair,
                        std::size_t first, BoxBounds& bounds) const {
    const auto of_a = [&](const float* field)
                          HWY_ATTR { return box_of_a(field + 4 * pair, first); };
    const auto of_b = [&](const float* field)
                          HWY_ATTR { return box_of_b(field + kPlaces / 2 + 4 * pair, first); };
    const Sizes s = sizes_of(frame, placed, of_a, of_b);
    const Boxes boxes = boxes_of(placed, of_a, of_b);
    Direction directions[kDirections];
    set_axes(frame, placed, boxes, of_a, of_b, directions);
    directions[4] = line_of_centres(frame, boxes);
    store(frame, s, best_of(s, directions), first, bounds);
  }
};

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
