#include <firstcontact/narrowphase/convex_pair.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <firstcontact/math/root_isolation.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kUp = 1.0 + 0x1p-46;

/// [-]  Velocities are sums of products of a few rounded numbers, and within this of their sizes.
constexpr double kSpeedError = 0x1p-47;

/// A body along the direction n from A to B, seen from the body's centre.
struct Side {
  const PlacedConvex& set;
  double rate;
  const Vector3d& axis;
  const Vector3d& pivot;
  Vector3d facing;  // n of A, -n of B
  double sign;
  Vector3d lever;  // [m]  Vector from the pivot to the centre.
  double reach;    // [m]  Bound of the distance of any point from the pivot.
  Vector3d turn;   // m = w n x u
  double spin;     // |m|
  double along;    // [m]  h(facing)

  Side(const PlacedConvex& S, double w, const Vector3d& u, const Vector3d& Q, const Vector3d& n,
       double faces)
      : set(S),
        rate(w),
        axis(u),
        pivot(Q),
        facing(faces * n),
        sign(faces),
        lever(S.centre - Q),
        reach((lever.norm() + S.core.reach) * kUp),
        turn(w > 0.0 ? Vector3d(w * n.cross(u)) : Vector3d(Vector3d::Zero())),
        spin(turn.norm()),
        along(support(facing)) {}

  /// [m]  An upper bound of d . x over the core, except for the error of its turn.
  [[nodiscard]] double support(const Vector3d& d) const {
    return set.core.support_bound(set.to_own_axes(d));
  }

  /// [m]  An upper bound of facing . (x - pivot) over its points, at any turn about the axis.
  [[nodiscard]] double most_at_any_turn() const {
    if (!(rate > 0.0)) {
      return facing.dot(lever) + along;
    }
    const double cosine = facing.dot(axis);
    const Vector3d u = cosine < 0.0 ? Vector3d(-axis) : axis;
    const double height = u.dot(lever) + support(u);
    const double across = lever.cross(axis).norm() + set.core.reach_across(set.to_own_axes(axis));
    // Axis and lever are rounded: 64 u of the reach.
    return std::abs(cosine) * height +
           (facing.cross(axis).norm() * std::min(across, reach) + 0x1p-47 * reach) * kUp;
  }

  /// [m per step]  The slope of the chord of h(facing + tau m), with m in the sense of this side.
  [[nodiscard]] double growth(const Vector3d& m, double chord) const {
    return (support(facing + (sign * chord) * m) - along) / chord;
  }

  /// [m per step]  An estimate of growth() for a short chord.
  [[nodiscard]] double growth_estimate(const Vector3d& m) const {
    const Vector3d own = set.core.support_point(set.to_own_axes(facing));
    return sign * m.dot(set.R * own);
  }
};

/// The gap of a pair along n, and how it changes.
class Gap {
 public:
  Gap(const RelativeState& state, const PlacedConvex& A, const PlacedConvex& B, const Vector3d& n,
      double threshold, double t_end)
      : state_(state),
        n_(n),
        A_(A, state.rate_A, state.axis_A, state.p_AQa, n, 1.0),
        B_(B, state.rate_B, state.axis_B, state.p_AQb, n, -1.0),
        clear_(n.dot(B.centre - A.centre) - A_.along - B_.along - threshold),
        threshold_(threshold),
        time_left_(t_end - state.t),
        drift_(n.dot(state.pivot_velocity)),
        pivot_speed_(state.pivot_velocity.norm()),
        bend_(state.bend_of(A_.reach, B_.reach)) {}

  [[nodiscard]] bool is_open() const { return clear_ > 0.0; }
  [[nodiscard]] double enough() const { return time_left_ * (1.0 + 0x1p-40) + 0x1p-100; }

  /// Whether a step with n fixed loses much of the gap to terms of second order.
  ///
  /// The other certificates may then be longer.
  [[nodiscard]] bool bends(double step) const {
    constexpr double kMuch = 0.1;  // [-]  Part of the gap.
    const double turn = step * std::max(A_.spin, B_.spin);
    const double bend = (A_.rate * A_.spin * A_.reach + B_.rate * B_.spin * B_.reach) * step * step;
    return bend > kMuch * clear_ || turn > 0.5;
  }

