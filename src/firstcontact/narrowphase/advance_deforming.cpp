#include <firstcontact/narrowphase/advance_deforming.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <firstcontact/narrowphase/detail/turning_gap.h>

namespace firstcontact {
namespace {

using detail::MovingCorners;
using Eigen::Vector3d;

constexpr double kUp = 1.0 + 0x1p-40;

double longest(const Triangle& v, const Vector3d& from) {
  return std::sqrt(std::max(
      {(v[0] - from).squaredNorm(), (v[1] - from).squaredNorm(), (v[2] - from).squaredNorm()}));
}

/// The part of a RelativeState that belongs to one body.
struct BodyState {
  const Vector3d& axis;
  double rate;
  const Vector3d& pivot;
  Vector3d pivot_velocity;
};

/// @param offset  [m]  size to which positions were rounded
MovingCorners corners(const BodyState& body, const Triangle& position, const Triangle& rates,
                      double offset, double time_left) {
  MovingCorners c;
  c.position = position;
  c.rate = body.rate;
  c.axis = body.axis;
  for (std::size_t k = 0; k < 3; ++k) {
    c.velocity[k] =
        body.pivot_velocity + c.rate * c.axis.cross(position[k] - body.pivot) + rates[k];
  }
  c.speed = longest(rates, Vector3d::Zero()) * kUp;
  c.reach = (longest(position, body.pivot) + c.speed * time_left) * kUp;
  c.slip =
      detail::kGapRounding * (body.pivot_velocity.norm() + c.rate * (c.reach + offset) + c.speed);
  return c;
}

}  // namespace

double advance_deforming(const RelativeState& state, const TrianglePair& pair,
                         const TrianglePair& rates, const ClosestFeatures& closest,
                         const Vector3d& n, double threshold, double error, double t_end) {
  const double time_left = t_end - state.t;
  const double enough = time_left * (1.0 + 0x1p-40) + 0x1p-100;
  const double offset = state.p_AB.norm();
  const BodyState body_A{state.axis_A, state.rate_A, state.p_AQa, Vector3d::Zero()};
  const BodyState body_B{state.axis_B, state.rate_B, state.p_AQb, state.pivot_velocity};
  const MovingCorners A = corners(body_A, pair.A, rates.A, offset, time_left);
  MovingCorners B = corners(body_B, pair.B, rates.B, offset, time_left);
  // Errors and bends of the relative motion count as B's.
  B.slip += state.drift;
  B.bend = state.bend_of(longest(pair.A, state.p_AQa), longest(pair.B, state.p_AQb)) * kUp;
  return detail::time_apart_along(A, B, closest, threshold + error, n, enough);
}

}  // namespace firstcontact
