#include <firstcontact/narrowphase/elementary_contact.h>

#include <algorithm>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The axis of the first path that turns; a path at rest may turn about any axis.
Vector3d common_axis(const ConstantRatePath& first, const ConstantRatePath& second) {
  if (first.rate() > 0.0) {
    return first.axis();
  }
  return second.rate() > 0.0 ? second.axis() : Vector3d::UnitZ();
}

/// From world axes to axes whose z is the given one.
Matrix3d to_axes_along(const Vector3d& z) {
  const Vector3d x = z.unitOrthogonal();
  Matrix3d rows;
  rows << x.transpose(), z.cross(x).transpose(), z.transpose();
  return rows;
}

}  // namespace

// The errors of a lever, in units of 2^-53 of its length:
// - 22 for the path's rotation, and 13 for the change of axes and its product;
// - 10 for the rotation of the point and its sum;
// - 15 for each turn with its sine and cosine, and 6 for the axis of B. A turn by an angle w errs
//   by another 3 w.
ElementaryMotion::ElementaryMotion(const RelativeMotion& motion)
    : t_begin(std::max(motion.A().t_begin(), motion.B().t_begin())),
      t_end(std::min(motion.A().t_end(), motion.B().t_end())),
      position_error(motion.position_error()) {
  const RelativeState start = motion.state(t_begin);
  const Matrix3d axes = to_axes_along(common_axis(motion.A(), motion.B()));
  const auto body = [&axes](const ConstantRatePath& path, const Matrix3d& R,
                            const Vector3d& lever) {
    return Body{axes * R, axes * lever, lever.norm(), path.rate(), path.rotation_error()};
  };
  A = body(motion.A(), start.R_WA, -start.p_AQa);
  B = body(motion.B(), start.R_WB, start.p_AB - start.p_AQb);
  axis_B = axes * common_axis(motion.B(), motion.A());
  offset = axes * (start.p_AQb - start.p_AQa);
  drift = axes * motion.pivot_velocity();
  // A line is farthest from a point at an end.
  offset_bound =
      std::max(offset.norm(), (offset + (t_end - t_begin) * drift).norm()) * (1.0 + 0x1p-48);
  drift_length = drift.norm();
  oscillation = Oscillation(Vector3d::UnitZ(), A.rate, axis_B, B.rate);
  rounding = (96.0 + 4.0 * std::max(A.rate, B.rate)) * 0x1p-53;
}

}  // namespace firstcontact
