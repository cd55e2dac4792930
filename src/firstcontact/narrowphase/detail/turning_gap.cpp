#include <firstcontact/narrowphase/detail/turning_gap.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <firstcontact/math/root_isolation.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;
using Type = TriangleFeature::Type;

constexpr double kUp = 1.0 + 0x1p-40;

class TurningGap {
 public:
  TurningGap(const MovingCorners& A, const MovingCorners& B, double threshold)
      : A_(A), B_(B), h_(threshold) {}

  /// @param n        unit
  /// @param n_rate   its rate
  /// @param enough   no longer time is of interest
  [[nodiscard]] double time_open(const Vector3d& n, const Vector3d& n_rate, double enough) const {
    const double turning = n_rate.norm() * kUp;
    const double turned = turning * enough;
    const double acceleration = A_.acceleration(n, turned) + B_.acceleration(n, turned);
    const double growth =
        std::max(0.0, n.dot(n_rate)) + kGapRounding * turning;  // growth of |n(tau)|
    const double slip = A_.slip + B_.slip;
    double tau = enough;
    for (std::size_t i = 0; i < A_.count && tau > 0.0; ++i) {
      for (std::size_t j = 0; j < B_.count && tau > 0.0; ++j) {
        const Vector3d e = B_.position[j] - A_.position[i];
        const Vector3d e_rate = B_.velocity[j] - A_.velocity[i];
        const double gap = n.dot(e) - h_;
        const double speed = h_ * growth - n.dot(e_rate) - n_rate.dot(e) + slip +
                             kGapRounding * (e_rate.norm() + turning * e.norm());
        const double half_acceleration =
            std::max(0.0, 0.5 * h_ * turning * turning - n_rate.dot(e_rate)) + 0.5 * acceleration +
            turning * (slip + kGapRounding * e_rate.norm());
        tau = std::min(tau, time_to_close(gap, speed, half_acceleration));
      }
    }
    return tau;
  }

 private:
  const MovingCorners& A_;
  const MovingCorners& B_;
  double h_;
};

/// The edges of the closest features, with their rates: the directions that a separating plane
/// through them must keep to.
struct Directions {
  std::array<Vector3d, 2> edge;
  std::array<Vector3d, 2> rate;
  std::size_t count = 0;

  void add(const MovingCorners& c, int from) {
    const auto i = static_cast<std::size_t>(from);
    const std::size_t j = (i + 1) % 3;
    const Vector3d along = c.position[j] - c.position[i];
    if (count < edge.size() && along.squaredNorm() > 0.0) {
      edge[count] = along;
      rate[count] = c.velocity[j] - c.velocity[i];
      ++count;
    }
  }
  void add(const MovingCorners& c, const TriangleFeature& feature) {
    if (feature.type == Type::edge) {
      add(c, feature.index);
    } else if (feature.type == Type::face) {
      add(c, 0);
      add(c, 1);
    }
  }
};

/// The least n' with n' . e = -n . e' for each direction e; zero where there is none.
Vector3d keep_across(const Vector3d& n, const Directions& d) {
  if (d.count == 0) {
    return Vector3d::Zero();
  }
  if (d.count == 2) {
    const Vector3d m = d.edge[0].cross(d.edge[1]);
    const double area2 = m.squaredNorm();
    // Two edges that are nearly parallel would turn n wildly: one of them has to do.
    if (area2 > 1e-8 * d.edge[0].squaredNorm() * d.edge[1].squaredNorm()) {
      return (n.dot(d.rate[0]) / area2) * m.cross(d.edge[1]) -
             (n.dot(d.rate[1]) / area2) * m.cross(d.edge[0]);
    }
  }
  return -(n.dot(d.rate[0]) / d.edge[0].squaredNorm()) * d.edge[0];
}

}  // namespace

double time_apart_along(const MovingCorners& A, const MovingCorners& B,
                        const ClosestFeatures& closest, double threshold, const Vector3d& n,
                        double enough) {
  const TurningGap gap(A, B, threshold);
  const double fixed = gap.time_open(n, Vector3d::Zero(), enough);
  if (fixed >= enough) {
    return fixed;
  }
  Directions directions;
  directions.add(A, closest.feature_A);
  directions.add(B, closest.feature_B);
  const Vector3d turning = keep_across(n, directions);
  if (!(turning.squaredNorm() > 0.0) || !turning.allFinite()) {
    return fixed;
  }
  const double turned = gap.time_open(n, turning, enough);
  if (A.rate == 0.0 && B.rate == 0.0 && A.bend == 0.0 && B.bend == 0.0) {
    return std::max(fixed, turned);
  }
  // The accelerations of bodies that turn, or bend, grow with the time that they have to cover: a
  // shorter one may pay.
  const double shorter = std::min(enough, 8.0 * std::max(turned, fixed));
  return std::max({fixed, turned, gap.time_open(n, turning, shorter)});
}

}  // namespace firstcontact::detail
