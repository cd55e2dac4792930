#include <firstcontact/robot/limit_report.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <firstcontact/math/float_environment.h>
#include <firstcontact/math/number_text.h>

namespace firstcontact {
namespace {

constexpr std::size_t kCount = CoordinateSegment::kCoefficients;

/// Number of halvings after which a window counts as beyond its limit.
constexpr int kDepth = 45;

/// A polynomial on [0, 1] by its Bernstein coefficients; it lies between the least and the
/// greatest.
///
/// Source: G. Farin, "Curves and Surfaces for CAGD", 5th edition, 2002, sections 5.1 and 5.4.
struct Bernstein {
  std::array<double, kCount> b = {};
  std::size_t count = 1;
  double error = 0.0;  // Error of the polynomial anywhere, and of the coefficients.

  [[nodiscard]] double greatest() const { return *std::max_element(b.begin(), b.begin() + size()); }
  [[nodiscard]] double least() const { return *std::min_element(b.begin(), b.begin() + size()); }
  [[nodiscard]] double first() const { return b[0]; }
  [[nodiscard]] double last() const { return b[count - 1]; }

  /// Both halves, by de Casteljau's algorithm. Its means round at most once each.
  [[nodiscard]] std::pair<Bernstein, Bernstein> halves() const {
    std::pair<Bernstein, Bernstein> result{*this, *this};
    std::array<double, kCount> row = b;
    for (std::size_t k = 0; k < count; ++k) {
      result.first.b[k] = row[0];
      result.second.b[count - 1 - k] = row[count - 1 - k];
      for (std::size_t i = 0; i + k + 1 < count; ++i) {
        row[i] = 0.5 * (row[i] + row[i + 1]);
      }
    }
    return result;
  }

