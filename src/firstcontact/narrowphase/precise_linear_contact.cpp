#include <firstcontact/narrowphase/precise_linear_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <firstcontact/math/root_isolation.h>
#include <firstcontact/narrowphase/detail/precise_closest.h>

namespace firstcontact {
namespace {

using detail::PreciseClosest;
using detail::PreciseCorners;
using Type = TriangleFeature::Type;
using Vector = DoubleDoubleVector3;

constexpr double kRounding = 0x1p-96;  // [-]  Error of a gap or a rate, relative to its terms: see
                                       // the header.
constexpr double kDifference = 0x1p-102;  // [-]  Error of the difference of two positions, relative
                                          // to their size.
constexpr double kUp = 1.0 + 0x1p-40;

/// [-]  Two edges at a smaller angle have only rounding across each other.
constexpr double kParallel = 0x1p-80;

/// Most steps. They are spent where features slide along each other, nearer than doubles
/// distinguish.
constexpr int kMostSteps = 400;

double length(const Vector& v) { return v.value().stableNorm(); }

/// An upper bound of the value, which is within `error`.
double above(const DoubleDouble& x, double error) {
  return x.hi + 0x1p-52 * std::abs(x.hi) + error;
}

/// The unit vector along v, to 32 u^2; zero where v is.
Vector normalised(const Vector& v) {
  const double size = length(v);
  if (!(size > 0.0) || !std::isfinite(size)) {
    return {};
  }
  const Vector scaled = DoubleDouble(std::exp2(-std::ilogb(size))) * v;  // Squares stay in range.
  return DoubleDouble(1.0) / norm(scaled) * scaled;
}

/// Positions at one time, and rates.
struct Moving {
  PreciseCorners at;
  std::array<Vector, 3> rate;
};

/// The edges of the closest features with their rates; a direction that turns stays across them.
struct Directions {
  std::array<Vector, 2> edge;
  std::array<Vector, 2> rate;
  std::size_t count = 0;

  void add(const Moving& m, int from) {
    const auto i = static_cast<std::size_t>(from);
    const Vector along = edge_of(m.at, from);
    if (count < edge.size() && length(along) > 0.0) {
      edge[count] = along;
      rate[count] = m.rate[(i + 1) % m.at.count] - m.rate[i];
      ++count;
    }
  }
  void add(const Moving& m, const TriangleFeature& feature) {
    if (feature.type == Type::edge) {
      add(m, feature.index);
    } else if (feature.type == Type::face) {
      add(m, 0);
      add(m, 1);
    }
  }
};

/// The least n' with n' . e = -n . e' for each direction e, as in detail/turning_gap.cpp.
///
/// The part w of the second direction across the first takes the place of the second. So nearly
/// parallel directions serve, too: as n is across the first, n . w' does not depend on how w's
/// share of the first changes.
Vector keep_across(const Vector& n, const Directions& d) {
  if (d.count == 0) {
    return {};
  }
  const DoubleDouble square = dot(d.edge[0], d.edge[0]);
  const Vector turning = -(dot(n, d.rate[0]) / square) * d.edge[0];
  if (d.count == 1) {
    return turning;
  }
  const DoubleDouble share = dot(d.edge[1], d.edge[0]) / square;
  const Vector w = d.edge[1] - share * d.edge[0];
  if (!(length(w) > kParallel * length(d.edge[1]))) {
    return turning;
  }
  return turning - (dot(n, d.rate[1] - share * d.rate[0]) / dot(w, w)) * w;
}

/// A cubic c0 + c1 tau + c2 tau^2 + c3 tau^3.
using Cubic = std::array<double, 4>;

/// Whether the cubic is positive on [0, tau]: it lies in the hull of its Bernstein coefficients
/// there.
///
/// Each coefficient is a sum of four terms, and within 2^-50 of these.
bool is_positive_until(const Cubic& c, double tau) {
  const double b1 = c[1] * tau;
  const double b2 = c[2] * tau * tau;
  const double b3 = c[3] * tau * tau * tau;
  const double error = 0x1p-50 * (std::abs(c[0]) + std::abs(b1) + std::abs(b2) + std::abs(b3));
  return c[0] > error && c[0] + b1 / 3.0 > error && c[0] + 2.0 / 3.0 * b1 + b2 / 3.0 > error &&
         c[0] + b1 + b2 + b3 > error;
}

class PreciseSearch {
 public:
  PreciseSearch(const PreciseLinearFeature& A, const PreciseLinearFeature& B,
                const PreciseLinearOptions& options)
      : A_(A), B_(B), options_(options), t_(options.t_begin) {
    double size = 0.0;  // Size of the coordinates.
    const PreciseLinearPoint origin = A.corners[0];
    for (PreciseLinearFeature* feature : {&A_, &B_}) {
      for (std::size_t k = 0; k < feature->count; ++k) {
        PreciseLinearPoint& p = feature->corners[k];
        size = std::max({size, length(p.from), length(p.to)});
        p = {p.from - origin.from, p.to - origin.to};
        reach_ = std::max({reach_, 4.0 * length(p.from), 4.0 * length(p.to)});
      }
    }
    error_ = kRounding * (reach_ + options.threshold) + kDifference * size +
             4.0 * options.position_error;
    tolerance_ = std::max(options.tolerance, 8.0 * error_);
  }

