#include <firstcontact/verification/detail/piece_motion.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace firstcontact::detail {
namespace {

/// The rotation of q / |q|: v + 2 (w q x v + q x (q x v)) / |q|^2.
IntervalMatrix3 rotation(const Eigen::Quaterniond& rotation) {
  const Interval w(rotation.w());
  const IntervalVector3 q = enclose(Eigen::Vector3d(rotation.vec()));
  const Interval twice = Interval(2.0) / (sqr(w) + dot(q, q));
  IntervalMatrix3 R = enclose(Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  for (IntervalVector3& column : R.columns) {
    const IntervalVector3 once = cross(q, column);
    column = column + twice * (w * once + cross(q, once));
  }
  return R;
}

/// Below this a rotation vector's square would underflow.
constexpr double kNoTurn = 0x1p-300;  // [rad]

/// The middle of an interval; what it may be off is added to `error`.
double middle(const Interval& x, double& error) {
  const double m = x.midpoint();
  error = std::max(error, x.width_bound());
  return m;
}

}  // namespace

PieceMotion::PieceMotion(const Pose& X_WB, double from, double to, const Eigen::Vector3d& p_BC)
    : from_(from),
      to_(to),
      position_(X_WB.position),
      R_(rotation(X_WB.rotation)),
      p_BC_W_(R_ * enclose(p_BC)) {}

PieceMotion::PieceMotion(const RunPiece& piece, double from, const Eigen::Vector3d& p_BC)
    : PieceMotion(piece.X_WB, from, piece.to, p_BC) {
  const double lasts = to_ - from_;
  translation_ = enclose(piece.translation);
  velocity_ = piece.translation / lasts;
  spin_ = piece.rotation_vector / lasts;
  const IntervalVector3 turn = enclose(piece.rotation_vector);
  if (piece.rotation_vector.cwiseAbs().maxCoeff() >= kNoTurn) {
    angle_ = norm(turn);
    axis_ = (Interval(1.0) / angle_) * turn;
  } else if (!piece.rotation_vector.isZero(0.0)) {
    for (IntervalVector3& column : R_.columns) {
      column = inflated(column, 2.0 * kNoTurn);
    }
  }
}

IntervalTransform PieceMotion::enclosure(double time, const Eigen::Vector3d& origin) const {
  IntervalTransform X{R_, (enclose(position_) - enclose(origin)) + p_BC_W_};
  const bool at_begin = time == from_;
  if (at_begin) {
    return X;
  }
  const Interval part =
      time == to_ ? Interval(1.0)
                  : (Interval(time) - Interval(from_)) / (Interval(to_) - Interval(from_));
  X.position = X.position + part * translation_;
  if (angle_ == Interval(0.0)) {
    return X;
  }
  const Interval turned = part * angle_;
  const Interval sine = sin(turned);
  const Interval versine = Interval(2.0) * sqr(sin(Interval(0.5) * turned));
  for (IntervalVector3& column : X.rotation.columns) {
    const IntervalVector3 once = cross(axis_, column);
    column = column + sine * once + versine * cross(axis_, once);
  }
  return X;
}

BodyInstant PieceMotion::instant(double time, const Eigen::Vector3d& origin) const {
  const IntervalTransform X = enclosure(time, origin);
  BodyInstant now;
  now.velocity = velocity_;
  now.spin = spin_;
  double entry_error = 0.0;
  double coordinate_error = 0.0;
  for (int i = 0; i < 3; ++i) {
    now.pivot[i] = middle(X.position.c[i], coordinate_error);
    for (int j = 0; j < 3; ++j) {
      now.R(i, j) = middle(X.rotation.columns[j].c[i], entry_error);
    }
  }
  now.pivot_error = 2.0 * coordinate_error;  // At least sqrt(3) of them.
  now.turn_error = 4.0 * entry_error;        // At least the norm of a matrix of them, 3.
  return now;
}

double deviation_bound(const IntervalTransform& a, const IntervalTransform& b, double reach) {
  Interval squares(0.0);
  for (std::size_t j = 0; j < 3; ++j) {
    const IntervalVector3 difference = a.rotation.columns[j] - b.rotation.columns[j];
    squares += dot(difference, difference);
  }
  return (norm(a.position - b.position) + sqrt(squares) * Interval(reach)).upper();
}

}  // namespace firstcontact::detail