 private:
  [[nodiscard]] std::ptrdiff_t size() const { return static_cast<std::ptrdiff_t>(count); }
};

double binomial(std::size_t n, std::size_t k) {
  double value = 1.0;
  for (std::size_t i = 0; i < k; ++i) {
    value = value * static_cast<double>(n - i) / static_cast<double>(i + 1);
  }
  return value;
}

/// The polynomial sign p(s) - limit, from the coefficients of the powers of p.
Bernstein excess_of(const std::array<double, kCount>& a, std::size_t count, double error,
                    double sign, double limit) {
  Bernstein result;
  result.count = count;
  double size = std::abs(limit);
  for (std::size_t j = 0; j < count; ++j) {
    size += std::abs(a[j]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    double sum = sign * a[0] - limit;
    for (std::size_t j = 1; j <= i; ++j) {
      sum += sign * binomial(i, j) / binomial(count - 1, j) * a[j];
    }
    result.b[i] = sum;
  }
  // A dozen roundings here; another one for each of up to kDepth halvings and their rows.
  result.error = error + 0x1p-52 * (16.0 + 8.0 * kDepth) * size;
  return result;
}

/// The excess of q(s) of a piece, or of dq/ds.
Bernstein excess_of(const CoordinateSegment& segment, bool of_rate, double sign, double limit) {
  std::array<double, kCount> a{};
  const std::size_t order = of_rate ? 1 : 0;
  const std::size_t count = std::max<std::size_t>(segment.count, order + 1) - order;
  for (std::size_t j = 0; j < count; ++j) {
    a[j] = segment.a[j + order].hi * (of_rate ? static_cast<double>(j + 1) : 1.0);
  }
  return excess_of(a, count, (of_rate ? 7.0 : 1.0) * segment.error, sign, limit);
}

/// The comparison of one piece with one limit, in the variable s of the piece.
class PieceReport {
 public:
  explicit PieceReport(double tolerance) : tolerance_(tolerance) {}

  void run(const Bernstein& excess) { look(excess, 0.0, 1.0, 0); }

  /// The windows of s beyond the limit, in order.
  [[nodiscard]] const std::vector<TimeWindow>& beyond() const { return beyond_; }

  /// The greatest value of `excess`, to the tolerance, and its place.
  [[nodiscard]] std::pair<double, double> greatest(const Bernstein& excess) const {
    std::pair<double, double> best{-std::numeric_limits<double>::infinity(), 0.0};
    climb(excess, 0.0, 1.0, 0, best);
    return best;
  }

 private:
  void look(const Bernstein& excess, double begin, double end, int depth) {
    if (excess.greatest() + excess.error <= tolerance_) {
      return;
    }
    if (excess.least() - excess.error > 0.0 || depth == kDepth) {
      if (!beyond_.empty() && beyond_.back().end == begin) {
        beyond_.back().end = end;
      } else {
        beyond_.push_back({begin, end});
      }
      return;
    }
    const auto [left, right] = excess.halves();
    const double middle = 0.5 * (begin + end);
    look(left, begin, middle, depth + 1);
    look(right, middle, end, depth + 1);
  }

  void climb(const Bernstein& excess, double begin, double end, int depth,
             std::pair<double, double>& best) const {
    best = std::max(best, std::pair(excess.first(), begin),
                    [](const auto& x, const auto& y) { return x.first < y.first; });
    best = std::max(best, std::pair(excess.last(), end),
                    [](const auto& x, const auto& y) { return x.first < y.first; });
    if (excess.greatest() <= best.first + 0.5 * tolerance_ || depth == kDepth) {
      return;
    }
    const auto [left, right] = excess.halves();
    const double middle = 0.5 * (begin + end);
    climb(left, begin, middle, depth + 1, best);
    climb(right, middle, end, depth + 1, best);
  }

  double tolerance_;
  std::vector<TimeWindow> beyond_;
};

/// A window in step time, rounded outward: a rounded time is within one unit of the exact one.
TimeWindow in_step(const CoordinateSegment& segment, const TimeWindow& s) {
  const double length = segment.t_end - segment.t_begin;
  TimeWindow t{segment.t_begin, segment.t_end};
  if (s.begin > 0.0) {
    t.begin = std::max(t.begin, std::nextafter(segment.t_begin + s.begin * length, 0.0));
  }
  if (s.end < 1.0) {
    t.end = std::min(t.end, std::nextafter(segment.t_begin + s.end * length, 1.0));
  }
  return t;
}

/// The comparison of one limit with all pieces of a joint.
class LimitCheck {
 public:
  LimitCheck(std::size_t joint, JointLimit what, double limit, double tolerance)
      : tolerance_(tolerance) {
    violation_ = {joint, what, limit, 0.0, 0.0, {}};
  }

  /// @param scale  multiplies `excess` to give the limit's unit
  void add(const CoordinateSegment& segment, const Bernstein& excess, double scale) {
    PieceReport report(tolerance_ / scale);
    report.run(excess);
    if (report.beyond().empty()) {
      return;
    }
    for (const TimeWindow& s : report.beyond()) {
      violation_.intervals.push_back(in_step(segment, s));
    }
    const auto [greatest, s] = report.greatest(excess);
    if (greatest * scale > violation_.excess) {
      violation_.excess = greatest * scale;
      violation_.t_excess = segment.t_begin + s * (segment.t_end - segment.t_begin);
    }
  }

  void report(std::vector<LimitViolation>& all) {
    if (!violation_.intervals.empty()) {
      join_intervals();
      all.push_back(violation_);
    }
  }

 private:
  /// Joins and sorts the intervals. Those of one piece with both signs come one sign after the
  /// other.
  void join_intervals() {
    std::vector<TimeWindow> all;
    all.swap(violation_.intervals);
    std::sort(all.begin(), all.end(), [](const TimeWindow& x, const TimeWindow& y) {
      return std::pair(x.begin, x.end) < std::pair(y.begin, y.end);
    });
    for (const TimeWindow& interval : all) {
      auto& joined = violation_.intervals;
      if (!joined.empty() && interval.begin <= joined.back().end) {
        joined.back().end = std::max(joined.back().end, interval.end);
      } else {
        joined.push_back(interval);
      }
    }
  }

  double tolerance_;
  LimitViolation violation_;
};

void check_position(std::span<const CoordinateSegment> segments, std::size_t joint, bool is_upper,
                    double limit, double tolerance, std::vector<LimitViolation>& all) {
  const double sign = is_upper ? 1.0 : -1.0;
  LimitCheck check(joint, is_upper ? JointLimit::upper_position : JointLimit::lower_position, limit,
                   tolerance);
  for (const CoordinateSegment& segment : segments) {
    check.add(segment, excess_of(segment, false, sign, sign * limit), 1.0);
  }
  check.report(all);
}

void check_velocity(std::span<const CoordinateSegment> segments, std::size_t joint, double limit,
                    double duration, double tolerance, std::vector<LimitViolation>& all) {
  LimitCheck check(joint, JointLimit::velocity, limit, tolerance);
  for (const CoordinateSegment& segment : segments) {
    const double seconds = (segment.t_end - segment.t_begin) * duration;
    for (const double sign : {-1.0, 1.0}) {
      check.add(segment, excess_of(segment, true, sign, limit * seconds), 1.0 / seconds);
    }
  }
  check.report(all);
}

void require_positive(double value, const char* what) {
  if (!(value > 0.0 && std::isfinite(value))) {
    throw std::invalid_argument(std::string("limit_report: ") + what +
                                " must be finite and > 0, got " + detail::shortest(value));
  }
}

}  // namespace

std::vector<LimitViolation> limit_report(const RobotMotion& motion, double duration,
                                         double tolerance) {
  require_positive(duration, "duration");
  require_positive(tolerance, "tolerance");
  const FloatEnvironmentGuard guard;
  std::vector<LimitViolation> all;
  for (std::size_t j = 0; j < motion.model().joints().size(); ++j) {
    const Joint& joint = motion.model().joints()[j];
    const std::vector<CoordinateSegment> segments = motion.coordinate(j);
    if (segments.empty()) {
      continue;
    }
    const JointLimits& limits = joint.limits;
    const bool has_ends = joint.type != JointType::continuous;
    if (has_ends && limits.lower) {
      check_position(segments, j, false, *limits.lower, tolerance, all);
    }
    if (has_ends && limits.upper) {
      check_position(segments, j, true, *limits.upper, tolerance, all);
    }
    if (limits.velocity.value_or(0.0) > 0.0) {
      check_velocity(segments, j, *limits.velocity, duration, tolerance, all);
    }
  }
  return all;
}

}  // namespace firstcontact
