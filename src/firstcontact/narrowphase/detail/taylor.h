/// @file
/// What a function's value and rate at one time prove about the time around it.

#pragma once

#include <algorithm>
#include <cmath>

#include <firstcontact/narrowphase/advance.h>

namespace firstcontact::detail {

/// Outweighs the roundings of the few operations in a bound.
inline constexpr double kUp = 1.0 + 0x1p-40;

/// A function g of time, at one time.
struct Taylor {
  double value = 0.0;
  double rate = 0.0;

  friend Taylor operator+(const Taylor& a, const Taylor& b) {
    return {a.value + b.value, a.rate + b.rate};
  }
  friend Taylor operator-(const Taylor& a) { return {-a.value, -a.rate}; }
};

/// The errors of both, and a bound of |g''| over the piece.
struct TaylorBounds {
  double value_error = 0.0;
  double rate_error = 0.0;
  double curvature = 0.0;
};

/// For how long g provably stays positive.
inline double time_positive(const Taylor& g, const TaylorBounds& bounds) {
  return time_to_close(g.value - bounds.value_error, bounds.rate_error - g.rate,
                       0.5 * bounds.curvature);
}

/// Whether g provably stays positive for `duration`, or, where that is negative, has been for as
/// long: a parabola that opens downwards is least at an end.
inline bool positive_for(const Taylor& g, const TaylorBounds& bounds, double duration) {
  const double length = std::abs(duration);
  const double clear = g.value - bounds.value_error;
  const double way = g.rate * duration;
  const double loss = (bounds.rate_error + 0.5 * bounds.curvature * length) * length;
  return clear > 0.0 && clear + way - loss > 0x1p-49 * (clear + std::abs(way) + loss);
}

/// A root of g, which falls there: g' < 0, with the root, on [x - behind, x + ahead]; g > 0 on
/// [x - reach, x - behind).
struct RootView {
  bool isolated = false;
  double behind = 0.0;
  double ahead = 0.0;
  double reach = 0.0;
};

/// What g at x says about a root nearby.
///
/// g(x + y) lies between g - c y -+ K y^2 / 2 with c = -g'(x) > 0. Where c^2 > 2 K |g|, the outer
/// of these parabolas have roots at |y| = 2 |g| / (c + sqrt(c^2 - 2 K |g|)) < c / K, up to where g'
/// < 0, and at (c + sqrt(c^2 - 2 K |g|)) / K.
inline RootView root_view(const Taylor& g, const TaylorBounds& bounds) {
  const double K = bounds.curvature;
  const double c = (-g.rate - bounds.rate_error) * (1.0 - 0x1p-50);
  const double most_g = (std::abs(g.value) + bounds.value_error) * (1.0 + 0x1p-50);
  const double discriminant = c * c * (1.0 - 0x1p-48) - 2.0 * K * most_g;
  if (!(c > 0.0 && discriminant > 0.0)) {
    return {};
  }
  const double sum = c + std::sqrt(discriminant);
  const double most = 2.0 * most_g / sum * (1.0 + 0x1p-44);
  const double least_g = std::abs(g.value) - bounds.value_error;
  const double least =
      least_g > 0.0 ? time_to_close(least_g, bounds.rate_error - g.rate, 0.5 * K) : -most;
  return {true, g.value < 0.0 ? most : -least, g.value < 0.0 ? -least : most,
          sum / K * (1.0 - 0x1p-44)};
}

}  // namespace firstcontact::detail
