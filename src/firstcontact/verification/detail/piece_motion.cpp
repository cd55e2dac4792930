#include <firstcontact/verification/detail/piece_motion.h>

#include <array>
#include <cstddef>

namespace firstcontact::detail {
namespace {

/// Least rotation vector; the square of a shorter one would underflow.
constexpr double kNoTurn = 0x1p-300;  // [rad]

}  // namespace

PieceMotion::PieceMotion(const Pose& X_WB, double from, double to, const Eigen::Vector3d& p_BC)
    : CoveredMotion(from, to),
      position_(X_WB.position),
      R_(exact_rotation(X_WB.rotation)),
      p_BC_W_(R_ * enclose(p_BC)) {}

PieceMotion::PieceMotion(const RunPiece& piece, double from, const Eigen::Vector3d& p_BC)
    : PieceMotion(piece.X_WB, from, piece.to, p_BC) {
  const double lasts = to() - from;
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
  const bool at_begin = time == from();
  if (at_begin) {
    return X;
  }
  const Interval part =
      time == to() ? Interval(1.0)
                   : (Interval(time) - Interval(from())) / (Interval(to()) - Interval(from()));
  X.position = X.position + part * translation_;
  if (angle_ == Interval(0.0)) {
    return X;
  }
  X.rotation = rotated(axis_, part * angle_, X.rotation);
  return X;
}

BodyInstant PieceMotion::around(double time, double, const Eigen::Vector3d& origin) const {
  BodyInstant now = instant_of(enclosure(time, origin));
  now.velocity = velocity_;
  now.spin = spin_;
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
