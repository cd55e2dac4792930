#include <firstcontact/math/sine_cosine.h>

#include <array>
#include <cassert>
#include <cmath>

namespace firstcontact {
namespace {

// pi/2 to 163 bits.
constexpr double kHalfPi1 = 0x1.921fb54442d18p+0;
constexpr double kHalfPi2 = 0x1.1a62633145c07p-54;
constexpr double kHalfPi3 = -0x1.f1976b7ed8fbcp-110;
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;

struct ReducedAngle {
  DoubleDouble r;    // |r| <= pi/4 + 1e-8
  int quadrant = 0;  // of 0..3
};

ReducedAngle reduce(const DoubleDouble& angle) {
  assert(std::abs(angle.hi) <= kMaximumAngle);
  // Adding and subtracting 1.5 * 2^52 rounds to the nearest integer in the default rounding mode.
  constexpr double kRound = 6755399441055744.0;
  const double k = (angle.hi * kTwoOverPi + kRound) - kRound;
  if (k == 0.0) {
    return {angle, 0};
  }
  const DoubleDouble r = (angle - two_product(k, kHalfPi1)) - two_product(k, kHalfPi2);
  return {r - DoubleDouble(k * kHalfPi3), static_cast<int>(static_cast<long long>(k) & 3)};
}

template <class Value, class Pair>
Pair rotate_to_quadrant(int quadrant, const Value& s, const Value& c) {
  switch (quadrant) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

// Taylor polynomials at the leading part; the tail enters by the derivative, as tail^2 < 2^-106.
SineCosine near_zero(const DoubleDouble& r) {
  const double x = r.hi;
  const double z = x * x;
  double s = 1.0 / 355687428096000.0;  // 1/17!
  s = s * z - 1.0 / 1307674368000.0;
  s = s * z + 1.0 / 6227020800.0;
  s = s * z - 1.0 / 39916800.0;
  s = s * z + 1.0 / 362880.0;
  s = s * z - 1.0 / 5040.0;
  s = s * z + 1.0 / 120.0;
  s = s * z - 1.0 / 6.0;
  double c = 1.0 / 20922789888000.0;  // 1/16!
  c = c * z - 1.0 / 87178291200.0;
  c = c * z + 1.0 / 479001600.0;
  c = c * z - 1.0 / 3628800.0;
  c = c * z + 1.0 / 40320.0;
  c = c * z - 1.0 / 720.0;
  c = c * z + 1.0 / 24.0;
  c = c * z - 1.0 / 2.0;
  const double sine = x + x * (z * s);
  const double cosine = 1.0 + z * c;
  return {sine + r.lo * cosine, cosine - r.lo * sine};
}

constexpr int kPreciseTerms = 28;

const std::array<DoubleDouble, kPreciseTerms>& inverse_factorials() {
  static const std::array<DoubleDouble, kPreciseTerms> table = [] {
    std::array<DoubleDouble, kPreciseTerms> t;
    t[0] = 1.0;
    for (int n = 1; n < kPreciseTerms; ++n) {
      t[n] = t[n - 1] / DoubleDouble(static_cast<double>(n));
    }
    return t;
  }();
  return table;
}

}  // namespace

SineCosine sine_cosine(const DoubleDouble& angle) {
  const ReducedAngle reduced = reduce(angle);
  const SineCosine sc = near_zero(reduced.r);
  return rotate_to_quadrant<double, SineCosine>(reduced.quadrant, sc.sine, sc.cosine);
}

DoubleDoubleSineCosine precise_sine_cosine(const DoubleDouble& angle) {
  const ReducedAngle reduced = reduce(angle);
  const auto& inverse_factorial = inverse_factorials();
  const DoubleDouble z = -(reduced.r * reduced.r);
  // Remainders: (pi/4)^28 / 28! < 2^-107.
  DoubleDouble s = inverse_factorial[27];
  DoubleDouble c = inverse_factorial[26];
  for (int n = 25; n >= 1; n -= 2) {
    s = inverse_factorial[n] + z * s;
    c = inverse_factorial[n - 1] + z * c;
  }
  return rotate_to_quadrant<DoubleDouble, DoubleDoubleSineCosine>(reduced.quadrant, reduced.r * s,
                                                                  c);
}

}  // namespace firstcontact
