#include <firstcontact/motion/constant_rate_path.h>

#include <algorithm>

#include <firstcontact/math/fast_sine_cosine.h>
#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {
namespace {

DoubleDouble angle_at(const DoubleDouble& rate, double t, double t_begin) {
  return rate * two_sum(t, -t_begin);
}

void set_column(Eigen::Matrix3d& m, int column, const DoubleDoubleVector3& v) {
  m.col(column) = v.value();
}

double rounded_length(const DoubleDoubleVector3& v) { return v.value().norm(); }

}  // namespace

ConstantRatePath::ConstantRatePath(const ConstantRateSegment& segment, const Eigen::Vector3d& p_BC)
    : t_begin_(segment.t_begin),
      t_end_(segment.t_end),
      rate_(segment.rate),
      axis_(Eigen::Vector3d::Zero()),
      p_WQ_(segment.p_WQ),
      velocity_(segment.velocity) {
  const DoubleDoubleVector3 p_QC_B = DoubleDoubleVector3(p_BC) - segment.p_BQ;
  const DoubleDoubleVector3 lever = p_QC_B.c[0] * segment.rotation[0] +
                                    p_QC_B.c[1] * segment.rotation[1] +
                                    p_QC_B.c[2] * segment.rotation[2];
  const bool turns = rate_.hi != 0.0;
  if (turns) {
    axis_ = segment.axis.value();
    const DoubleDoubleVector3 along = dot(segment.axis, lever) * segment.axis;
    p_WQ_ = p_WQ_ + along;
    lever_cosine_ = lever - along;
    lever_sine_ = cross(segment.axis, lever);
  } else {
    p_WQ_ = p_WQ_ + lever;
  }
  for (int column = 0; column < 3; ++column) {
    const DoubleDoubleVector3& r = segment.rotation[column];
    if (turns) {
      const DoubleDoubleVector3 along = dot(segment.axis, r) * segment.axis;
      set_column(rotation_constant_, column, along);
      set_column(rotation_cosine_, column, r - along);
      set_column(rotation_sine_, column, cross(segment.axis, r));
    } else {
      set_column(rotation_constant_, column, r);
      set_column(rotation_cosine_, column, {});
      set_column(rotation_sine_, column, {});
    }
  }
  lever_length_ = rounded_length(lever_cosine_);
  // About 40 double-double operations lie between the stored parameters and the path. Each is
  // within 10 u^2 = 2^-102 of its operands. The rate's error grows with the angle.
  constexpr double kParameterError = 0x1p-96;
  const double angle = rate_.hi * (t_end_ - t_begin_);
  rotation_error_ = segment.rotation_error + kParameterError * (1.0 + angle);
  position_error_ = segment.position_error + segment.rotation_error * p_BC.norm() * 1.001 +
                    kParameterError * (1.0 + angle) *
                        (rounded_length(segment.p_WQ) + rounded_length(segment.velocity) +
                         rounded_length(p_QC_B) + p_BC.norm());
}

ConstantRatePath::State ConstantRatePath::state(double t) const {
  if (rate_.hi == 0.0) {
    return {rotation_constant_, Eigen::Vector3d::Zero()};
  }
  const SineCosine sc = fast_sine_cosine(angle_at(rate_, t, t_begin_));
  return {rotation_constant_ + sc.cosine * rotation_cosine_ + sc.sine * rotation_sine_,
          sc.cosine * lever_cosine_.value() + sc.sine * lever_sine_.value()};
}

DoubleDoubleVector3 ConstantRatePath::pivot(double t) const {
  return p_WQ_ + two_sum(t, -t_begin_) * velocity_;
}

DoubleDoubleVector3 ConstantRatePath::precise_lever(double t) const {
  if (rate_.hi == 0.0) {
    return {};
  }
  const DoubleDoubleSineCosine sc = precise_sine_cosine(angle_at(rate_, t, t_begin_));
  return sc.cosine * lever_cosine_ + sc.sine * lever_sine_;
}

}  // namespace firstcontact
