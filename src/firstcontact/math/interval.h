/// @file
/// Intervals of real numbers with outward rounding.
///
/// Every operation returns an interval that contains each exact result of members of its operands.
/// The rounding mode is never changed: it has to be round to nearest with gradual underflow (see
/// float_environment.h). A bound is moved outwards by one or two units in the last place, as
/// follows. With phi = u (1 + 2u), u = 2^-53, eta = 2^-1074, all rounded to nearest, x - (phi |x| +
/// eta) is at most the predecessor of x. Source: S. M. Rump, P. Zimmermann, S. Boldo, G. Melquiond,
/// "Computing predecessor and successor in rounding to nearest", BIT 49 (2009), Theorem 2.2. Sums
/// that are exact stay exact (Knuth's error-free transformation).

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A closed, non-empty interval [lower, upper]; the bounds may be infinite.
///
/// Where an operation has no bound to give (NaN, overflow, division by zero), it returns the entire
/// line.
class Interval {
 public:
  /// Makes the entire line: nothing is known.
  constexpr Interval() = default;

  /// Makes the point x; the entire line if x is NaN.
  constexpr explicit Interval(double x) : Interval(x, x) {}

  /// Makes [lower, upper]; the entire line if a bound is NaN or they are in the wrong order.
  constexpr Interval(double lower, double upper) {
    if (lower <= upper) {
      lower_ = lower;
      upper_ = upper;
    }
  }

  [[nodiscard]] constexpr double lower() const { return lower_; }
  [[nodiscard]] constexpr double upper() const { return upper_; }

  /// A member; near the middle if the interval is bounded.
  [[nodiscard]] double midpoint() const {
    const double middle = 0.5 * lower_ + 0.5 * upper_;
    return std::isnan(middle) ? 0.0 : std::clamp(middle, lower_, upper_);
  }

  [[nodiscard]] double width_bound() const;  ///< upper - lower, rounded upwards.
  [[nodiscard]] double magnitude() const {   ///< Largest |x|.
    return std::max(std::abs(lower_), std::abs(upper_));
  }
  [[nodiscard]] bool contains(double x) const { return lower_ <= x && x <= upper_; }
  [[nodiscard]] bool contains(const Interval& other) const {
    return lower_ <= other.lower_ && other.upper_ <= upper_;
  }
  [[nodiscard]] bool is_bounded() const {
    return magnitude() <= std::numeric_limits<double>::max();
  }

  friend bool operator==(const Interval&, const Interval&) = default;

 private:
  double lower_ = -std::numeric_limits<double>::infinity();
  double upper_ = std::numeric_limits<double>::infinity();
};

namespace detail {

constexpr double kNudge = 0x1.0000000000001p-53;  // phi = u (1 + 2u)
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

inline double below(double x) { return x - (kNudge * std::abs(x) + kTiny); }
inline double above(double x) { return x + (kNudge * std::abs(x) + kTiny); }

// Written so that the NaN of an overflow takes the careful branch.
inline double sum_below(double a, double b) {
  const DoubleDouble s = two_sum(a, b);
  return s.lo >= 0.0 ? s.hi : below(s.hi);
}

inline double sum_above(double a, double b) {
  const DoubleDouble s = two_sum(a, b);
  return s.lo <= 0.0 ? s.hi : above(s.hi);
}

FIRSTCONTACT_API Interval unbounded_product(const Interval& a, const Interval& b);

}  // namespace detail

inline double Interval::width_bound() const { return detail::sum_above(upper_, -lower_); }

inline Interval operator-(const Interval& a) { return {-a.upper(), -a.lower()}; }

inline Interval operator+(const Interval& a, const Interval& b) {
  return {detail::sum_below(a.lower(), b.lower()), detail::sum_above(a.upper(), b.upper())};
}

inline Interval operator-(const Interval& a, const Interval& b) { return a + (-b); }

inline Interval operator*(const Interval& a, const Interval& b) {
  if (!(a.is_bounded() && b.is_bounded())) {
    return detail::unbounded_product(a, b);
  }
  const double p = a.lower() * b.lower();
  const double q = a.lower() * b.upper();
  const double r = a.upper() * b.lower();
  const double s = a.upper() * b.upper();
  if (a == Interval(0.0) || b == Interval(0.0)) {
    return Interval(0.0);
  }
  return {detail::below(std::min(std::min(p, q), std::min(r, s))),
          detail::above(std::max(std::max(p, q), std::max(r, s)))};
}

/// Divides two intervals; the entire line if 0 is in b.
FIRSTCONTACT_API Interval operator/(const Interval& a, const Interval& b);

inline Interval& operator+=(Interval& a, const Interval& b) { return a = a + b; }
inline Interval& operator-=(Interval& a, const Interval& b) { return a = a - b; }
inline Interval& operator*=(Interval& a, const Interval& b) { return a = a * b; }

/// The smallest interval that contains both.
inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.lower(), b.lower()), std::max(a.upper(), b.upper())};
}

[[nodiscard]] inline bool disjoint(const Interval& a, const Interval& b) {
  return a.upper() < b.lower() || b.upper() < a.lower();
}

/// The common part of two intervals that are not disjoint.
FIRSTCONTACT_API Interval intersection(const Interval& a, const Interval& b);

/// The absolute values |x| of the members.
FIRSTCONTACT_API Interval abs(const Interval& a);

/// x^2, never negative.
FIRSTCONTACT_API Interval sqr(const Interval& a);

/// The square roots of the members that are not negative; the entire line if there are none.
FIRSTCONTACT_API Interval sqrt(const Interval& a);

/// Encloses the sine of an angle.
///
/// The bounds of a point within kMaximumAngle are a few units in the last place apart, or 2^-97,
/// whichever is more. Beyond kMaximumAngle the answer is [-1, 1].
///
/// @param angle  [rad]
FIRSTCONTACT_API Interval sin(const Interval& angle);
/// Encloses the cosine of an angle [rad], as sin() does.
FIRSTCONTACT_API Interval cos(const Interval& angle);

/// Encloses the number hi + lo.
inline Interval enclose(const DoubleDouble& x) { return Interval(x.hi) + Interval(x.lo); }

}  // namespace firstcontact