  [[nodiscard]] double at_any_turn() const {
    const double gap =
        n_.dot(B_.pivot - A_.pivot) - A_.most_at_any_turn() - B_.most_at_any_turn() - threshold_;
    return time_to_close(gap, slip_of(0.0) - drift_, 0.5 * bend_ * kUp);
  }

  [[nodiscard]] double fixed() const {
    const double slip = slip_of(A_.rate * A_.reach + B_.rate * B_.reach);
    const double K = A_.rate * A_.spin * A_.reach + B_.rate * B_.spin * B_.reach +
                     slip * (A_.rate + B_.rate) + bend_;
    const double closing = slip - drift_ - B_.turn.dot(B_.lever) + A_.turn.dot(A_.lever);
    return time_open(A_.turn, B_.turn, closing, K);
  }

  /// The time for which the gap stays open along a direction that turns with the carrier.
  ///
  /// Seen from the carrier, the centre of the other body moves at s + w u x (...) less the velocity
  /// of the carrier's frame there.
  [[nodiscard]] double carried(const Side& carrier, const Side& other) const {
    const double other_speed = pivot_speed_ + other.rate * other.reach;
    const Vector3d apart = other.pivot - carrier.pivot;
    const Vector3d apart_at_end = apart + (carrier.sign * time_left_) * state_.pivot_velocity;
    // The pivots move on lines, so that their distance is greatest at an end.
    const double distance = (std::max(apart.norm(), apart_at_end.norm()) + other.reach) * kUp;
    const double slip = slip_of(other.rate * other.reach + carrier.rate * distance);
    const double K = other.rate * other.rate * other.reach + 2.0 * carrier.spin * other_speed +
                     carrier.rate * carrier.spin * distance + slip * (carrier.rate + other.rate) +
                     bend_;
    const double turning =
        other.turn.dot(other.lever) - carrier.turn.dot(other.set.centre - carrier.pivot);
    const double closing = slip - drift_ - carrier.sign * turning;
    const Vector3d relative = other.turn - carrier.turn;
    return carrier.sign > 0.0 ? time_open(Vector3d::Zero(), relative, closing, K)
                              : time_open(relative, Vector3d::Zero(), closing, K);
  }

  [[nodiscard]] double carried_by_A() const { return A_.rate > 0.0 ? carried(A_, B_) : 0.0; }
  [[nodiscard]] double carried_by_B() const { return B_.rate > 0.0 ? carried(B_, A_) : 0.0; }

 private:
  /// [m per step]  Error of a rate.
  [[nodiscard]] double slip_of(double turning) const {
    return state_.drift + kSpeedError * (pivot_speed_ + turning);
  }

  /// The time for directions that change at the rates m_A and m_B, and centres that close at a
  /// rate.
  [[nodiscard]] double time_open(const Vector3d& m_A, const Vector3d& m_B, double closing,
                                 double K) const {
    const double half_acceleration = 0.5 * K * kUp;
    const double fastest = std::max(m_A.norm(), m_B.norm());
    if (!(fastest > 0.0)) {
      return time_to_close(clear_, closing, half_acceleration);
    }
    const double estimate = time_to_close(
        clear_, closing + A_.growth_estimate(m_A) + B_.growth_estimate(m_B), half_acceleration);
    // The end of the chord makes no direction more than twice as long, and lies not much beyond the
    // step.
    const double end = time_left_ * (1.0 + 0x1p-30) + 0x1p-90;
    const double chord = std::min({1.25 * estimate, end, (1.0 - 0x1p-40) / fastest});
    if (!(chord > 0.0)) {
      return 0.0;
    }
    const double grows = (m_A.isZero(0.0) ? 0.0 : A_.growth(m_A, chord)) +
                         (m_B.isZero(0.0) ? 0.0 : B_.growth(m_B, chord));
    return std::min(chord, time_to_close(clear_, closing + grows, half_acceleration));
  }

  const RelativeState& state_;
  const Vector3d& n_;
  Side A_;
  Side B_;
  double clear_;
  double threshold_;
  double time_left_;
  double drift_;
  double pivot_speed_;
  double bend_;
};

}  // namespace

