#include <firstcontact/narrowphase/advance.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// Velocities are products of a few rounded numbers: within 2^-48 of their size.
constexpr double kSpeedError = 0x1p-48;

/// Gaps that change in time by at least gap - speed tau - half_acceleration tau^2.
template <int kCount>
struct Gaps {
  std::array<double, kCount> gap{};
  std::array<double, kCount> speed{};
  double half_acceleration = 0.0;

  /// Whether gap k is provably open on [0, tau]: such a parabola is least at an end.
  [[nodiscard]] bool open_until(int k, double tau) const {
    const double by_speed = speed[k] * tau;
    const double by_acceleration = half_acceleration * tau * tau;
    return gap[k] > 0.0 && gap[k] - by_speed - by_acceleration >
                               0x1p-50 * (gap[k] + std::abs(by_speed) + by_acceleration);
  }

  /// For how long all are open: exactly that, or `enough` where that is less.
  [[nodiscard]] double time_open(double enough) const {
    double tau = enough;
    for (int k = 0; k < kCount && tau > 0.0; ++k) {
      if (!open_until(k, tau)) {
        tau = std::min(tau, time_to_close(gap[k], speed[k], half_acceleration));
      }
    }
    return tau;
  }
};

struct Reach {
  double A = 0.0;  // greatest distance of a corner from its own pivot
  double B = 0.0;
};

Reach reach_of(const TrianglePair& pair, const RelativeState& state) {
  Reach square;
  for (int k = 0; k < 3; ++k) {
    square.A = std::max(square.A, (pair.A[k] - state.p_AQa).squaredNorm());
    square.B = std::max(square.B, (pair.B[k] - state.p_AQb).squaredNorm());
  }
  return {std::sqrt(square.A) * (1.0 + 0x1p-48), std::sqrt(square.B) * (1.0 + 0x1p-48)};
}

double along_direction_fixed(const RelativeState& state, const TrianglePair& pair,
                             const Vector3d& n, double clearance_error, const Reach& reach,
                             double enough) {
  const double wA = state.rate_A;
  const double wB = state.rate_B;
  // n . (w u x r) = r . (n x u) w.
  const Vector3d turn_A = wA * n.cross(state.axis_A);
  const Vector3d turn_B = wB * n.cross(state.axis_B);
  const double slip =
      state.drift + kSpeedError * (state.pivot_velocity.norm() + wA * reach.A + wB * reach.B);
  Gaps<9> gaps;
  gaps.half_acceleration = 0.5 * (1.0 + 0x1p-46) *
                           (wA * turn_A.norm() * reach.A + wB * turn_B.norm() * reach.B +
                            slip * (wA + wB) + state.bend_of(reach.A, reach.B));
  const double drift = n.dot(state.pivot_velocity);
  int k = 0;
  for (const Vector3d& a : pair.A) {
    const double opening_a = slip - drift + turn_A.dot(a - state.p_AQa);
    for (const Vector3d& b : pair.B) {
      gaps.gap[k] = n.dot(b - a) - clearance_error;
      gaps.speed[k] = opening_a - turn_B.dot(b - state.p_AQb);
      ++k;
    }
  }
  return gaps.time_open(enough);
}

/// What a body that carries the direction sees of the other one.
struct CarriedView {
  double rate = 0.0;  // of the carrier
  Vector3d axis;      // of the carrier
  Vector3d carrier_pivot;
  double other_rate = 0.0;
  Vector3d other_axis;
  Vector3d other_pivot;
  Vector3d other_velocity;  // of the other's pivot relative to the carrier's
  double other_reach = 0.0;
  double drift = 0.0;
  double bend = 0.0;
};

/// n points from the carrier to the other.
double along_direction_carried(const CarriedView& view, const Triangle& carrier,
                               const Triangle& other, const Vector3d& n, double clearance_error,
                               double time_left, double enough) {
  // n . (w u x r) = r . (n x u) w.
  const Vector3d turn = view.rate * n.cross(view.axis);
  const Vector3d other_turn = view.other_rate * n.cross(view.other_axis);
  const double spin = turn.norm();
  const double other_speed = view.other_velocity.norm() + view.other_rate * view.other_reach;
  const Vector3d apart = view.other_pivot - view.carrier_pivot;
  // The pivots move on lines, so that their distance is greatest at an end.
  const double distance =
      std::max(apart.norm(), (apart + time_left * view.other_velocity).norm()) + view.other_reach;
  const double slip = view.drift + kSpeedError * (other_speed + view.rate * distance);
  Gaps<3> gaps;
  gaps.half_acceleration =
      0.5 * (1.0 + 0x1p-46) *
      (view.other_rate * view.other_rate * view.other_reach + 2.0 * spin * other_speed +
       view.rate * spin * distance + slip * (view.rate + view.other_rate) + view.bend);
  const double wall = std::max({n.dot(carrier[0]), n.dot(carrier[1]), n.dot(carrier[2])});
  const double drift = n.dot(view.other_velocity);
  for (int k = 0; k < 3; ++k) {
    const Vector3d& b = other[k];
    gaps.gap[k] = n.dot(b) - wall - clearance_error;
    gaps.speed[k] =
        slip - drift - other_turn.dot(b - view.other_pivot) + turn.dot(b - view.carrier_pivot);
  }
  return gaps.time_open(enough);
}

}  // namespace

double advance(const RelativeState& state, const TrianglePair& pair, const Vector3d& n,
               double threshold, double error, double t_end) {
  const Reach reach = reach_of(pair, state);
  const double clearance_error = threshold + error;
  const double time_left = t_end - state.t;
  const double enough = time_left * (1.0 + 0x1p-40) + 0x1p-100;
  const double fixed = along_direction_fixed(state, pair, n, clearance_error, reach, enough);
  if (fixed >= enough) {
    return fixed;
  }
  const double bend = state.bend_of(reach.A, reach.B);
  const CarriedView by_A{state.rate_A, state.axis_A, state.p_AQa,          state.rate_B,
                         state.axis_B, state.p_AQb,  state.pivot_velocity, reach.B,
                         state.drift,  bend};
  const double carried_by_A =
      along_direction_carried(by_A, pair.A, pair.B, n, clearance_error, time_left, enough);
  if (carried_by_A >= enough) {
    return carried_by_A;
  }
  const CarriedView by_B{state.rate_B, state.axis_B, state.p_AQb,           state.rate_A,
                         state.axis_A, state.p_AQa,  -state.pivot_velocity, reach.A,
                         state.drift,  bend};
  return std::max(
      {fixed, carried_by_A,
       along_direction_carried(by_B, pair.B, pair.A, -n, clearance_error, time_left, enough)});
}

}  // namespace firstcontact
