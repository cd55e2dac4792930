#include <firstcontact/narrowphase/advance.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Velocities are products of a few rounded numbers: within 2^-48 of their size.
constexpr double kSpeedError = 0x1p-48;

struct Reach {
  double A = 0.0;  // greatest distance of a corner from its own pivot
  double B = 0.0;
};

Reach reach_of(const TrianglePair& pair, const RelativeState& state) {
  Reach reach;
  for (int k = 0; k < 3; ++k) {
    reach.A = std::max(reach.A, (pair.A[k] - state.p_AQa).norm());
    reach.B = std::max(reach.B, (pair.B[k] - state.p_AQb).norm());
  }
  return {reach.A * (1.0 + 0x1p-48), reach.B * (1.0 + 0x1p-48)};
}

double along_direction_fixed(const RelativeMotion& motion, const RelativeState& state,
                             const TrianglePair& pair, const Vector3d& n, double clearance_error,
                             const Reach& reach) {
  const double wA = motion.A().rate();
  const double wB = motion.B().rate();
  // n . (w u x r) = r . (n x u) w.
  const Vector3d turn_A = wA * n.cross(motion.A().axis());
  const Vector3d turn_B = wB * n.cross(motion.B().axis());
  const double slip = kSpeedError * (motion.pivot_velocity().norm() + wA * reach.A + wB * reach.B);
  const double half_acceleration =
      0.5 * (1.0 + 0x1p-46) *
      (wA * turn_A.norm() * reach.A + wB * turn_B.norm() * reach.B + slip * (wA + wB));
  const double drift = n.dot(motion.pivot_velocity());
  double least = kInfinity;
  for (const Vector3d& a : pair.A) {
    for (const Vector3d& b : pair.B) {
      const double gap = n.dot(b - a) - clearance_error;
      const double opening = drift + turn_B.dot(b - state.p_AQb) - turn_A.dot(a - state.p_AQa);
      least = std::min(least, time_to_close(gap, slip - opening, half_acceleration));
    }
  }
  return least;
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
};

/// n points from the carrier to the other.
double along_direction_carried(const CarriedView& view, const Triangle& carrier,
                               const Triangle& other, const Vector3d& n, double clearance_error,
                               double time_left) {
  const double spin = view.rate * n.cross(view.axis).norm();
  const double other_speed = view.other_velocity.norm() + view.other_rate * view.other_reach;
  const Vector3d apart = view.other_pivot - view.carrier_pivot;
  // The pivots move on lines, so that their distance is greatest at an end.
  const double distance =
      std::max(apart.norm(), (apart + time_left * view.other_velocity).norm()) + view.other_reach;
  const double slip = kSpeedError * (other_speed + view.rate * distance);
  const double half_acceleration =
      0.5 * (1.0 + 0x1p-46) *
      (view.other_rate * view.other_rate * view.other_reach + 2.0 * spin * other_speed +
       view.rate * spin * distance + slip * (view.rate + view.other_rate));
  const double wall = std::max({n.dot(carrier[0]), n.dot(carrier[1]), n.dot(carrier[2])});
  double least = kInfinity;
  for (const Vector3d& b : other) {
    const Vector3d velocity = view.other_velocity +
                              view.other_rate * view.other_axis.cross(b - view.other_pivot) -
                              view.rate * view.axis.cross(b - view.carrier_pivot);
    const double gap = n.dot(b) - wall - clearance_error;
    least = std::min(least, time_to_close(gap, slip - n.dot(velocity), half_acceleration));
  }
  return least;
}

}  // namespace

double advance(const RelativeMotion& motion, const RelativeState& state, const TrianglePair& pair,
               const Vector3d& n, double threshold, double error, double t, double t_end) {
  const Reach reach = reach_of(pair, state);
  const double clearance_error = threshold + error;
  const double time_left = t_end - t;
  const ConstantRatePath& A = motion.A();
  const ConstantRatePath& B = motion.B();
  const Vector3d& s = motion.pivot_velocity();
  const double fixed = along_direction_fixed(motion, state, pair, n, clearance_error, reach);
  if (fixed >= time_left) {
    return fixed;
  }
  const CarriedView by_A{A.rate(), A.axis(),    state.p_AQa, B.rate(),
                         B.axis(), state.p_AQb, s,           reach.B};
  const CarriedView by_B{B.rate(), B.axis(),    state.p_AQb, A.rate(),
                         A.axis(), state.p_AQa, -s,          reach.A};
  return std::max({fixed,
                   along_direction_carried(by_A, pair.A, pair.B, n, clearance_error, time_left),
                   along_direction_carried(by_B, pair.B, pair.A, -n, clearance_error, time_left)});
}

}  // namespace firstcontact
