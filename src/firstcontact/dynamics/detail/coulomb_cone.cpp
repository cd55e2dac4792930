#include <firstcontact/dynamics/detail/coulomb_cone.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Added to a response, relative to its greatest entry: locked axes leave directions without one.
constexpr double kRegularisation = 1e-13;

/// The tangential impulse of a contact that slides with u_n = 0, for one guess of how fast.
struct Sliding {
  const Matrix3d& W;
  const Vector3d& u_free;
  double friction;
  Matrix2d A;
  Vector2d c;

  Sliding(const Matrix3d& response, const Vector3d& free, double mu)
      : W(response), u_free(free), friction(mu) {
    A = W.bottomRightCorner<2, 2>() -
        W.bottomLeftCorner<2, 1>() * W.topRightCorner<1, 2>() / W(0, 0);
    c = u_free.tail<2>() - W.bottomLeftCorner<2, 1>() * (u_free[0] / W(0, 0));
  }

  [[nodiscard]] Vector3d impulse(double alpha) const {
    const Vector2d r_t = -(A + alpha * Matrix2d::Identity()).inverse() * c;
    const double r_n = -(u_free[0] + W.topRightCorner<1, 2>().dot(r_t)) / W(0, 0);
    return {r_n, r_t[0], r_t[1]};
  }

  /// > 0: the impulse is outside the cone.
  [[nodiscard]] double excess(const Vector3d& r) const {
    return r.tail<2>().norm() - friction * r[0];
  }
};

Vector3d sliding_impulse(const Sliding& sliding) {
  // At alpha the tangential impulse is at most |c| / alpha, and r_n is then about -u_n / W_nn.
  double low = 0.0;
  double high = sliding.A.trace();
  while (sliding.excess(sliding.impulse(high)) > 0.0) {
    low = high;
    high *= 8.0;
    if (!(high < 1e300)) {
      return Vector3d::Zero();
    }
  }
  // Illinois' false position: keeps the bracket, and is faster than halving.
  double f_low = sliding.excess(sliding.impulse(low));
  double f_high = sliding.excess(sliding.impulse(high));
  for (int k = 0; k < 80 && high - low > 1e-15 * high; ++k) {
    const double split = f_low / (f_low - f_high);
    const double alpha =
        split > 0.0 && split < 1.0 ? low + split * (high - low) : 0.5 * (low + high);
    const double f = sliding.excess(sliding.impulse(alpha));
    if (f > 0.0) {
      low = alpha;
      f_low = f;
      f_high *= 0.5;
    } else {
      high = alpha;
      f_high = f;
      f_low *= 0.5;
    }
    if (f == 0.0) {
      break;
    }
  }
  return sliding.impulse(high);
}

}  // namespace

Vector3d project_on_cone(const Vector3d& r, double friction) {
  const double side = r.tail<2>().norm();
  if (side <= friction * r[0]) {
    return r;
  }
  if (friction * side <= -r[0]) {
    return Vector3d::Zero();
  }
  const double normal = (r[0] + friction * side) / (1.0 + friction * friction);
  const double scale = friction * normal / side;
  return {normal, scale * r[1], scale * r[2]};
}

Matrix3d cone_projection_derivative(const Vector3d& r, double friction) {
  const double side = r.tail<2>().norm();
  if (side <= friction * r[0]) {
    return Matrix3d::Identity();
  }
  if (friction * side <= -r[0]) {
    return Matrix3d::Zero();
  }
  const Vector3d across(0.0, -r[2] / side, r[1] / side);
  const Vector3d along(1.0, friction * r[1] / side, friction * r[2] / side);
  const double normal = (r[0] + friction * side) / (1.0 + friction * friction);
  return along * along.transpose() / (1.0 + friction * friction) +
         (friction * normal / side) * across * across.transpose();
}

Vector3d single_contact_impulse(const Matrix3d& response, const Vector3d& u_free, double friction) {
  if (u_free[0] >= 0.0 || !(response(0, 0) > 0.0)) {
    return Vector3d::Zero();
  }
  if (friction == 0.0) {
    return {-u_free[0] / response(0, 0), 0.0, 0.0};
  }
  const double greatest = response.diagonal().maxCoeff();
  const Matrix3d W = response + kRegularisation * greatest * Matrix3d::Identity();
  const Vector3d sticking = -W.inverse() * u_free;
  if (sticking[0] >= 0.0 && sticking.tail<2>().norm() <= friction * sticking[0]) {
    return sticking;
  }
  return sliding_impulse(Sliding(W, u_free, friction));
}

}  // namespace firstcontact::detail
