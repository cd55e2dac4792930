#include <firstcontact/query/detail/ball_path.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <firstcontact/math/root_isolation.h>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

/// [-]  More than 2^8 times the rounding of a few operations on positions and velocities.
constexpr double kRounding = 0x1p-44;

/// A position or a velocity with its error.
struct Centre {
  Vector3d position;
  Vector3d velocity;
  double position_error = 0.0;  // [m]
  double velocity_error = 0.0;  // [m per step]
};

Centre centre_at(const ConstantRatePath& path, double t) {
  const Vector3d lever = path.state(t).p_QC_W;
  const Vector3d pivot = path.pivot(t).value();
  const Vector3d pivot_velocity = path.pivot_velocity().value();
  Centre centre;
  centre.position = pivot + lever;
  centre.velocity = pivot_velocity + path.rate() * path.axis().cross(lever);
  centre.position_error = path.position_error() + kRounding * (pivot.norm() + path.lever_length());
  centre.velocity_error = kRounding * (pivot_velocity.norm() + path.rate() * path.lever_length());
  return centre;
}

/// A time in which the two balls stay apart by more than the margin; not positive where they are
/// not apart at t.
double step(const ConstantRatePath& A, const ConstantRatePath& B, double distance_kept, double t) {
  const Centre a = centre_at(A, t);
  const Centre b = centre_at(B, t);
  const Vector3d d = b.position - a.position;
  const double distance = d.norm();
  const double gap = distance * (1.0 - kRounding) - distance_kept * (1.0 + kRounding) -
                     a.position_error - b.position_error;
  if (!(gap > 0.0)) {
    return 0.0;
  }
  const double speed = d.dot(a.velocity - b.velocity) / distance + a.velocity_error +
                       b.velocity_error + kRounding * (a.velocity.norm() + b.velocity.norm());
  const double acceleration =
      (A.rate() * A.rate() * A.lever_length() + B.rate() * B.rate() * B.lever_length()) *
      (1.0 + kRounding);
  return time_to_close(gap, speed, 0.5 * acceleration);
}

}  // namespace

AlignedBox3d swept_box(const BallPath& ball, const TimeWindow& window) {
  AlignedBox3d box;
  for (const ConstantRatePath& path : ball.centre) {
    const double begin = std::max(window.begin, path.t_begin());
    const double end = std::min(window.end, path.t_end());
    if (begin > end) {
      continue;
    }
    const double h = path.rate() * (end - begin);
    const double bulge =
        path.lever_length() * std::min(0.125 * (1.0 + kRounding) * h * h, 2.0 + kRounding);
    for (const double t : {begin, end}) {
      const Centre centre = centre_at(path, t);
      const double reach = (ball.radius + bulge) * (1.0 + kRounding) + 2.0 * centre.position_error;
      box.extend(Vector3d(centre.position.array() - reach));
      box.extend(Vector3d(centre.position.array() + reach));
    }
  }
  return box;
}

double apart_until(const BallPath& A, const BallPath& B, double margin, const TimeWindow& window) {
  constexpr int kSteps = 6;
  const double distance_kept = A.radius + B.radius + margin;
  double t = window.begin;
  auto a = A.centre.begin();
  auto b = B.centre.begin();
  for (int steps = 0; steps < kSteps;) {
    const double end = std::min({a->t_end(), b->t_end(), window.end});
    if (end < t) {  // A piece before the window.
      (a->t_end() <= b->t_end() ? a : b)++;
      continue;
    }
    const double tau = step(*a, *b, distance_kept, t) * (1.0 - kRounding);
    ++steps;
    if (!(tau > 0.0)) {
      return t;
    }
    if (t + tau <= end) {
      t = std::nextafter(t + tau, 0.0);
      continue;
    }
    if (end == window.end) {
      return std::numeric_limits<double>::infinity();
    }
    t = end;
    const bool next_a = a->t_end() <= end;
    const bool next_b = b->t_end() <= end;
    a += next_a ? 1 : 0;
    b += next_b ? 1 : 0;
  }
  return t;
}

}  // namespace firstcontact::detail
