/// @file
/// Proofs from a function's value and rate at one time: a window in which it stays positive, and a
/// window of its only root.
///
/// Derivation: with |g''| <= K, g(t + y) lies between g + g' y - K y^2 / 2 and g + g' y + K y^2 /
/// 2. These one-sided parabolas take the place of interval Newton steps: g is evaluated at one time
/// only, never over an interval (R. E. Moore, R. B. Kearfott, M. J. Cloud, "Introduction to
/// Interval Analysis", SIAM 2009, chapter 8).

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace firstcontact {

/// The value and the rate of a function g of time, at one time.
struct ValueAndRate {
  double value = 0.0;
  double rate = 0.0;

  friend ValueAndRate operator+(const ValueAndRate& a, const ValueAndRate& b) {
    return {a.value + b.value, a.rate + b.rate};
  }
  friend ValueAndRate operator-(const ValueAndRate& a) { return {-a.value, -a.rate}; }
};

/// The errors of both, and a bound of |g''| over the window of the conclusion; all >= 0.
struct CurvatureBound {
  double value_error = 0.0;
  double rate_error = 0.0;
  double curvature = 0.0;
};

/// Finds the longest time tau with gap - speed tau - half_acceleration tau^2 > 0 on [0, tau],
/// rounded down.
///
/// It is infinity where the gap never closes; 0 where it is not open or anything is NaN.
///
/// Method: the form 2 g / (m1 + sqrt(m1^2 + 4 m2 g)). It does not cancel for closing pairs, and
/// also holds for receding ones.
inline double time_to_close(double gap, double speed, double half_acceleration) {
  if (!(gap > 0.0)) {
    return 0.0;
  }
  if (speed <= 0.0 && half_acceleration == 0.0) {
    return std::numeric_limits<double>::infinity();
  }
  const double denominator = speed + std::sqrt(speed * speed + 4.0 * half_acceleration * gap);
  // A receding pair's denominator cancels: speed and root agree in their leading digits. Its own
  // rounding, 4 units of the larger term, then goes to the safe side.
  const double tau = 2.0 * gap / (denominator + 0x1p-50 * std::abs(speed)) * (1.0 - 0x1p-44);
  return tau > 0.0 ? tau : 0.0;  // NaN takes the safe branch.
}

/// Computes t + tau rounded down, for t, tau >= 0. T. J. Dekker's two-sum gives the direction.
inline double after(double t, double tau) {
  const double sum = t + tau;
  const double part = sum - t;
  const double error = (t - (sum - part)) + (tau - part);
  return error < 0.0 ? std::nextafter(sum, 0.0) : sum;
}

/// Finds a time for which g provably stays positive.
inline double time_positive(const ValueAndRate& g, const CurvatureBound& bound) {
  return time_to_close(g.value - bound.value_error, bound.rate_error - g.rate,
                       0.5 * bound.curvature);
}

/// The answer of isolate_root(): an interval around x with one root of g, where `exists`.
///
/// On [x - behind, x + ahead] g has one root and falls throughout. On [x - reach, x - behind) g is
/// positive.
struct IsolatedRoot {
  bool exists = false;
  double behind = 0.0;
  double ahead = 0.0;
  double reach = 0.0;
};

/// Isolates the root of g near x, from g at x; g falls there (else negate it).
///
/// Derivation: let c = -g'(x) > 0. Where c^2 > 2 K |g|, the outer parabolas through g have roots at
/// |y| = 2 |g| / (c + sqrt(c^2 - 2 K |g|)) < c / K, up to where g' < 0, and the lower one another
/// at y = -(c + sqrt(c^2 - 2 K |g|)) / K. The inner one bounds the near end.
inline IsolatedRoot isolate_root(const ValueAndRate& g, const CurvatureBound& bound) {
  const double K = bound.curvature;
  const double c = (-g.rate - bound.rate_error) * (1.0 - 0x1p-50);
  const double most_g = (std::abs(g.value) + bound.value_error) * (1.0 + 0x1p-50);
  const double discriminant = c * c * (1.0 - 0x1p-48) - 2.0 * K * most_g;
  if (!(c > 0.0 && discriminant > 0.0)) {
    return {};
  }
  const double sum = c + std::sqrt(discriminant);
  const double most = 2.0 * most_g / sum * (1.0 + 0x1p-44);
  const double least_g = std::abs(g.value) - bound.value_error;
  const double least =
      least_g > 0.0 ? time_to_close(least_g, bound.rate_error - g.rate, 0.5 * K) : -most;
  return {true, g.value < 0.0 ? most : -least, g.value < 0.0 ? -least : most,
          sum / K * (1.0 - 0x1p-44)};
}

}  // namespace firstcontact
