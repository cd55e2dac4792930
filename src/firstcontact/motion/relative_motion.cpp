#include <firstcontact/motion/relative_motion.h>

#include <algorithm>

namespace firstcontact {

RelativeMotion::RelativeMotion(const ConstantRatePath& A, const ConstantRatePath& B,
                               double resolution)
    : A_(A),
      B_(B),
      t_begin_(std::max(A.t_begin(), B.t_begin())),
      p_QaQb_(B.pivot(t_begin_) - A.pivot(t_begin_)),
      relative_velocity_(B.pivot_velocity() - A.pivot_velocity()),
      velocity_(relative_velocity_.value()) {
  // 12 units in the last place for each lever, and a rounding of each difference.
  const double lever_error = 0x1p-49 * (A.lever_length() + B.lever_length());
  precise_ = lever_error > 0.01 * resolution;
  const double parameters = A.position_error() + B.position_error();
  position_error_ = parameters + (precise_ ? 0x1p-92 * lever_error * 0x1p49 : lever_error);
}

RelativeState RelativeMotion::state(double t) const {
  const ConstantRatePath::State a = A_.state(t);
  const ConstantRatePath::State b = B_.state(t);
  const DoubleDoubleVector3 p_QaQb = p_QaQb_ + two_sum(t, -t_begin_) * relative_velocity_;
  RelativeState state;
  state.t = t;
  state.R_WA = a.R_WB;
  state.R_WB = b.R_WB;
  if (precise_) {
    state.p_AB = (p_QaQb + B_.precise_lever(t) - A_.precise_lever(t)).value();
  } else {
    state.p_AB = p_QaQb.value() + (b.p_QC_W - a.p_QC_W);
  }
  state.p_AQa = -a.p_QC_W;
  state.p_AQb = state.p_AB - b.p_QC_W;
  state.axis_A = A_.axis();
  state.axis_B = B_.axis();
  state.rate_A = A_.rate();
  state.rate_B = B_.rate();
  state.pivot_velocity = velocity_;
  state.position_error = position_error_;
  state.rotation_error_A = A_.rotation_error();
  state.rotation_error_B = B_.rotation_error();
  return state;
}

}  // namespace firstcontact
