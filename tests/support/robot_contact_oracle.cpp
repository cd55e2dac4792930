#include "support/robot_contact_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "support/closest_points.h"

namespace firstcontact::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Covers, per size, the rounding of places to doubles, of projections on a direction, and of the
/// distance of closest points (fewer than 60 operations).
constexpr double kError = 128.0 * 0x1p-53;
constexpr double kResolution = 0x1p-50;  // [-]  Resolution of the time of a contact.

double length(const Vector3<double>& v) { return std::sqrt(dot(v, v)); }

double radius_about_origin(const MovingSoup& soup) {
  double radius = 0.0;
  for (const Vector3<double>& v : soup.vertices) {
    radius = std::max(radius, length(v) * (1.0 + 0x1p-40));
  }
  return radius;
}

/// A mesh at one time: places from A's origin, and velocities less that of A's origin.
struct Placed {
  std::vector<Vector3<double>> place;
  std::vector<Vector3<double>> velocity;
};

Placed place(const MovingSoup& soup, const ExactLinkState& state, const Wide& t,
             const ExactLinkState& from) {
  Placed result;
  for (std::size_t k = 0; k < soup.vertices.size(); ++k) {
    const Vector3<double>& v = soup.vertices[k];
    const bool deforms = !soup.to.empty();
    const Vector3<Wide> way = deforms ? exact(soup.to[k]) - exact(v) : Vector3<Wide>{};
    result.place.push_back(nearest((deforms ? exact(v) + t * way : state.place(v)) - from.origin));
    result.velocity.push_back(nearest((deforms ? way : state.rate(v)) - from.velocity));
  }
  return result;
}

double greatest(const std::vector<Vector3<double>>& vectors) {
  double most = 0.0;
  for (const Vector3<double>& v : vectors) {
    most = std::max(most, length(v));
  }
  return most;
}

using Indices = std::array<std::size_t, 3>;

Triangle<double> corners(const Placed& mesh, const Indices& t) {
  return {mesh.place[t[0]], mesh.place[t[1]], mesh.place[t[2]]};
}

/// A pair of triangles.
struct Pair {
  Indices a, b;
};

/// Both meshes at one time.
struct Instant {
  Placed A, B;
  double size = 0.0;
  double speed = 0.0;
};

}  // namespace

class RobotContactOracle::Search {
 public:
  explicit Search(const RobotCase& c)
      : case_(c),
        radii_(c.A.soup.radius + c.B.soup.radius),
        limit_(radii_ + c.margin),
        radius_A_(radius_about_origin(c.A.soup)),
        radius_B_(radius_about_origin(c.B.soup)) {
    for (const Indices& a : c.A.soup.triangles) {
      for (const Indices& b : c.B.soup.triangles) {
        all_.push_back({a, b});
      }
    }
  }

  Truth first_contact(std::size_t budget) {
    budget_ = budget;
    const std::vector<double> breaks = break_times(case_);
    for (std::size_t i = 0; i + 1 < breaks.size() && !stopped_; ++i) {
      enter(breaks[i]);
      if (touches(instant(breaks[i]), all_)) {
        contact_ = breaks[i];
        stopped_ = true;
      } else {
        look(breaks[i], breaks[i + 1], all_);
      }
    }
    if (!stopped_ && touches(instant(1.0), all_)) {
      contact_ = 1.0;
    }
    if (contact_) {
      return {TruthKind::contact, std::min(free_until_, *contact_), *contact_, windows_};
    }
    return {gave_up_ ? TruthKind::gave_up : TruthKind::free, free_until_, 1.0, windows_};
  }

  DistanceBounds distance(double t) {
    const std::vector<double> breaks = break_times(case_);
    const auto next = std::upper_bound(breaks.begin(), breaks.end() - 1, t);
    enter(*std::prev(next));
    const Instant at = instant(t);
    double least = kInfinity;
    for (const Pair& pair : all_) {
      least = std::min(least, pair_distance(at, pair));
    }
    const double error = kError * (at.size + limit_);
    return {std::max(least - error - radii_, 0.0), std::max(least + error - radii_, 0.0)};
  }

 private:
  void enter(double t_begin) { paths_ = exact_link_paths(case_, t_begin); }

  /// [m per step^2]  Of any point of A against any of B.
  [[nodiscard]] double acceleration(double t_from, double t_to) const {
    return (paths_[0].acceleration_bound(radius_A_, t_from, t_to) +
            paths_[1].acceleration_bound(radius_B_, t_from, t_to)) *
           (1.0 + 0x1p-40);
  }

