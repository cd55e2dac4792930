#include <firstcontact/narrowphase/advance.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "firstcontact/narrowphase/advance.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <firstcontact/narrowphase/detail/corner_lanes.h>

HWY_BEFORE_NAMESPACE();
namespace firstcontact::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Eigen::Vector3d;

/// [-]  Velocities are products of a few rounded numbers, and within this of their size.
constexpr double kSpeedError = 0x1p-48;

using D = hn::CappedTag<double, kCornerLanes>;
using V = hn::Vec<D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kParts = kCornerLanes / kLanes;

/// One number of each corner of a triangle.
struct Corners {
  V part[kParts];
};

/// The components of the corners, relative to a point.
struct CornerVectors {
  Corners component[3];
};

HWY_INLINE CornerVectors corners_from(const Vector3d& origin, const Triangle& T) {
  const D d;
  CornerVectors corners;
  for (int k = 0; k < 3; ++k) {
    for (std::size_t p = 0; p < kParts; ++p) {
      corners.component[k].part[p] =
          hn::Sub(corner_lanes(d, T, k, p * kLanes, false), hn::Set(d, origin[k]));
    }
  }
  return corners;
}

HWY_INLINE Corners dot(const CornerVectors& corners, const Vector3d& n) {
  const D d;
  const auto& [x, y, z] = corners.component;
  Corners product;
  for (std::size_t p = 0; p < kParts; ++p) {
    product.part[p] =
        hn::MulAdd(x.part[p], hn::Set(d, n.x()),
                   hn::MulAdd(y.part[p], hn::Set(d, n.y()), hn::Mul(z.part[p], hn::Set(d, n.z()))));
  }
  return product;
}

/// [m]  The greatest distance of a corner from the point.
HWY_INLINE double reach_of(const CornerVectors& corners) {
  const D d;
  const auto& [x, y, z] = corners.component;
  V square = hn::Zero(d);
  for (std::size_t p = 0; p < kParts; ++p) {
    square = hn::Max(square,
                     hn::MulAdd(x.part[p], x.part[p],
                                hn::MulAdd(y.part[p], y.part[p], hn::Mul(z.part[p], z.part[p]))));
  }
  return std::sqrt(hn::GetLane(hn::MaxOfLanes(d, square))) * (1.0 + 0x1p-48);
}

/// The greatest of sign x over the corners.
HWY_INLINE double most(const Corners& x, double sign) {
  const D d;
  V most = hn::Mul(hn::Set(d, sign), x.part[0]);
  for (std::size_t p = 1; p < kParts; ++p) {
    most = hn::Max(most, hn::Mul(hn::Set(d, sign), x.part[p]));
  }
  return hn::GetLane(hn::MaxOfLanes(d, most));
}

/// The time for which gaps stay open that are at least gap - speed tau - half_acceleration tau^2.
///
/// It is exactly that of this parabola, or `enough` where that is less.
class TimeOpen {
 public:
  HWY_INLINE TimeOpen(double half_acceleration, double enough)
      : half_acceleration_(half_acceleration), enough_(enough), least_(hn::Set(D(), enough)) {}

  HWY_INLINE void add(V gap, V speed) {
    const D d;
    const V zero = hn::Zero(d);
    const V enough = hn::Set(d, enough_);
    // Such a parabola is least at an end.
    const V by_speed = hn::Mul(speed, enough);
    const V by_acceleration = hn::Set(d, half_acceleration_ * enough_ * enough_);
    const V rounding =
        hn::Mul(hn::Set(d, 0x1p-50), hn::Add(hn::Add(gap, hn::Abs(by_speed)), by_acceleration));
    const auto apart = hn::Gt(gap, zero);
    const auto open =
        hn::And(apart, hn::Gt(hn::Sub(hn::Sub(gap, by_speed), by_acceleration), rounding));
    // As time_to_close() of math/root_isolation.h; NaN takes the safe branch.
    const V root =
        hn::Sqrt(hn::MulAdd(speed, speed, hn::Mul(hn::Set(d, 4.0 * half_acceleration_), gap)));
    const V denominator = hn::MulAdd(hn::Set(d, 0x1p-50), hn::Abs(speed), hn::Add(speed, root));
    const V closing = hn::Mul(hn::Div(gap, denominator), hn::Set(d, 2.0 * (1.0 - 0x1p-44)));
    const V proven = hn::IfThenElseZero(hn::And(apart, hn::Gt(closing, zero)), closing);
    least_ = hn::Min(least_, hn::IfThenElse(open, enough, proven));
  }

  [[nodiscard]] HWY_INLINE double least() const { return hn::GetLane(hn::MinOfLanes(D(), least_)); }

 private:
  double half_acceleration_;
  double enough_;
  V least_;
};

/// A body as seen along the direction n from A to B.
struct Side {
  const Triangle& corners;
  double rate;
  const Vector3d& pivot;
  Vector3d turn;  // n . (w u x r) = r . turn
  double spin;    // Its length.
  Corners along;
  Corners speed;  // Speed along n, as the body turns about its pivot.
  double reach;   // Greatest distance of a corner from the pivot.

