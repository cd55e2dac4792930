#include <firstcontact/simulation_model/detail/common_normal.h>

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMostSteps = 50;
constexpr int kMostHalvings = 30;
/// [-]  A step that turns the normal by less is taken as it is, as f is too flat there to compare.
constexpr double kSmallTurn = 1e-5;

/// The distance of two sides along directions.
class Separation {
 public:
  explicit Separation(const std::array<NormalSide, 2>& sides)
      : sides_(sides), apart_(sides[1].point - sides[0].point) {
    for (const NormalSide& side : sides) {
      line_ = side.line ? side.line : line_;
    }
  }

  [[nodiscard]] double along(const Vector3d& n) const {
    double f = n.dot(apart_);
    for (const NormalSide& side : sides_) {
      f -= n.dot(side.farthest(n));
    }
    return f;
  }

  /// The unit vector nearest to v that is normal to the line.
  [[nodiscard]] Vector3d allowed(const Vector3d& v) const {
    return (line_ ? Vector3d(v - v.dot(*line_) * *line_) : v).stableNormalized();
  }

  /// Newton's step from n, tangent to the sphere there.
  ///
  /// Where f is not concave, only the part that makes it so is used: f grows along that, too.
  [[nodiscard]] Vector3d step(const Vector3d& n) const {
    Vector3d gradient = apart_;
    Matrix3d bend = Matrix3d::Zero();  // Minus the second derivative of f in space.
    for (const NormalSide& side : sides_) {
      if (side.squares) {
        const Vector3d farthest = side.farthest(n);
        gradient -= farthest;
        bend += (*side.squares - farthest * farthest.transpose()) / n.dot(farthest);
      }
    }
    const double f = n.dot(gradient);
    const Vector3d u = line_ ? n.cross(*line_) : n.unitOrthogonal();
    if (line_) {
      const double bent = u.dot(bend * u);
      return u * (u.dot(gradient) / (bent + f > 0.0 ? bent + f : bent));
    }
    Eigen::Matrix<double, 3, 2> tangents;
    tangents << u, n.cross(u);
    const Eigen::Matrix2d along = tangents.transpose() * bend * tangents;
    const Eigen::Matrix2d on_sphere = along + f * Eigen::Matrix2d::Identity();
    const bool is_concave = on_sphere.trace() > 0.0 && on_sphere.determinant() > 0.0;
    return tangents *
           (is_concave ? on_sphere : along).ldlt().solve(tangents.transpose() * gradient);
  }

 private:
  const std::array<NormalSide, 2>& sides_;
  Vector3d apart_;
  std::optional<Vector3d> line_;
};

/// Goes on until rounding keeps steps from becoming shorter.
///
/// @param step  from n
Vector3d take_small_steps(const Separation& separation, Vector3d n, Vector3d step) {
  double before = 2.0 * kSmallTurn;
  for (int k = 0; k < kMostSteps && step.norm() <= 0.5 * before; ++k) {
    before = step.norm();
    n = separation.allowed(n + step);
    step = separation.step(n);
  }
  return n;
}

}  // namespace

Vector3d NormalSide::farthest(const Vector3d& n) const {
  if (!squares) {
    return Vector3d::Zero();
  }
  const Vector3d stretched = *squares * n;
  return stretched / std::sqrt(n.dot(stretched));
}

Vector3d common_normal(const std::array<NormalSide, 2>& sides, const Vector3d& from) {
  const Separation separation(sides);
  Vector3d n = separation.allowed(from);
  double most = separation.along(n);
  for (int k = 0; k < kMostSteps; ++k) {
    Vector3d step = separation.step(n);
    if (!step.allFinite()) {
      break;
    }
    if (step.norm() <= kSmallTurn) {
      return take_small_steps(separation, n, step);
    }
    bool grows = false;
    for (int halvings = 0; halvings < kMostHalvings && !grows; ++halvings, step *= 0.5) {
      const Vector3d next = separation.allowed(n + step);
      const double f = separation.along(next);
      grows = f > most;
      if (grows) {
        n = next;
        most = f;
      }
    }
    if (!grows) {
      break;
    }
  }
  return n;
}

}  // namespace firstcontact::detail