double advance_convex(const RelativeState& state, const PlacedConvex& A, const PlacedConvex& B,
                      const Vector3d& n, double threshold, double error, double t_end) {
  const Gap gap(state, A, B, n, threshold + error, t_end);
  if (!gap.is_open()) {
    return 0.0;
  }
  double best = gap.fixed();
  if (best >= gap.enough() || !gap.bends(best)) {
    return best;
  }
  best = std::max(best, gap.at_any_turn());
  if (best < gap.enough()) {
    best = std::max({best, gap.carried_by_A(), gap.carried_by_B()});
  }
  return best;
}

namespace {

/// Advances a pair from step to step.
class Advance {
 public:
  Advance(const ConvexPair& pair, const ConvexContactOptions& options, ConvexGuess& guess)
      : pair_(pair), options_(options), guess_(guess) {
    result_.t = options.t_begin;
  }

  ConvexContact run() {
    while (result_.steps < options_.most_steps) {
      ++result_.steps;
      const RelativeState state = pair_.motion.state(result_.t);
      const double tau = step(state);
      if (result_.verdict == ConvexVerdict::contact) {
        return result_;
      }
      if (tau > 0.0 && after(result_.t, tau * (1.0 - 0x1p-50)) >= options_.t_end) {
        result_.verdict = ConvexVerdict::free;
        result_.t = options_.t_end;
        return result_;
      }
      const double next = after(result_.t, tau);
      if (!(next > result_.t)) {
        result_.verdict = ConvexVerdict::unresolved;
        return result_;
      }
      result_.t = next;
    }
    return result_;
  }

 private:
  /// A certified step; 0 at a contact, or where nothing is certified.
  [[nodiscard]] double step(const RelativeState& state) {
    const PlacedConvex A{.core = pair_.A, .R = state.R_WA};
    const PlacedConvex B{.core = pair_.B, .R = state.R_WB, .centre = state.p_AB};
    const double error = convex_gap_error(state, pair_.A.reach, pair_.B.reach);
    if (guess_.count == 0) {
      // Most pairs are far apart, and the line of their centres separates them.
      const Vector3d between = B.to_frame(pair_.B.origin) - A.to_frame(pair_.A.origin);
      const double length = between.norm();
      if (length > 0.0) {
        guess_.n = between / length;
        const double tau = advance(state, A, B, error, guess_.n);
        if (tau > 0.0 && after(state.t, tau * (1.0 - 0x1p-50)) >= options_.t_end) {
          return tau;
        }
      }
    }
    const double close = options_.threshold + 0.5 * options_.tolerance - error;
    ConvexWanted wanted{.least = options_.threshold + error, .near = 0.75, .close = close};
    ConvexClosest closest = closest_points(A, B, wanted, guess_);
    double tau = take(state, A, B, error, closest);
    if (tau > 0.0 || result_.verdict == ConvexVerdict::contact) {
      return tau;
    }
    // The search ended early because it began with unsuitable points. It runs once more from a
    // direction.
    guess_.count = 0;
    wanted.near = 1.0;
    closest = closest_points(A, B, wanted, guess_);
    tau = take(state, A, B, error, closest);
    return tau;
  }

  [[nodiscard]] double take(const RelativeState& state, const PlacedConvex& A,
                            const PlacedConvex& B, double error, const ConvexClosest& closest) {
    result_.distance_bound = closest.distance + error;
    if (result_.distance_bound <= options_.threshold + 0.5 * options_.tolerance) {
      result_.verdict = ConvexVerdict::contact;
      return 0.0;
    }
    return advance(state, A, B, error, closest.n);
  }

  [[nodiscard]] double advance(const RelativeState& state, const PlacedConvex& A,
                               const PlacedConvex& B, double error, const Vector3d& n) const {
    return advance_convex(state, A, B, n, options_.threshold, error, options_.t_end);
  }

  const ConvexPair& pair_;
  const ConvexContactOptions& options_;
  ConvexGuess& guess_;
  ConvexContact result_;
};

}  // namespace

ConvexContact convex_first_contact(const ConvexPair& pair, const ConvexContactOptions& options,
                                   ConvexGuess& guess) {
  return Advance(pair, options, guess).run();
}

}  // namespace firstcontact