  HWY_INLINE Side(const Triangle& T, double w, const Vector3d& axis, const Vector3d& p_AQ,
                  const Vector3d& n)
      : corners(T), rate(w), pivot(p_AQ), turn(w * n.cross(axis)), spin(turn.norm()) {
    const CornerVectors from_pivot = corners_from(pivot, T);
    along = dot(corners_from(Vector3d::Zero(), T), n);
    speed = dot(from_pivot, turn);
    reach = reach_of(from_pivot);
  }
};

/// The data of the pair that both sides use.
struct Gap {
  const RelativeState& state;
  double clearance_error;
  double time_left;
  double enough;
  double drift;        // Drift of the pivots along n.
  double pivot_speed;  // Speed of the pivots in any direction.
  double bend;
};

HWY_INLINE double along_direction_fixed(const Gap& gap, const Side& A, const Side& B) {
  const D d;
  const double slip =
      gap.state.drift + kSpeedError * (gap.pivot_speed + A.rate * A.reach + B.rate * B.reach);
  TimeOpen time(0.5 * (1.0 + 0x1p-46) *
                    (A.rate * A.spin * A.reach + B.rate * B.spin * B.reach +
                     slip * (A.rate + B.rate) + gap.bend),
                gap.enough);
  alignas(32) double along_A[kCornerLanes];
  alignas(32) double speed_A[kCornerLanes];
  for (std::size_t p = 0; p < kParts; ++p) {
    hn::Store(A.along.part[p], d, along_A + p * kLanes);
    hn::Store(A.speed.part[p], d, speed_A + p * kLanes);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const V wall = hn::Set(d, along_A[k] + gap.clearance_error);
    const V closing = hn::Set(d, slip - gap.drift + speed_A[k]);
    for (std::size_t p = 0; p < kParts; ++p) {
      time.add(hn::Sub(B.along.part[p], wall), hn::Sub(closing, B.speed.part[p]));
    }
  }
  return time.least();
}

/// The time for which the gap stays open along a direction that turns with the carrier.
///
/// @param sign  1 where A carries the direction, -1 where B does
HWY_INLINE double along_direction_carried(const Gap& gap, const Side& carrier, const Side& other,
                                          double sign) {
  const D d;
  const double other_speed = gap.pivot_speed + other.rate * other.reach;
  const Vector3d apart = other.pivot - carrier.pivot;
  const Vector3d apart_at_end = apart + (sign * gap.time_left) * gap.state.pivot_velocity;
  // The pivots move on lines, so that their distance is greatest at an end.
  const double distance = std::max(apart.norm(), apart_at_end.norm()) + other.reach;
  const double slip = gap.state.drift + kSpeedError * (other_speed + carrier.rate * distance);
  TimeOpen time(
      0.5 * (1.0 + 0x1p-46) *
          (other.rate * other.rate * other.reach + 2.0 * carrier.spin * other_speed +
           carrier.rate * carrier.spin * distance + slip * (carrier.rate + other.rate) + gap.bend),
      gap.enough);
  const V towards_other = hn::Set(d, sign);
  const V wall = hn::Set(d, most(carrier.along, sign) + gap.clearance_error);
  const V closing = hn::Set(d, slip - gap.drift);
  const Corners turning = dot(corners_from(carrier.pivot, other.corners), carrier.turn);
  for (std::size_t p = 0; p < kParts; ++p) {
    time.add(hn::MulSub(towards_other, other.along.part[p], wall),
             hn::MulAdd(towards_other, hn::Sub(turning.part[p], other.speed.part[p]), closing));
  }
  return time.least();
}

double Advance(const RelativeState& state, const TrianglePair& pair, const Vector3d& n,
               double threshold, double error, double t_end) {
  const Side A(pair.A, state.rate_A, state.axis_A, state.p_AQa, n);
  const Side B(pair.B, state.rate_B, state.axis_B, state.p_AQb, n);
  const double time_left = t_end - state.t;
  const Gap gap{.state = state,
                .clearance_error = threshold + error,
                .time_left = time_left,
                .enough = time_left * (1.0 + 0x1p-40) + 0x1p-100,
                .drift = n.dot(state.pivot_velocity),
                .pivot_speed = state.pivot_velocity.norm(),
                .bend = state.bend_of(A.reach, B.reach)};
  const double fixed = along_direction_fixed(gap, A, B);
  if (fixed >= gap.enough) {
    return fixed;
  }
  return std::max(
      {fixed, along_direction_carried(gap, A, B, 1.0), along_direction_carried(gap, B, A, -1.0)});
}

}  // namespace firstcontact::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace firstcontact {
namespace detail {
HWY_EXPORT(Advance);
}  // namespace detail

double advance(const RelativeState& state, const TrianglePair& pair, const Eigen::Vector3d& n,
               double threshold, double error, double t_end) {
  using namespace detail;
  return HWY_DYNAMIC_DISPATCH(Advance)(state, pair, n, threshold, error, t_end);
}

}  // namespace firstcontact
#endif
