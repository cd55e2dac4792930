#include <firstcontact/narrowphase/linear_contact.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>
#include <firstcontact/narrowphase/detail/turning_gap.h>
#include <firstcontact/narrowphase/precise_linear_contact.h>
#include <firstcontact/narrowphase/separating_direction.h>
#include <firstcontact/narrowphase/triangle_distance.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// Two features, A of at most three corners and B of at most two, relative to a common point.
///
/// Derivation of the errors, u = 2^-53: `from` and `to` of a corner are taken from a corner of A at
/// the same time. They are rounded by u of their sizes, which `reach` bounds. A product with a
/// direction of length 1 +- 4 u adds 4 u of it. Rounding of times adds a few u. 2^-47 = 64 u covers
/// the sum twice. Velocities are differences of two such positions, and have an error of their own.
class LinearPair {
 public:
  LinearPair(std::span<const LinearPoint> A, std::span<const LinearPoint> B,
             const LinearContactOptions& options)
      : corners_A_(A), corners_B_(B), options_(options) {
    const LinearPoint& origin = A[0];
    place(A, origin, A_);
    place(B, origin, B_);
    error_ = 0x1p-47 * (reach_ + options.margin);
  }

  LinearContact solve() const {
    LinearContact result;
    result.tolerance_used = options_.tolerance;
    if (is_apart_along_axes()) {
      return freed(result);
    }
    for (; result.steps < options_.maximum_steps; ++result.steps) {
      const TrianglePair now = at(result.t);
      const ClosestFeatures closest = triangle_distance(now.A, now.B);
      const double apart = closest.distance + error_ - options_.margin;
      // Half of the tolerance is left for steps that stop short of the margin.
      if (apart <= 0.5 * options_.tolerance) {
        return contact_at(result, options_.tolerance);
      }
      const bool cannot_tell = apart <= resolution() && options_.tolerance < resolution();
      const double next = cannot_tell ? result.t : free_until(now, closest, result.t);
      if (next > 1.0) {
        ++result.steps;
        return freed(result);
      }
      const bool is_stuck = !(next > result.t);
      if (is_stuck && apart <= options_.tolerance) {
        return contact_at(result, options_.tolerance);
      }
      if (is_stuck || result.steps == kPatience) {
        const LinearContact precise = solve_precisely(result, apart);
        if (is_stuck || precise.verdict != LinearVerdict::undecided) {
          return precise;
        }
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

  /// Steps before double-doubles take over; a dozen times what most features take.
  ///
  /// A tiny gap lasts while the features turn. Double-doubles know a direction for that.
  static constexpr int kPatience = 100;

  /// [m]  Doubles cannot decide nearer to the margin.
  [[nodiscard]] double resolution() const { return 16.0 * error_; }

  static LinearContact freed(LinearContact result) {
    result.verdict = LinearVerdict::free;
    result.t = 1.0;
    return result;
  }

  static LinearContact contact_at(LinearContact result, double tolerance) {
    result.verdict = LinearVerdict::contact;
    result.tolerance_used = tolerance;
    return result;
  }

  /// Goes on in double-double from the time that doubles reached.
  ///
  /// @param apart  [m]  above the margin, at most
  [[nodiscard]] LinearContact solve_precisely(LinearContact result, double apart) const {
    if (!suits_double_doubles(reach_)) {
      return apart <= resolution() ? contact_at(result, std::max(apart, options_.tolerance))
                                   : result;
    }
    const PreciseLinearContact found =
        precise_linear_contact(precise(corners_A_), precise(corners_B_),
                               {.threshold = options_.margin,
                                .tolerance = options_.tolerance,
                                .least_tolerance = resolution(),
                                .t_begin = result.t});
    result.steps += found.steps;
    result.t = found.t;
    if (found.verdict == PreciseLinearVerdict::contact) {
      return contact_at(result, found.tolerance_used);
    }
    result.verdict = found.verdict == PreciseLinearVerdict::free ? LinearVerdict::free
                                                                 : LinearVerdict::undecided;
    return result;
  }

  static PreciseLinearFeature precise(std::span<const LinearPoint> corners) {
    PreciseLinearFeature feature;
    feature.count = corners.size();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      feature.corners[k] = {DoubleDoubleVector3(corners[k].from),
                            DoubleDoubleVector3(corners[k].to)};
    }
    return feature;
  }

  [[nodiscard]] TrianglePair at(double t) const {
    const auto point = [t](const LinearPoint& p) {
      return Vector3d((1.0 - t) * p.from + t * p.to);
    };
    return {{point(A_[0]), point(A_[1]), point(A_[2])}, {point(B_[0]), point(B_[1]), point(B_[2])}};
  }

  /// Whether the features are apart along an axis for all of [0, 1].
  ///
  /// Most features are far apart, and this decides them at once. A function that is linear in time
  /// is positive throughout if it is positive at both ends.
  [[nodiscard]] bool is_apart_along_axes() const {
    const Bounds A(A_);
    const Bounds B(B_);
    const double least = options_.margin + error_;
    const auto beyond = [least](const Bounds& low, const Bounds& high) {
      const auto from = high.low_from.array() - low.high_from.array() > least;
      const auto to = high.low_to.array() - low.high_to.array() > least;
      return (from && to).any();
    };
    return beyond(A, B) || beyond(B, A);
  }

  /// The bounds around the corners, at both ends.
  struct Bounds {
    explicit Bounds(const std::array<LinearPoint, 3>& corners)
        : low_from(corners[0].from),
          high_from(corners[0].from),
          low_to(corners[0].to),
          high_to(corners[0].to) {
      for (const LinearPoint& corner : corners) {
        low_from = low_from.cwiseMin(corner.from);
        high_from = high_from.cwiseMax(corner.from);
        low_to = low_to.cwiseMin(corner.to);
        high_to = high_to.cwiseMax(corner.to);
      }
    }

    Vector3d low_from;
    Vector3d high_from;
    Vector3d low_to;
    Vector3d high_to;
  };

  [[nodiscard]] detail::MovingCorners moving(const Triangle& position,
                                             const std::array<LinearPoint, 3>& corners,
                                             std::size_t count) const {
    detail::MovingCorners moving;
    moving.position = position;
    for (std::size_t k = 0; k < 3; ++k) {
      moving.velocity[k] = corners[k].to - corners[k].from;
    }
    moving.count = count;
    moving.slip = 4.0 * detail::kGapRounding * reach_;
    return moving;
  }

  /// The time until which the features are proven apart from t on, by the best direction; beyond 1
  /// where that is to the end.
  [[nodiscard]] double free_until(const TrianglePair& now, const ClosestFeatures& closest,
                                  double t) const {
    const detail::MovingCorners A = moving(now.A, A_, corners_A_.size());
    const detail::MovingCorners B = moving(now.B, B_, corners_B_.size());
    const double enough = (1.0 - t) * (1.0 + 0x1p-40) + 0x1p-50;
    double best = 0.0;
    const Vector3d d = closest.p_B - closest.p_A;
    const auto consider = [&](const Vector3d& direction) {
      const double length = direction.norm();
      if (length > 0.0 && best < enough) {
        best = std::max(best, detail::time_apart_along(A, B, closest, options_.margin + error_,
                                                       direction / length, enough));
      }
    };
    consider(d);
    if (d.norm() < 0x1p-20 * reach_) {
      const Vector3d by_features = separating_direction(now, closest);
      consider(by_features.dot(d) < 0.0 ? Vector3d(-by_features) : by_features);
    }
    if (!(best > 0.0)) {
      for_each_plane_normal(now, [&](const Vector3d& n) {
        consider(n);
        consider(-n);
      });
    }
    if (best >= enough) {
      return 2.0;
    }
    // Rounded down by more than the error of the sum, which is below 2^-53.
    return std::max(t, t + best * (1.0 - 0x1p-45) - 0x1p-53);
  }

  std::span<const LinearPoint> corners_A_;
  std::span<const LinearPoint> corners_B_;
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
        detail::shortest(options.margin) + " and " + detail::shortest(options.tolerance));
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
