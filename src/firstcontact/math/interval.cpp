#include <firstcontact/math/interval.h>

#include <array>
#include <cassert>

#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {
namespace {

using detail::above;
using detail::below;

// The limit of x y for bounds: zero times an infinite bound is zero.
double bound_product(double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; }

// 2/pi lies between these neighbours.
const Interval kTwoOverPi(0x1.45f306dc9c882p-1, 0x1.45f306dc9c883p-1);

// Whether an integer congruent to `residue` modulo 4 lies in `quarters`.
bool contains_quarter(const Interval& quarters, double residue) {
  const double first = std::ceil((quarters.lower() - residue) / 4.0) * 4.0 + residue;
  return first <= quarters.upper();
}

// The rounding of x.hi + x.lo to x.hi errs by half a unit, the double-double by 2^-98 more.
constexpr double kPreciseError = 0x1p-98;

Interval rounded(const DoubleDouble& x) {
  const Interval sum = enclose(x);
  return sum + Interval(-kPreciseError, kPreciseError);
}

// sin(x) for 0 <= x <= 2^-27: x - x^3 / 6 <= sin(x) <= x, and x^3 / 6 < x 2^-56 is less than one
// step down.
Interval tiny_sine(double x) { return x >= 0.0 ? Interval(below(x), x) : Interval(x, above(x)); }

Interval point_sine(double x) {
  if (std::abs(x) <= 0x1p-27) {
    return x == 0.0 ? Interval(0.0) : tiny_sine(x);
  }
  return rounded(precise_sine_cosine(x).sine);
}

Interval point_cosine(double x) {
  return x == 0.0 ? Interval(1.0) : rounded(precise_sine_cosine(x).cosine);
}

// Encloses a wave with its maxima where angle 2/pi is `crest` modulo 4, its minima opposite.
Interval wave(const Interval& angle, const Interval& at_lower, const Interval& at_upper,
              double crest) {
  const Interval quarters = angle * kTwoOverPi;
  const Interval ends = hull(at_lower, at_upper);
  const bool reaches_top = contains_quarter(quarters, crest);
  const bool reaches_bottom = contains_quarter(quarters, crest + 2.0);
  return {reaches_bottom ? -1.0 : std::max(ends.lower(), -1.0),
          reaches_top ? 1.0 : std::min(ends.upper(), 1.0)};
}

bool within_reduction(const Interval& angle) { return angle.magnitude() <= kMaximumAngle; }

}  // namespace

namespace detail {

Interval unbounded_product(const Interval& a, const Interval& b) {
  const std::array<double, 4> products = {
      bound_product(a.lower(), b.lower()), bound_product(a.lower(), b.upper()),
      bound_product(a.upper(), b.lower()), bound_product(a.upper(), b.upper())};
  const auto [least, greatest] = std::minmax_element(products.begin(), products.end());
  return {below(*least), above(*greatest)};
}

}  // namespace detail

Interval operator/(const Interval& a, const Interval& b) {
  if (b.contains(0.0) || !(a.is_bounded() && b.is_bounded())) {
    return {};
  }
  const double p = a.lower() / b.lower();
  const double q = a.lower() / b.upper();
  const double r = a.upper() / b.lower();
  const double s = a.upper() / b.upper();
  return {below(std::min(std::min(p, q), std::min(r, s))),
          above(std::max(std::max(p, q), std::max(r, s)))};
}

Interval intersection(const Interval& a, const Interval& b) {
  assert(!disjoint(a, b));
  return {std::max(a.lower(), b.lower()), std::min(a.upper(), b.upper())};
}

Interval abs(const Interval& a) {
  if (a.contains(0.0)) {
    return {0.0, a.magnitude()};
  }
  return a.lower() > 0.0 ? a : -a;
}

Interval sqr(const Interval& a) {
  const Interval m = abs(a);
  const Interval square = m * m;
  return {std::max(square.lower(), 0.0), square.upper()};
}

Interval sqrt(const Interval& a) {
  if (a.upper() < 0.0) {
    return {};
  }
  const auto root_below = [](double x) {
    return x > 0.0 ? std::max(below(std::sqrt(x)), 0.0) : 0.0;
  };
  const auto root_above = [](double x) { return x > 0.0 ? above(std::sqrt(x)) : 0.0; };
  return {root_below(a.lower()), root_above(a.upper())};
}

Interval sin(const Interval& angle) {
  if (!within_reduction(angle)) {
    return {-1.0, 1.0};
  }
  return wave(angle, point_sine(angle.lower()), point_sine(angle.upper()), 1.0);
}

Interval cos(const Interval& angle) {
  if (!within_reduction(angle)) {
    return {-1.0, 1.0};
  }
  return wave(angle, point_cosine(angle.lower()), point_cosine(angle.upper()), 0.0);
}

}  // namespace firstcontact
