#include <firstcontact/narrowphase/linear_contact.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/narrowphase/separating_direction.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// Two features, A of at most three corners and B of at most two, relative to a common point.
///
/// Derivation of the errors, u = 2^-53: `from` and `to` of a corner, taken from a corner of A at
/// the same time, are rounded by u of their sizes, which `reach` bounds. A product with a direction
/// of length 1 +- 4 u adds 4 u of it. The zeros of linear functions, and rounding of times, add 12
/// u. With 2^-47 = 64 u all of it is covered twice.
class LinearPair {
 public:
  LinearPair(std::span<const LinearPoint> A, std::span<const LinearPoint> B,
             const LinearContactOptions& options)
      : size_A_(A.size()), size_B_(B.size()), options_(options) {
    const LinearPoint& origin = A[0];
    place(A, origin, A_);
    place(B, origin, B_);
    error_ = 0x1p-47 * (reach_ + options.margin);
  }

  LinearContact solve() const {
    LinearContact result;
    if (is_apart_along_axes()) {
      return {LinearVerdict::free, 1.0, 0};
    }
    for (; result.steps < options_.maximum_steps; ++result.steps) {
      const TrianglePair now = at(result.t);
      const ClosestFeatures closest = triangle_distance(now.A, now.B);
      // Half of the tolerance is left for steps that stop short of the margin.
      if (closest.distance + error_ <= options_.margin + 0.5 * options_.tolerance) {
        result.verdict = LinearVerdict::contact;
        return result;
      }
      const double next = free_until(now, closest, result.t);
      if (next > 1.0) {
        return {LinearVerdict::free, 1.0, result.steps + 1};
      }
      if (!(next > result.t)) {
        result.verdict = closest.distance + error_ <= options_.margin + options_.tolerance
                             ? LinearVerdict::contact
                             : LinearVerdict::undecided;
        return result;
      }
      result.t = next;
    }
    return result;
  }

 private:
  void place(std::span<const LinearPoint> corners, const LinearPoint& origin,
             std::array<LinearPoint, 3>& placed) {
    for (std::size_t k = 0; k < 3; ++k) {
      const LinearPoint& corner = corners[std::min(k, corners.size() - 1)];
      placed[k] = {corner.from - origin.from, corner.to - origin.to};
      reach_ = std::max({reach_, placed[k].from.norm(), placed[k].to.norm()});
    }
  }

  [[nodiscard]] TrianglePair at(double t) const {
    const auto point = [t](const LinearPoint& p) {
      return Vector3d((1.0 - t) * p.from + t * p.to);
    };
    return {{point(A_[0]), point(A_[1]), point(A_[2])}, {point(B_[0]), point(B_[1]), point(B_[2])}};
  }

  /// For all of [0, 1]; most features are far apart, and this says so at once.
  [[nodiscard]] bool is_apart_along_axes() const {
    for (int k = 0; k < 3; ++k) {
      Vector3d n = Vector3d::Unit(k);
      if (free_along(n, 0.0) > 1.0 || free_along(-n, 0.0) > 1.0) {
        return true;
      }
    }
    return false;
  }

  /// Until when B is proven farther than the margin along the unit direction n from all of A, from
  /// t on; t where that is not so at t, beyond 1 where it is so to the end.
  [[nodiscard]] double free_along(const Vector3d& n, double t) const {
    std::array<double, 3> from_A;
    std::array<double, 3> to_A;
    for (std::size_t i = 0; i < size_A_; ++i) {
      from_A[i] = n.dot(A_[i].from);
      to_A[i] = n.dot(A_[i].to);
    }
    double until = 2.0;
    for (std::size_t j = 0; j < size_B_; ++j) {
      const double from_B = n.dot(B_[j].from) - options_.margin - error_;
      const double to_B = n.dot(B_[j].to) - options_.margin - error_;
      for (std::size_t i = 0; i < size_A_; ++i) {
        until = std::min(until, positive_until(from_B - from_A[i], to_B - to_A[i], t));
      }
    }
    return until;
  }

  /// How long (1 - s) a + s b is positive from s = t on; 2 for all of it.
  static double positive_until(double a, double b, double t) {
    const double now = (1.0 - t) * a + t * b;
    if (!(now > 0x1p-50 * std::max(std::abs(a), std::abs(b)))) {
      return t;
    }
    if (b > 0.0) {
      return 2.0;
    }
    // The zero is at t + (1 - t) now / (now - b). Rounded down by far more than its errors.
    const double step = (1.0 - t) * (now / (now - b));
    return std::min(1.0, t + step * (1.0 - 0x1p-45));
  }

  /// The longest that any of the directions proves.
  [[nodiscard]] double free_until(const TrianglePair& now, const ClosestFeatures& closest,
                                  double t) const {
    double best = t;
    const Vector3d d = closest.p_B - closest.p_A;
    const auto consider = [&](const Vector3d& direction) {
      const double length = direction.norm();
      if (length > 0.0 && best <= 1.0) {
        best = std::max(best, free_along(direction / length, t));
      }
    };
    consider(d);
    if (d.norm() < 0x1p-20 * reach_) {
      const Vector3d by_features = separating_direction(now, closest);
      consider(by_features.dot(d) < 0.0 ? Vector3d(-by_features) : by_features);
    }
    if (!(best > t)) {
      for_each_plane_normal(now, [&](const Vector3d& n) {
        consider(n);
        consider(-n);
      });
    }
    return best;
  }

  std::size_t size_A_;
  std::size_t size_B_;
  LinearContactOptions options_;
  std::array<LinearPoint, 3> A_;
  std::array<LinearPoint, 3> B_;
  double reach_ = 0.0;
  double error_ = 0.0;
};

LinearContact solve(std::span<const LinearPoint> A, std::span<const LinearPoint> B,
                    const LinearContactOptions& options) {
  if (!(options.margin >= 0.0 && std::isfinite(options.margin) && options.tolerance > 0.0 &&
        std::isfinite(options.tolerance))) {
    throw std::invalid_argument(
        "LinearContactOptions: margin must be finite and >= 0, tolerance finite and > 0, got " +
        std::to_string(options.margin) + " and " + std::to_string(options.tolerance));
  }
  const FloatEnvironmentGuard guard;
  return LinearPair(A, B, options).solve();
}

}  // namespace

LinearContact linear_vertex_face_contact(const LinearPoint& vertex, const LinearFace& face,
                                         const LinearContactOptions& options) {
  return solve(face, std::span(&vertex, 1), options);
}

LinearContact linear_edge_edge_contact(const LinearEdge& A, const LinearEdge& B,
                                       const LinearContactOptions& options) {
  return solve(A, B, options);
}

}  // namespace firstcontact
