#include <firstcontact/motion/enclose_pose.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

namespace firstcontact {
namespace {

/// Errors that ConstantRatePath states, for a column of its rotation, its axis and its rate.
constexpr double kRotationError = 22.0 * 0x1p-53;
constexpr double kAxisError = 0x1p-52;
constexpr double kRateError = 0x1p-52;

/// The error of the double-double sums below: pivot(t) and precise_lever(t).
constexpr double kPositionError = 0x1p-90;

double size(const DoubleDoubleVector3& v) { return v.value().norm(); }

}  // namespace

IntervalTransform enclose_pose(const ConstantRatePath& path, const Interval& t) {
  const double middle = t.midpoint();
  const Interval rest = t - Interval(middle);
  const Interval angle =
      Interval(path.rate()) * Interval(1.0 - kRateError, 1.0 + kRateError) * rest;
  const IntervalVector3 axis = inflated(enclose(path.axis()), kAxisError);
  const DoubleDoubleVector3 pivot = path.pivot(middle);
  const DoubleDoubleVector3 lever = path.precise_lever(middle);
  const double error =
      path.position_error() + kPositionError * (size(path.pivot_begin()) + size(pivot) +
                                                size(path.pivot_velocity()) + size(lever));
  IntervalTransform X;
  X.position = inflated(
      enclose(pivot) + rest * enclose(path.pivot_velocity()) + rotated(axis, angle, enclose(lever)),
      error);
  const IntervalMatrix3 R = enclose(path.state(middle).R_WB);
  for (std::size_t j = 0; j < 3; ++j) {
    X.rotation.columns[j] =
        rotated(axis, angle, inflated(R.columns[j], kRotationError + path.rotation_error()));
  }
  return X;
}

IntervalTransform enclose_pose(const Motion& motion, const Interval& t) {
  const std::span<const double> breaks = motion.breaks();
  std::optional<IntervalTransform> all;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    const double begin = std::max(t.lower(), breaks[k]);
    const double end = std::min(t.upper(), breaks[k + 1]);
    if (begin <= end) {
      const IntervalTransform X =
          enclose_pose(motion.path(k, Eigen::Vector3d::Zero()), Interval(begin, end));
      all = all ? hull(*all, X) : X;
    }
  }
  return all.value();
}

}  // namespace firstcontact
