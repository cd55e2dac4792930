#include <firstcontact/narrowphase/advance_deforming.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using Type = TriangleFeature::Type;

/// Positions and velocities are products and sums of a few rounded numbers: within 2^-48 of what
/// enters them.
constexpr double kRounding = 0x1p-48;
constexpr double kUp = 1.0 + 0x1p-40;

/// The corners of one triangle, and what bounds their motion.
struct Corners {
  const Triangle& position;
  Triangle velocity;
  double rate = 0.0;   // of the body
  Vector3d axis;       // of the body
  double reach = 0.0;  // [m]  of any corner from the pivot, to the end of the step
  double speed = 0.0;  // [m per step]  of any corner as its body sees it
  double slip = 0.0;   // [m per step]  error of a velocity

  /// Bounds w |n(tau) x u| (w |rho| + 2 |d|), errors of the axis included.
  [[nodiscard]] double acceleration(const Vector3d& n, double turned) const {
    const double across = n.cross(axis).norm() + turned + kRounding;
    return rate * across * (rate * reach + 2.0 * speed) * kUp;
  }
};

double longest(const Triangle& v, const Vector3d& from) {
  return std::sqrt(std::max(
      {(v[0] - from).squaredNorm(), (v[1] - from).squaredNorm(), (v[2] - from).squaredNorm()}));
}

/// @param offset  [m]  that positions were rounded by
Corners corners(const ConstantRatePath& path, const Triangle& position, const Triangle& rates,
                const Vector3d& pivot, const Vector3d& pivot_velocity, double offset,
                double time_left) {
  Corners c{.position = position, .velocity = {}, .rate = path.rate(), .axis = path.axis()};
  for (std::size_t k = 0; k < 3; ++k) {
    c.velocity[k] = pivot_velocity + c.rate * c.axis.cross(position[k] - pivot) + rates[k];
  }
  c.speed = longest(rates, Vector3d::Zero()) * kUp;
  c.reach = (longest(position, pivot) + c.speed * time_left) * kUp;
  c.slip = kRounding * (pivot_velocity.norm() + c.rate * (c.reach + offset) + c.speed);
  return c;
}

class TurningGap {
 public:
  TurningGap(const Corners& A, const Corners& B, double threshold) : A_(A), B_(B), h_(threshold) {}

  /// @param n        unit
  /// @param n_rate   its rate
  /// @param enough   no longer time is of interest
  [[nodiscard]] double time_open(const Vector3d& n, const Vector3d& n_rate, double enough) const {
    const double turning = n_rate.norm() * kUp;
    const double turned = turning * enough;
    const double acceleration = A_.acceleration(n, turned) + B_.acceleration(n, turned);
    const double growth = std::max(0.0, n.dot(n_rate)) + kRounding * turning;  // of |n(tau)|
    const double slip = A_.slip + B_.slip;
    double tau = enough;
    for (std::size_t i = 0; i < 3 && tau > 0.0; ++i) {
      for (std::size_t j = 0; j < 3 && tau > 0.0; ++j) {
        const Vector3d e = B_.position[j] - A_.position[i];
        const Vector3d e_rate = B_.velocity[j] - A_.velocity[i];
        const double gap = n.dot(e) - h_;
        const double speed = h_ * growth - n.dot(e_rate) - n_rate.dot(e) + slip +
                             kRounding * (e_rate.norm() + turning * e.norm());
        const double half_acceleration =
            std::max(0.0, 0.5 * h_ * turning * turning - n_rate.dot(e_rate)) + 0.5 * acceleration +
            turning * (slip + kRounding * e_rate.norm());
        tau = std::min(tau, time_to_close(gap, speed, half_acceleration));
      }
    }
    return tau;
  }

 private:
  const Corners& A_;
  const Corners& B_;
  double h_;
};

/// The edges of the closest features, with their rates: the directions that a separating plane
/// through them must keep to.
struct Directions {
  std::array<Vector3d, 2> edge;
  std::array<Vector3d, 2> rate;
  std::size_t count = 0;

  void add(const Corners& c, int from) {
    const auto i = static_cast<std::size_t>(from);
    const std::size_t j = (i + 1) % 3;
    if (count < edge.size()) {
      edge[count] = c.position[j] - c.position[i];
      rate[count] = c.velocity[j] - c.velocity[i];
      ++count;
    }
  }
  void add(const Corners& c, const TriangleFeature& feature) {
    if (feature.type == Type::edge) {
      add(c, feature.index);
    } else if (feature.type == Type::face) {
      add(c, 0);
      add(c, 1);
    }
  }
};

/// The least n' with n' . e = -n . e' for each direction e; zero where they do not define one.
Vector3d keep_across(const Vector3d& n, const Directions& d) {
  if (d.count == 1) {
    const double length2 = d.edge[0].squaredNorm();
    return length2 > 0.0 ? Vector3d(-(n.dot(d.rate[0]) / length2) * d.edge[0])
                         : Vector3d(Vector3d::Zero());
  }
  if (d.count == 2) {
    const Vector3d m = d.edge[0].cross(d.edge[1]);
    const double area2 = m.squaredNorm();
    // Nearly parallel edges would turn n wildly, for nothing.
    if (area2 > 1e-8 * d.edge[0].squaredNorm() * d.edge[1].squaredNorm()) {
      return (n.dot(d.rate[0]) / area2) * m.cross(d.edge[1]) -
             (n.dot(d.rate[1]) / area2) * m.cross(d.edge[0]);
    }
  }
  return Vector3d::Zero();
}

}  // namespace

double advance_deforming(const RelativeMotion& motion, const RelativeState& state,
                         const TrianglePair& pair, const TrianglePair& rates,
                         const ClosestFeatures& closest, const Vector3d& n, double threshold,
                         double error, double t, double t_end) {
  const double time_left = t_end - t;
  const double enough = time_left * (1.0 + 0x1p-40) + 0x1p-100;
  const double offset = state.p_AB.norm();
  const Corners A =
      corners(motion.A(), pair.A, rates.A, state.p_AQa, Vector3d::Zero(), offset, time_left);
  const Corners B =
      corners(motion.B(), pair.B, rates.B, state.p_AQb, motion.pivot_velocity(), offset, time_left);
  const TurningGap gap(A, B, threshold + error);
  const double fixed = gap.time_open(n, Vector3d::Zero(), enough);
  Directions directions;
  directions.add(A, closest.feature_A);
  directions.add(B, closest.feature_B);
  const Vector3d turning = keep_across(n, directions);
  if (fixed >= enough || !(turning.squaredNorm() > 0.0) || !turning.allFinite()) {
    return fixed;
  }
  const double turned = gap.time_open(n, turning, enough);
  // The terms of second order grow with the time that they have to cover: a shorter one may pay.
  const double shorter = std::min(enough, 8.0 * std::max(turned, fixed));
  return std::max({fixed, turned, gap.time_open(n, turning, shorter)});
}

}  // namespace firstcontact
