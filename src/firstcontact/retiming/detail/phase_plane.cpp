#include <firstcontact/retiming/detail/phase_plane.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace firstcontact::detail {
namespace {

constexpr int kCellsOfPiece = 48;
constexpr double kMostPathRate = 1e6;  // [1/s]  Rate of S; it makes no motion slower.

/// The greatest square of the rate at a place, by the limits of velocities alone.
double greatest_square(const PathPlace& place, const std::vector<RateLimits>& limits,
                       double share) {
  double greatest = kMostPathRate * kMostPathRate;
  for (std::size_t j = 0; j < limits.size(); ++j) {
    const double slope = std::abs(place.dp[j]);
    if (slope > 0.0) {
      const double rate = share * limits[j].velocity / slope;
      greatest = std::min(greatest, rate * rate);
    }
  }
  return greatest;
}

/// The limits over one cell: of z, the square of the rate at its begin, and of u, the acceleration
/// of S.
///
/// Accelerations are limited at both ends of the cell, where the square is z and z + 2 cell u.
/// Limits at the begin alone would allow any u for a cell where the slope is almost 0.
class CellLimits {
 public:
  CellLimits(const PathPlace& begin, const PathPlace& end, double cell,
             const std::vector<RateLimits>& limits, double share)
      : greatest_(greatest_square(begin, limits, share)) {
    for (std::size_t j = 0; j < limits.size(); ++j) {
      const double limit = share * limits[j].acceleration;
      add(begin.dp[j], begin.ddp[j], limit);
      add(end.dp[j] + 2.0 * cell * end.ddp[j], end.ddp[j], limit);
    }
  }

  /// [1/s^2]  The greatest z by the limits of velocities alone.
  [[nodiscard]] double greatest() const { return greatest_; }

  struct Range {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
  };
  /// The accelerations that are allowed with z; empty where lower > upper.
  [[nodiscard]] Range accelerations(double z) const {
    Range range;
    for (const Row& row : rows_) {
      if (row.slope > 0.0) {
        range.lower = std::max(range.lower, (-row.limit - row.bend * z) / row.slope);
        range.upper = std::min(range.upper, (row.limit - row.bend * z) / row.slope);
      } else if (std::abs(row.bend) * z > row.limit) {
        return {1.0, -1.0};
      }
    }
    return range;
  }

 private:
  /// The limit |slope u + bend z| <= limit, with a slope that is not negative.
  struct Row {
    double slope;
    double bend;
    double limit;
  };

  void add(double slope, double bend, double limit) {
    rows_.push_back({std::abs(slope), slope < 0.0 ? -bend : bend, limit});
  }

  double greatest_;
  std::vector<Row> rows_;
};

/// The greatest z from which a z of at most `next` is reached over a cell of length `cell`.
///
/// The set of such z is convex and has 0 in it, so that halving finds its end.
double controllable(const CellLimits& here, double cell, double next) {
  const auto can = [&](double z) {
    const CellLimits::Range u = here.accelerations(z);
    const double lower = std::max(u.lower, -z / (2.0 * cell));
    return lower <= u.upper && z + 2.0 * cell * lower <= next;
  };
  double low = 0.0;
  double high = here.greatest();
  if (can(high)) {
    return high;
  }
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (can(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

PathTiming::Knot PathTiming::at(double t) const {
  if (t <= 0.0) {
    return {t, 0.0, 0.0, 0.0};
  }
  if (t >= duration()) {
    const Knot& last = knots_.back();
    return {t, last.S, 0.0, last.integral + last.S * (t - last.t)};
  }
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), t,
                                      [](double time, const Knot& k) { return time < k.t; });
  const Knot& a = *(after - 1);
  const Knot& b = *after;
  const double h = t - a.t;
  const double u = (b.rate - a.rate) / (b.t - a.t);
  return {t, a.S + h * (a.rate + 0.5 * h * u), a.rate + h * u,
          a.integral + h * (a.S + h * (0.5 * a.rate + h * u / 6.0))};
}

PathTiming::State PathTiming::averaged(double t, double window) const {
  const Knot early = at(t - window);
  const Knot late = at(t);
  return {(late.integral - early.integral) / window, (late.S - early.S) / window,
          (late.rate - early.rate) / window};
}

PathTiming phase_plane(const BlendedPath& path, const std::vector<RateLimits>& limits,
                       double share) {
  std::vector<double> S{0.0};
  std::vector<CellLimits> cells;
  for (const BlendedPath::Piece& piece : path.pieces()) {
    PathPlace before = path.place(piece, piece.begin);
    for (int k = 1; k <= kCellsOfPiece; ++k) {
      const double at = k == kCellsOfPiece
                            ? piece.end
                            : piece.begin + (piece.end - piece.begin) * k / kCellsOfPiece;
      PathPlace here = path.place(piece, at);
      cells.emplace_back(before, here, at - S.back(), limits, share);
      before = std::move(here);
      S.push_back(at);
    }
  }
  std::vector<double> reach(S.size(), 0.0);
  for (std::size_t i = cells.size(); i-- > 0;) {
    reach[i] = controllable(cells[i], S[i + 1] - S[i], reach[i + 1]);
  }
  double z = 0.0;
  std::vector<PathTiming::Knot> knots{{}};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double cell = S[i + 1] - S[i];
    const double most = z + 2.0 * cell * cells[i].accelerations(z).upper;
    const double next = std::clamp(most, 0.0, reach[i + 1]);
    const PathTiming::Knot& before = knots.back();
    const double rate = std::sqrt(next);
    const double time = 2.0 * cell / std::max(before.rate + rate, 1e-12);
    const double slope = (rate - before.rate) / time;
    knots.push_back(
        {before.t + time, S[i + 1], rate,
         before.integral + time * (S[i] + time * (0.5 * before.rate + time * slope / 6.0))});
    z = next;
  }
  return PathTiming(std::move(knots));
}

}  // namespace firstcontact::detail
