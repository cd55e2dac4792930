#include <firstcontact/contact_solver/detail/coulomb_cone.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Added to a response, relative to its greatest entry: a locked axis leaves a direction without
/// one.
constexpr double kRegularisation = 1e-13;

/// [-]  Tolerance of the side of a cone.
constexpr double kConeTolerance = 1e-13;

/// The rotation about the normal to axes along which a tangential system is diagonal.
Matrix3d principal_turn(const Matrix2d& A) {
  // Half the angle of (x, y), by sums of terms of one sign.
  const double x = A(0, 0) - A(1, 1);
  const double y = 2.0 * A(0, 1);
  const double length = std::sqrt(x * x + y * y);
  double c = 1.0;
  double s = 0.0;
  if (length > 0.0) {
    const double greater = std::sqrt(0.5 * (1.0 + std::abs(x) / length));
    const double lesser = 0.5 * std::abs(y) / length / greater;
    c = x >= 0.0 ? greater : lesser;
    s = std::copysign(x >= 0.0 ? lesser : greater, y);
  }
  Matrix3d turn = Matrix3d::Identity();
  turn.bottomRightCorner<2, 2>() << c, s, -s, c;
  return turn;
}

Matrix2d tangential_system(const Matrix3d& W) {
  return W.bottomRightCorner<2, 2>() -
         W.bottomLeftCorner<2, 1>() * W.topRightCorner<1, 2>() / W(0, 0);
}

}  // namespace

Vector3d project_on_cone(const Vector3d& r, double friction) {
  const double side = r.tail<2>().norm();
  if (friction * side <= -r[0]) {
    return Vector3d::Zero();  // First: without friction, r = -n is not beyond the side, either.
  }
  if (side <= friction * r[0]) {
    return r;
  }
  const double normal = (r[0] + friction * side) / (1.0 + friction * friction);
  const double scale = friction * normal / side;
  return {normal, scale * r[1], scale * r[2]};
}

Matrix3d cone_projection_derivative(const Vector3d& r, double friction) {
  const double side = r.tail<2>().norm();
  if (friction * side <= -r[0]) {
    return Matrix3d::Zero();
  }
  if (side <= friction * r[0]) {
    return Matrix3d::Identity();
  }
  const Vector3d across(0.0, -r[2] / side, r[1] / side);
  const Vector3d along(1.0, friction * r[1] / side, friction * r[2] / side);
  const double normal = (r[0] + friction * side) / (1.0 + friction * friction);
  return along * along.transpose() / (1.0 + friction * friction) +
         (friction * normal / side) * across * across.transpose();
}

ContactResponse::ContactResponse(const Matrix3d& W)
    : turn_(Matrix3d::Identity()),
      W_(W),
      inverse_(Matrix3d::Zero()),
      a_(Vector2d::Zero()),
      coupling_(Vector2d::Zero()),
      greatest_(W(0, 0) > 0.0 ? W.diagonal().maxCoeff() : 0.0) {
  if (!(greatest_ > 0.0)) {
    return;
  }
  const Matrix3d regular = W + kRegularisation * greatest_ * Matrix3d::Identity();
  turn_ = principal_turn(tangential_system(regular));
  W_ = turn_ * regular * turn_.transpose();
  inverse_ = W_.inverse();
  a_ = tangential_system(W_).diagonal();
  coupling_ = W_.bottomLeftCorner<2, 1>() / W_(0, 0);
}

Vector3d ContactResponse::impulse(const Vector3d& u_free, double friction) const {
  if (u_free[0] >= 0.0 || !(greatest_ > 0.0)) {
    return Vector3d::Zero();
  }
  if (friction == 0.0) {
    return {-u_free[0] / W_(0, 0), 0.0, 0.0};
  }
  Vector3d sticking = -inverse_ * u_free;
  if (sticking[0] >= 0.0 && sticking.tail<2>().norm() <= friction * sticking[0]) {
    return sticking;
  }
  return sliding(u_free, friction);
}

Vector3d ContactResponse::sliding(const Vector3d& u_free, double friction) const {
  const Vector2d c = u_free.tail<2>() - coupling_ * u_free[0];
  const double pressed = -u_free[0] / W_(0, 0);  // r_n without tangential impulse, > 0.
  // Exact where A is isotropic and nothing is coupled.
  double alpha = std::max(0.0, c.norm() / (friction * pressed) - a_.maxCoeff());
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();
  Vector3d r = Vector3d::Zero();
  for (int k = 0; k < 60; ++k) {
    const Eigen::Array2d inverse = (a_.array() + alpha).inverse();
    const Eigen::Array2d r_t = -c.array() * inverse;
    const Eigen::Array2d rate = -r_t * inverse;  // d r_t / d alpha
    const double normal = pressed - coupling_.dot(r_t.matrix());
    const double per_side = 1.0 / r_t.matrix().norm();
    r << normal, r_t;
    // mu r_n / |r_t| is almost a line. Below 1, r is outside the cone and alpha is too small.
    const double ratio = friction * normal * per_side;
    if (std::abs(ratio - 1.0) <= kConeTolerance) {
      break;
    }
    (ratio < 1.0 ? low : high) = alpha;
    const double slope = -per_side * (friction * coupling_.dot(rate.matrix()) +
                                      ratio * per_side * (r_t * rate).sum());
    double next = alpha - (ratio - 1.0) / slope;
    if (!(next > low && next < high)) {  // Newton's step left the bracket, or there is none.
      next = high < std::numeric_limits<double>::infinity() ? 0.5 * (low + high)
                                                            : 2.0 * alpha + a_.maxCoeff();
    }
    if (next == alpha) {
      break;
    }
    alpha = next;
  }
  return r;
}

}  // namespace firstcontact::detail