  PreciseLinearContact run() {
    for (; result_.steps < kMostSteps; ++result_.steps) {
      move_to(t_);
      closest_ = precise_closest(now_A_.at, now_B_.at);
      const double apart = distance_above(closest_);
      if (apart <= options_.threshold + 0.5 * tolerance_) {
        return contact();
      }
      const double tau = free_for();
      if (tau >= time_left()) {
        result_.verdict = PreciseLinearVerdict::free;
        result_.t = 1.0;
        return result_;
      }
      const DoubleDouble next = t_ + DoubleDouble(tau * (1.0 - 0x1p-45));
      if (!(tau > 0x1p-90)) {
        break;
      }
      t_ = next;
    }
    return stalled();
  }

 private:
  void move_to(const DoubleDouble& t) {
    place(A_, t, now_A_);
    place(B_, t, now_B_);
  }
  static Vector at(const PreciseLinearPoint& p, const DoubleDouble& t) {
    return p.from + t * (p.to - p.from);
  }
  static void place(const PreciseLinearFeature& feature, const DoubleDouble& t, Moving& now) {
    now.at.count = feature.count;
    for (std::size_t k = 0; k < feature.count; ++k) {
      const PreciseLinearPoint& p = feature.corners[k];
      now.at.p[k] = at(p, t);
      now.rate[k] = p.to - p.from;
    }
  }

  [[nodiscard]] double distance_above(const PreciseClosest& closest) const {
    return std::sqrt(closest.square.hi) * (1.0 + 0x1p-50) + error_;
  }

  /// The time left, rounded up.
  [[nodiscard]] double time_left() const { return above(DoubleDouble(1.0) - t_, 0x1p-100); }

  /// The time for which the features are proven apart, by the best direction.
  [[nodiscard]] double free_for() const {
    const double enough = time_left();
    double best = 0.0;
    const auto consider = [&](const Vector& direction) {
      if (best < enough) {
        const Vector n = normalised(direction);
        if (length(n) > 0.5) {
          best = std::max(best, time_apart_along(n, enough));
        }
      }
    };
    const Vector by_features = precise_direction(now_A_.at, now_B_.at, closest_);
    consider(dot(by_features, closest_.d).hi < 0.0 ? Vector(DoubleDouble(-1.0) * by_features)
                                                   : by_features);
    consider(closest_.d);
    if (best < enough) {
      best = std::max(best, time_across_features(enough));
    }
    if (!(best > 0.0)) {
      for_each_plane_normal(consider);
    }
    return best;
  }

  /// Calls use(n) as for_each_plane_normal() of separating_direction.h does.
  template <class Use>
  void for_each_plane_normal(const Use& use) const {
    const auto both = [&](const Vector& n) {
      use(n);
      use(DoubleDouble(-1.0) * n);
    };
    for (const PreciseCorners* c : {&now_A_.at, &now_B_.at}) {
      const Vector normal = c->count == 3 ? cross(edge_of(*c, 0), edge_of(*c, 1)) : Vector{};
      both(normal);
      for (std::size_t k = 0; k < c->count && c->count == 3; ++k) {
        both(cross(normal, edge_of(*c, static_cast<int>(k))));
      }
    }
    for (std::size_t i = 0; i < now_A_.at.count; ++i) {
      for (std::size_t j = 0; j < now_B_.at.count; ++j) {
        both(cross(edge_of(now_A_.at, static_cast<int>(i)),
                   edge_of(now_B_.at, static_cast<int>(j))));
      }
    }
  }

  [[nodiscard]] double time_apart_along(const Vector& n, double enough) const {
    const double fixed = time_open(n, {}, enough);
    if (fixed >= enough) {
      return fixed;
    }
    const Vector turning = keep_across(n, directions());
    const double size = length(turning);
    return size > 0.0 && std::isfinite(size) ? std::max(fixed, time_open(n, turning, enough))
                                             : fixed;
  }