  [[nodiscard]] Instant instant(double t) const {
    const Wide time(t);
    const ExactLinkState A = paths_[0].state(time);
    const ExactLinkState B = paths_[1].state(time);
    Instant at{place(case_.A.soup, A, time, A), place(case_.B.soup, B, time, A), 0.0, 0.0};
    at.size = greatest(at.A.place) + greatest(at.B.place);
    at.speed = greatest(at.A.velocity) + greatest(at.B.velocity);
    return at;
  }

  static double pair_distance(const Instant& at, const Pair& pair) {
    return std::sqrt(closest_points(corners(at.A, pair.a), corners(at.B, pair.b)).distance2);
  }

  /// Whether d <= margin is proven, the bodies' rounded places being off by the error.
  [[nodiscard]] bool touches(const Instant& at, const std::vector<Pair>& pairs) const {
    const double enough = limit_ - kError * (at.size + limit_);
    return std::any_of(pairs.begin(), pairs.end(),
                       [&](const Pair& pair) { return pair_distance(at, pair) <= enough; });
  }

  /// Derivation: along n every vertex is at n . p + s n . v up to s^2 / 2 times the bound of its
  /// acceleration; linear parts attain their least value at s = h or -h.
  ///
  /// @param bend  [m per step^2]  that bound, of both together
  [[nodiscard]] bool apart_along(const Instant& at, const Pair& pair, Vector3<double> n, double h,
                                 double bend) const {
    const double l = length(n);
    if (!(l > 1e-150)) {
      return false;
    }
    n = (1.0 / l) * n;
    double gap = kInfinity;
    for (const double s : {-h, h}) {
      double top = -kInfinity;
      double low = kInfinity;
      for (std::size_t k = 0; k < 3; ++k) {
        top = std::max(top, dot(n, at.A.place[pair.a[k]] + s * at.A.velocity[pair.a[k]]));
        low = std::min(low, dot(n, at.B.place[pair.b[k]] + s * at.B.velocity[pair.b[k]]));
      }
      gap = std::min(gap, low - top);
    }
    const double error = kError * (at.size + h * at.speed + limit_);
    return gap - 0.5 * h * h * bend * (1.0 + 0x1p-40) - error > limit_;
  }

  [[nodiscard]] bool apart(const Instant& at, const Pair& pair, double h, double bend) const {
    const Triangle<double> A = corners(at.A, pair.a);
    const Triangle<double> B = corners(at.B, pair.b);
    if (apart_along(at, pair, B[0] + B[1] + B[2] - A[0] - A[1] - A[2], h, bend)) {
      return true;
    }
    const ClosestPoints<double> points = closest_points(A, B);
    return apart_along(at, pair, points.difference, h, bend) ||
           apart_along(at, pair, points.normal, h, bend) ||
           apart_along(at, pair, -1.0 * points.normal, h, bend);
  }

  /// Proves [begin, end] free of contact, or finds the first contact in it.
  void look(double begin, double end, const std::vector<Pair>& pairs) {
    if (contact_ && *contact_ - begin <= kResolution) {
      stopped_ = true;
      return;
    }
    const double middle = begin + 0.5 * (end - begin);
    if (++windows_ > budget_ || middle <= begin || middle >= end) {
      stopped_ = true;
      gave_up_ = !contact_;
      return;
    }
    const Instant at = instant(middle);
    const double h = std::max(middle - begin, end - middle) * (1.0 + 0x1p-40);
    const double bend = acceleration(begin, end);
    std::vector<Pair> rest;
    for (const Pair& pair : pairs) {
      if (!apart(at, pair, h, bend)) {
        rest.push_back(pair);
      }
    }
    if (rest.empty()) {
      free_until_ = end;
      return;
    }
    if (touches(at, rest)) {
      contact_ = middle;  // Earlier than the one before: windows beyond that are not looked at.
    }
    look(begin, middle, rest);
    if (!stopped_) {
      look(middle, end, rest);
    }
  }

  const RobotCase& case_;
  double radii_;
  double limit_;
  double radius_A_;
  double radius_B_;
  std::vector<Pair> all_;
  std::array<ExactLinkPath, 2> paths_;

  std::size_t budget_ = 0;
  std::size_t windows_ = 0;
  bool stopped_ = false;
  bool gave_up_ = false;
  double free_until_ = 0.0;
  std::optional<double> contact_;
};

RobotContactOracle::RobotContactOracle(const RobotCase& c) : case_(c) {}

Truth RobotContactOracle::first_contact(std::size_t window_budget) const {
  return Search(case_).first_contact(window_budget);
}

DistanceBounds RobotContactOracle::distance(double t) const { return Search(case_).distance(t); }

}  // namespace firstcontact::oracle
