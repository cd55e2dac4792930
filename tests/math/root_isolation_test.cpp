#include <firstcontact/math/root_isolation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace firstcontact {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// g(t) = amplitude sin(frequency t + phase) + offset.
struct Wave {
  double amplitude;
  double frequency;
  double phase;
  double offset;

  [[nodiscard]] ValueAndRate at(double t) const {
    const double angle = frequency * t + phase;
    return {amplitude * std::sin(angle) + offset, amplitude * frequency * std::cos(angle)};
  }
  [[nodiscard]] CurvatureBound bound() const {
    return {1e-14 * (amplitude + std::abs(offset)), 1e-14 * amplitude * frequency,
            amplitude * frequency * frequency};
  }
};

class RandomWaves {
 public:
  Wave next() {
    return {uniform(0.1, 2.0), uniform(0.1, 10.0), uniform(-kPi, kPi), uniform(-1.0, 1.0)};
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  std::mt19937_64 random_{1};
};

constexpr int kWaves = 5'000;
constexpr int kSamples = 100;

TEST(TimePositive, NeverOutlastsTheFunction) {
  RandomWaves waves;
  for (int i = 0; i < kWaves; ++i) {
    const Wave wave = waves.next();
    const double time = time_positive(wave.at(0.0), wave.bound());
    for (int k = 0; k <= kSamples && time > 0.0; ++k) {
      ASSERT_GT(wave.at(time * k / kSamples).value, 0.0) << i;
    }
  }
}

TEST(TimePositive, IsTheRootOfAParabola) {
  // 1 - 2 y - 3 y^2 = 0 at 1/3.
  EXPECT_NEAR(time_positive({1.0, -2.0}, {0.0, 0.0, 6.0}), 1.0 / 3.0, 1e-12);
  EXPECT_LE(time_positive({1.0, -2.0}, {0.0, 0.0, 6.0}), 1.0 / 3.0);
  EXPECT_EQ(time_positive({1.0, 2.0}, {}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(time_positive({0.5, 2.0}, {0.5, 0.0, 0.0}), 0.0);
  EXPECT_EQ(time_positive({std::nan(""), 2.0}, {}), 0.0);
}

TEST(IsolateRoot, BracketsTheOnlyRootAndLooksBack) {
  RandomWaves waves;
  int isolated = 0;
  for (int i = 0; i < kWaves; ++i) {
    const Wave wave = waves.next();
    const IsolatedRoot root = isolate_root(wave.at(0.0), wave.bound());
    if (!root.exists) {
      continue;
    }
    ++isolated;
    ASSERT_LE(-root.behind, root.ahead) << i;
    ASSERT_GT(wave.at(-root.behind).value, -1e-13) << i;
    ASSERT_LT(wave.at(root.ahead).value, 1e-13) << i;
    for (int k = 0; k <= kSamples; ++k) {
      const double part = static_cast<double>(k) / kSamples;
      ASSERT_LT(wave.at(-root.behind + part * (root.ahead + root.behind)).rate, 0.0) << i;
      if (-root.reach < -root.behind && k < kSamples) {
        ASSERT_GT(wave.at(-root.reach + part * (root.reach - root.behind)).value, 0.0) << i;
      }
    }
  }
  EXPECT_GE(isolated, kWaves / 10);
}

TEST(IsolateRoot, IsSharpNearTheRoot) {
  // Newton's bracket: quadratically narrow.
  const Wave wave{1.0, 1.0, kPi, 0.0};  // -sin t
  for (const double t : {-1e-3, 1e-3}) {
    const IsolatedRoot root = isolate_root(wave.at(t), wave.bound());
    ASSERT_TRUE(root.exists);
    EXPECT_LE(t - root.behind, 0.0);
    EXPECT_GE(t + root.ahead, 0.0);
    EXPECT_LE(root.ahead + root.behind, 2e-6);
    EXPECT_GE(root.reach, 1.99);
  }
}

TEST(IsolateRoot, RefusesWhatItCannotProve) {
  EXPECT_FALSE(isolate_root({0.0, 0.0}, {0.0, 0.0, 1.0}).exists);   // A double root.
  EXPECT_FALSE(isolate_root({0.0, 1.0}, {0.0, 0.0, 1.0}).exists);   // It rises.
  EXPECT_FALSE(isolate_root({1.0, -1.0}, {0.0, 0.0, 1.0}).exists);  // Perhaps none.
  EXPECT_FALSE(isolate_root({0.0, -1.0}, {0.0, 1.0, 1.0}).exists);  // A rate within its error.
  EXPECT_FALSE(isolate_root({std::nan(""), -1.0}, {0.0, 0.0, 1.0}).exists);
}

}  // namespace
}  // namespace firstcontact
