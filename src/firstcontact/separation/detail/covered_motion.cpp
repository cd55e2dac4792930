#include <firstcontact/separation/detail/covered_motion.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace firstcontact::detail {
namespace {

/// The middle of an interval; a bound of its error is added to `error`.
double middle_of(const Interval& x, double& error) {
  const double m = x.midpoint();
  error = std::max(error, x.width_bound());
  return m;
}

}  // namespace

BodyInstant instant_of(const IntervalTransform& X) {
  BodyInstant now;
  double entry_error = 0.0;
  double coordinate_error = 0.0;
  for (int i = 0; i < 3; ++i) {
    now.pivot[i] = middle_of(X.position.c[i], coordinate_error);
    for (int j = 0; j < 3; ++j) {
      now.R(i, j) = middle_of(X.rotation.columns[j].c[i], entry_error);
    }
  }
  now.pivot_error = 2.0 * coordinate_error;  // At least sqrt(3) of them.
  now.turn_error = 4.0 * entry_error;        // At least the norm of a matrix of them, which is 3.
  return now;
}

Eigen::Vector3d middle(const IntervalVector3& v, double& error) {
  Eigen::Vector3d result;
  double coordinate_error = 0.0;
  for (int i = 0; i < 3; ++i) {
    result[i] = middle_of(v.c[i], coordinate_error);
  }
  error += 2.0 * coordinate_error;
  return result;
}

// v + 2 (w q x v + q x (q x v)) / |q|^2.
IntervalMatrix3 exact_rotation(const Eigen::Quaterniond& quaternion) {
  const Interval w(quaternion.w());
  const IntervalVector3 q = enclose(Eigen::Vector3d(quaternion.vec()));
  const Interval twice = Interval(2.0) / (sqr(w) + dot(q, q));
  IntervalMatrix3 R = enclose(Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  for (IntervalVector3& column : R.columns) {
    const IntervalVector3 once = cross(q, column);
    column = column + twice * (w * once + cross(q, once));
  }
  return R;
}

IntervalTransform exact_transform(const Pose& pose) {
  return {exact_rotation(pose.rotation), enclose(pose.position)};
}

// First scaled by a power of two, so that squares of tiny and of huge numbers stay in range.
IntervalVector3 exact_direction(const Eigen::Vector3d& v) {
  const double scale = std::exp2(-std::ilogb(v.cwiseAbs().maxCoeff()));
  const IntervalVector3 scaled = enclose(Eigen::Vector3d(scale * v));
  return (Interval(1.0) / norm(scaled)) * scaled;
}

IntervalMatrix3 rotated(const IntervalVector3& axis, const Interval& angle,
                        const IntervalMatrix3& R) {
  if (angle == Interval(0.0)) {
    return R;
  }
  const Interval sine = sin(angle);
  const Interval versine = Interval(2.0) * sqr(sin(Interval(0.5) * angle));
  IntervalMatrix3 result = R;
  for (IntervalVector3& column : result.columns) {
    const IntervalVector3 once = cross(axis, column);
    column = column + sine * once + versine * cross(axis, once);
  }
  return result;
}

}  // namespace firstcontact::detail
