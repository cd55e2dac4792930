#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <mpfr.h>

#include <firstcontact/math/interval.h>
#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {
namespace {

/// A 300-bit value, rounded to nearest: the independent truth.
class Precise {
 public:
  explicit Precise(double x) {
    mpfr_init2(v_, 300);
    mpfr_set_d(v_, x, MPFR_RNDN);
  }
  ~Precise() { mpfr_clear(v_); }
  Precise(const Precise&) = delete;
  Precise& operator=(const Precise&) = delete;

  template <class Operation, class... Operands>
  Precise& apply(Operation operation, Operands&... operands) {
    operation(v_, v_, operands.v_..., MPFR_RNDN);
    return *this;
  }
  Precise& add(double x) {
    mpfr_add_d(v_, v_, x, MPFR_RNDN);
    return *this;
  }
  [[nodiscard]] bool inside(const Interval& i) const {
    return mpfr_cmp_d(v_, i.lower()) >= 0 && mpfr_cmp_d(v_, i.upper()) <= 0;
  }
  /// |this - x|, rounded.
  [[nodiscard]] double error(const DoubleDouble& x) const {
    Precise difference(0.0);
    mpfr_set(difference.v_, v_, MPFR_RNDN);
    difference.add(-x.hi).add(-x.lo);
    return std::abs(mpfr_get_d(difference.v_, MPFR_RNDA));
  }

 private:
  mpfr_t v_;
};

double random_double(std::mt19937_64& rng, int exponent) {
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponents(-exponent, exponent);
  return std::ldexp(mantissa(rng), exponents(rng));
}

// Sound: contains the exact result. Tight: no wider than a few units in the last place.
TEST(Interval, ArithmeticContainsTheExactResultTightly) {
  std::mt19937_64 rng(3);
  for (int i = 0; i < 20000; ++i) {
    const double a = random_double(rng, 300);
    const double b = random_double(rng, 300);
    const Interval x(a);
    const Interval y(b);
    Precise q(b);
    const auto check = [&](auto operation, const Interval& result) {
      Precise p(a);
      p.apply(operation, q);
      ASSERT_TRUE(p.inside(result)) << a << ' ' << b;
      ASSERT_LE(result.upper() - result.lower(), 0x1p-50 * result.magnitude() + 0x1p-1070);
    };
    check(mpfr_add, x + y);
    check(mpfr_sub, x - y);
    check(mpfr_mul, x * y);
    check(mpfr_div, x / y);
    Precise root(std::abs(a));
    root.apply(mpfr_sqrt);
    ASSERT_TRUE(root.inside(sqrt(Interval(std::abs(a)))));
  }
}

TEST(Interval, SineAndCosineContainTheExactRange) {
  std::mt19937_64 rng(4);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const double low = random_double(rng, 20);
    const double width = std::abs(random_double(rng, 3));
    const Interval angle(low, low + width);
    const double inside = std::min(low + unit(rng) * width, low + width);
    Precise s(inside);
    Precise c(inside);
    ASSERT_TRUE(s.apply(mpfr_sin).inside(sin(angle))) << low << ' ' << width;
    ASSERT_TRUE(c.apply(mpfr_cos).inside(cos(angle))) << low << ' ' << width;
    const Interval point = sin(Interval(low));
    ASSERT_LE(point.upper() - point.lower(), 0x1p-48);
  }
}

TEST(Interval, KnowsNothingAfterNanAndDivisionByZero) {
  EXPECT_FALSE(Interval(std::nan("")).is_bounded());
  EXPECT_FALSE((Interval(1.0) / Interval(-1.0, 1.0)).is_bounded());
}

// The bounds that the header states.
TEST(SineCosine, StaysWithinItsBounds) {
  std::mt19937_64 rng(5);
  for (int i = 0; i < 20000; ++i) {
    const double high = random_double(rng, 26);
    const DoubleDouble angle(high, high * 0x1p-54 * 0.9);
    Precise s(angle.hi);
    Precise c(angle.hi);
    s.add(angle.lo).apply(mpfr_sin);
    c.add(angle.lo).apply(mpfr_cos);
    const SineCosine fast = sine_cosine(angle);
    const DoubleDoubleSineCosine precise = precise_sine_cosine(angle);
    ASSERT_LE(s.error(fast.sine), 0x1p-51) << high;
    ASSERT_LE(c.error(fast.cosine), 0x1p-51) << high;
    ASSERT_LE(s.error(precise.sine), 0x1p-98) << high;
    ASSERT_LE(c.error(precise.cosine), 0x1p-98) << high;
  }
}

}  // namespace
}  // namespace firstcontact
