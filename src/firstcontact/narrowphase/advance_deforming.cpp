#include <firstcontact/narrowphase/advance_deforming.h>

#include <algorithm>
#include <cmath>

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

/// @param offset  [m]  that positions were rounded by
MovingCorners corners(const ConstantRatePath& path, const Triangle& position, const Triangle& rates,
                      const Vector3d& pivot, const Vector3d& pivot_velocity, double offset,
                      double time_left) {
  MovingCorners c;
  c.position = position;
  c.rate = path.rate();
  c.axis = path.axis();
  for (std::size_t k = 0; k < 3; ++k) {
    c.velocity[k] = pivot_velocity + c.rate * c.axis.cross(position[k] - pivot) + rates[k];
  }
  c.speed = longest(rates, Vector3d::Zero()) * kUp;
  c.reach = (longest(position, pivot) + c.speed * time_left) * kUp;
  c.slip = detail::kGapRounding * (pivot_velocity.norm() + c.rate * (c.reach + offset) + c.speed);
  return c;
}

}  // namespace

double advance_deforming(const RelativeMotion& motion, const RelativeState& state,
                         const TrianglePair& pair, const TrianglePair& rates,
                         const ClosestFeatures& closest, const Vector3d& n, double threshold,
                         double error, double t, double t_end) {
  const double time_left = t_end - t;
  const double enough = time_left * (1.0 + 0x1p-40) + 0x1p-100;
  const double offset = state.p_AB.norm();
  const MovingCorners A =
      corners(motion.A(), pair.A, rates.A, state.p_AQa, Vector3d::Zero(), offset, time_left);
  const MovingCorners B =
      corners(motion.B(), pair.B, rates.B, state.p_AQb, motion.pivot_velocity(), offset, time_left);
  return detail::time_apart_along(A, B, closest, threshold + error, n, enough);
}

}  // namespace firstcontact
