#include <firstcontact/narrowphase/elementary_contact.h>

#include <algorithm>

#include <Eigen/Geometry>

namespace firstcontact {

ElementaryMotion::ElementaryMotion(const RelativeMotion& motion)
    : drift_(motion.pivot_velocity()),
      t_begin_(std::max(motion.A().t_begin(), motion.B().t_begin())),
      t_end_(std::min(motion.A().t_end(), motion.B().t_end())) {
  const RelativeState start = motion.state(t_begin_);
  A_ = {start.R_WA, -start.p_AQa, motion.A().axis(), motion.A().rate(),
        motion.A().rotation_error()};
  B_ = {start.R_WB, start.p_AB - start.p_AQb, motion.B().axis(), motion.B().rate(),
        motion.B().rotation_error()};
  offset_ = start.p_AQb - start.p_AQa;
  // A line's distance from a point is greatest at an end.
  offset_bound_ =
      std::max(offset_.norm(), (offset_ + (t_end_ - t_begin_) * drift_).norm()) * (1.0 + 0x1p-48);
  position_error_ = motion.position_error();
  rounding_ = (80.0 + 4.0 * std::max(A_.rate, B_.rate)) * 0x1p-53;
  axes_cosine_ = A_.axis.dot(B_.axis);
  axes_sine_ = A_.axis.cross(B_.axis).norm();
}

}  // namespace firstcontact