  /// The time for which the corners stay apart along the product N(tau) of two edges.
  ///
  /// The edges are those of the closest features, as they move. So N(tau) stays across a face, or
  /// two edges, that turn. No other direction does so where a tiny gap lasts.
  ///
  /// Derivation: N is of the second degree. With e linear, N . e is of the third for each pair of
  /// corners. The corners are farther apart than h as long as N . e > h |N|, with |N| <= M. Each of
  /// the four coefficients errs by at most kRounding of M reach, as rates do.
  [[nodiscard]] double time_across_features(double enough) const {
    const Directions d = directions();
    if (d.count < 2) {
      return 0.0;
    }
    const Vector N0 = cross(d.edge[0], d.edge[1]);
    const Vector N1 = cross(d.rate[0], d.edge[1]) + cross(d.edge[0], d.rate[1]);
    const Vector N2 = cross(d.rate[0], d.rate[1]);
    const double M = (length(d.edge[0]) + enough * length(d.rate[0])) *
                     (length(d.edge[1]) + enough * length(d.rate[1])) * kUp;
    const double lost = (options_.threshold + error_) * M + 8.0 * kRounding * M * reach_;
    const double sign = dot(N0, closest_.d).hi < 0.0 ? -1.0 : 1.0;
    double tau = enough;
    for (std::size_t i = 0; i < now_A_.at.count; ++i) {
      for (std::size_t j = 0; j < now_B_.at.count; ++j) {
        const Vector e = now_B_.at.p[j] - now_A_.at.p[i];
        const Vector e_rate = now_B_.rate[j] - now_A_.rate[i];
        const Cubic gap{sign * dot(N0, e).hi - lost, sign * (dot(N1, e) + dot(N0, e_rate)).hi,
                        sign * (dot(N2, e) + dot(N1, e_rate)).hi, sign * dot(N2, e_rate).hi};
        while (!is_positive_until(gap, tau)) {
          tau *= 0.5;
          if (!(tau > 0x1p-90)) {
            return 0.0;
          }
        }
      }
    }
    return tau;
  }

  [[nodiscard]] Directions directions() const {
    Directions directions;
    directions.add(now_A_, closest_.feature_A);
    directions.add(now_B_, closest_.feature_B);
    return directions;
  }

  /// The time for which n(tau) = n + tau n' keeps all corners of B farther than the threshold from
  /// all of A.
  ///
  /// advance_deforming() has the derivation. The error of positions holds at all times: it is part
  /// of the threshold.
  [[nodiscard]] double time_open(const Vector& n, const Vector& n_rate, double enough) const {
    const double h = options_.threshold + error_;
    const double turning = length(n_rate) * kUp;
    const double growth =
        turning > 0.0 ? std::max(0.0, above(dot(n, n_rate), kRounding * turning)) : 0.0;
    double tau = enough;
    for (std::size_t i = 0; i < now_A_.at.count && tau > 0.0; ++i) {
      for (std::size_t j = 0; j < now_B_.at.count && tau > 0.0; ++j) {
        const Vector e = now_B_.at.p[j] - now_A_.at.p[i];
        const Vector e_rate = now_B_.rate[j] - now_A_.rate[i];
        const double gap = -above(DoubleDouble(h) - dot(n, e), kRounding * reach_);
        const double speed =
            above(-(dot(n, e_rate) + dot(n_rate, e)), kRounding * (1.0 + turning) * reach_) +
            h * growth;
        const double bend = above(-dot(n_rate, e_rate), kRounding * turning * reach_);
        const double half_acceleration = std::max(0.0, bend) + 0.5 * h * turning * turning * kUp;
        tau = std::min(tau, time_to_close(gap, speed, half_acceleration));
      }
    }
    return tau;
  }

  /// A contact at the last double that is not after t_; the features are proven free until then.
  PreciseLinearContact contact() {
    const double t = t_.lo < 0.0 ? std::nextafter(t_.hi, 0.0) : t_.hi;
    result_.t = std::max(options_.t_begin, t);
    move_to(result_.t);
    const double apart = distance_above(precise_closest(now_A_.at, now_B_.at));
    result_.verdict = PreciseLinearVerdict::contact;
    result_.tolerance_used =
        std::max(options_.tolerance, (apart - options_.threshold) * (1.0 + 0x1p-50));
    return result_;
  }

  /// The result where no step is possible: a contact where doubles would have reported one.
  PreciseLinearContact stalled() {
    move_to(t_);
    const double apart = distance_above(precise_closest(now_A_.at, now_B_.at));
    if (apart <= options_.threshold + std::max(tolerance_, options_.least_tolerance)) {
      return contact();
    }
    result_.t = std::max(options_.t_begin, std::nextafter(t_.hi, 0.0));
    return result_;
  }

  PreciseLinearFeature A_;  // Relative to A's first corner at the same time.
  PreciseLinearFeature B_;
  const PreciseLinearOptions& options_;
  double reach_ = 0.0;
  double error_ = 0.0;
  double tolerance_ = 0.0;
  DoubleDouble t_;  // Proven: no contact before.
  Moving now_A_;
  Moving now_B_;
  PreciseClosest closest_;
  PreciseLinearContact result_;
};

}  // namespace

bool suits_double_doubles(double size) { return size > 0x1p-200 && size < 0x1p200; }

PreciseLinearContact precise_linear_contact(const PreciseLinearFeature& A,
                                            const PreciseLinearFeature& B,
                                            const PreciseLinearOptions& options) {
  return PreciseSearch(A, B, options).run();
}

}  // namespace firstcontact
