#include <firstcontact/math/float_environment.h>

#include <cfenv>
#include <limits>

#include <gtest/gtest.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace firstcontact {
namespace {

// Arithmetic at run time, out of the compiler's sight.
double sum(double a, double b) {
  volatile const double x = a;
  volatile const double y = b;
  volatile const double result = x + y;
  return result;
}

double product(double a, double b) {
  volatile const double x = a;
  volatile const double y = b;
  volatile const double result = x * y;
  return result;
}

constexpr double kSmallest = std::numeric_limits<double>::min();
constexpr double kUlp = std::numeric_limits<double>::epsilon();

// Rules of the processor that the proofs need: ties go to even in both directions; half the
// smallest normal number survives as an operand and as a result.
bool arithmetic_is_standard() {
  return sum(1.0, 0.5 * kUlp) == 1.0 && sum(-1.0, -0.5 * kUlp) == -1.0 &&
         sum(1.0, 0.75 * kUlp) == 1.0 + kUlp && sum(-1.0, -0.75 * kUlp) == -1.0 - kUlp &&
         product(kSmallest, 0.5) != 0.0 && product(product(kSmallest, 0.5), 4.0) != 0.0;
}

class RoundingModes : public testing::TestWithParam<int> {
 protected:
  void TearDown() override { std::fesetenv(FE_DFL_ENV); }
};

TEST_P(RoundingModes, AreReplacedAndComeBack) {
  ASSERT_EQ(std::fesetround(GetParam()), 0);
  const bool before = arithmetic_is_standard();
  bool inside = false;
  {
    const FloatEnvironmentGuard guard;
    inside = arithmetic_is_standard();
  }
  const bool after = arithmetic_is_standard();
  const int mode = std::fegetround();
  std::fesetenv(FE_DFL_ENV);
  EXPECT_EQ(before, GetParam() == FE_TONEAREST);
  EXPECT_TRUE(inside);
  EXPECT_EQ(after, before);
  EXPECT_EQ(mode, GetParam());
}

INSTANTIATE_TEST_SUITE_P(FloatEnvironmentGuard, RoundingModes,
                         testing::Values(FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO));

TEST(FloatEnvironmentGuard, BringsBackTheStickyFlagsOfTheHost) {
  std::feclearexcept(FE_ALL_EXCEPT);
  std::feraiseexcept(FE_DIVBYZERO);
  {
    const FloatEnvironmentGuard guard;
    ASSERT_EQ(sum(1.0, kSmallest), 1.0);
    ASSERT_NE(std::fetestexcept(FE_INEXACT), 0);
  }
  EXPECT_EQ(std::fetestexcept(FE_ALL_EXCEPT), FE_DIVBYZERO);
  std::feclearexcept(FE_ALL_EXCEPT);
}

TEST(FloatEnvironmentGuard, Nests) {
  std::fesetround(FE_UPWARD);
  {
    const FloatEnvironmentGuard outer;
    { const FloatEnvironmentGuard inner; }
    EXPECT_TRUE(arithmetic_is_standard());
  }
  const int mode = std::fegetround();
  std::fesetenv(FE_DFL_ENV);
  EXPECT_EQ(mode, FE_UPWARD);
}

#if defined(__x86_64__)

class SseControlBits : public testing::TestWithParam<unsigned> {};

TEST_P(SseControlBits, AreClearedAndComeBack) {
  const unsigned host = 0x1F80U | GetParam();
  _mm_setcsr(host);
  const bool before = arithmetic_is_standard();
  bool inside = false;
  {
    const FloatEnvironmentGuard guard;
    inside = arithmetic_is_standard();
  }
  const unsigned control = _mm_getcsr() & ~0x3FU;  // Without the sticky flags.
  _mm_setcsr(0x1F80U);
  EXPECT_FALSE(before);
  EXPECT_TRUE(inside);
  EXPECT_EQ(control, host);
}

INSTANTIATE_TEST_SUITE_P(FlushToZeroDenormalsAreZeroAndBoth, SseControlBits,
                         testing::Values(0x8000U, 0x0040U, 0x8040U));

// A host that traps on invalid operations is not stopped by ours.
TEST(FloatEnvironmentGuard, MasksExceptions) {
  _mm_setcsr(0x1F80U & ~0x0080U);  // Unmasks `invalid`.
  bool survived = false;
  {
    const FloatEnvironmentGuard guard;
    const double infinity = std::numeric_limits<double>::infinity();
    survived = sum(infinity, -infinity) != 0.0;
  }
  const unsigned control = _mm_getcsr();
  _mm_setcsr(0x1F80U);
  EXPECT_TRUE(survived);
  EXPECT_EQ(control & 0x0080U, 0U);
}

#endif

}  // namespace
}  // namespace firstcontact
