#include <firstcontact/math/fast_sine_cosine.h>

#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace firstcontact {
namespace {

/// The greater error of the two, in units of 2^-53.
double error(double angle, const SineCosine& computed) {
  mpfr_t x, sine, cosine;
  mpfr_inits2(200, x, sine, cosine, nullptr);
  mpfr_set_d(x, angle, MPFR_RNDN);
  mpfr_sin_cos(sine, cosine, x, MPFR_RNDN);
  mpfr_sub_d(sine, sine, computed.sine, MPFR_RNDN);
  mpfr_sub_d(cosine, cosine, computed.cosine, MPFR_RNDN);
  const double worst =
      std::max(std::abs(mpfr_get_d(sine, MPFR_RNDN)), std::abs(mpfr_get_d(cosine, MPFR_RNDN)));
  mpfr_clears(x, sine, cosine, nullptr);
  return worst * 0x1p53;
}

/// Random angles of all sizes, and those next to the multiples of pi / 4.
std::vector<double> angles() {
  std::vector<double> list = {0.0, 1e6, 1e7, kMaximumAngle};
  std::mt19937_64 random(1);
  for (int exponent = -60; exponent <= 26; ++exponent) {
    std::uniform_real_distribution<double> uniform(0.0, std::ldexp(1.0, exponent));
    for (int i = 0; i < 500; ++i) {
      list.push_back(uniform(random));
    }
  }
  constexpr double kQuarterPi = 0.785398163397448309616;
  for (int k = 1; k < 4000; ++k) {
    const double angle = k * kQuarterPi;
    list.insert(list.end(), {std::nextafter(angle, 0.0), angle, std::nextafter(angle, 1e9)});
  }
  return list;
}

TEST(FastSineCosine, StaysWithinItsBoundOnBothLanes) {
  std::mt19937_64 random(2);
  std::vector<double> others = angles();
  std::shuffle(others.begin(), others.end(), random);
  std::size_t i = 0;
  for (const double angle : angles()) {
    const double other = -others[i++];
    const auto [a, b] = fast_sine_cosine(angle, other);
    ASSERT_LE(error(angle, a), 4.0) << angle;
    ASSERT_LE(error(other, b), 4.0) << other;
  }
}

// The tail of a double-double counts: without it, angles of 10^6 would be off by 10^-10.
TEST(FastSineCosine, StaysWithinItsBoundInDoubleDouble) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  for (const double head : angles()) {
    const double ulp = std::nextafter(std::abs(head), 1e300) - std::abs(head);
    const DoubleDouble angle = fast_two_sum(head, part(random) * ulp);
    const SineCosine sc = fast_sine_cosine(angle);
    const DoubleDoubleSineCosine exact = precise_sine_cosine(angle);
    ASSERT_LE(std::abs((exact.sine - DoubleDouble(sc.sine)).value()), 0x1p-51) << head;
    ASSERT_LE(std::abs((exact.cosine - DoubleDouble(sc.cosine)).value()), 0x1p-51) << head;
  }
}

TEST(FastSineCosine, IsExactAtZero) {
  const auto [a, b] = fast_sine_cosine(0.0, -0.0);
  EXPECT_EQ(a.sine, 0.0);
  EXPECT_EQ(a.cosine, 1.0);
  EXPECT_EQ(b.sine, 0.0);
  EXPECT_EQ(b.cosine, 1.0);
}

}  // namespace
}  // namespace firstcontact
