// A handle that rests between two steps of its encoders, and one that moves.

#include <firstcontact/haptic_devices/detail/still_pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/motion/detail/turn.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1e-5;  // [m]

double read(double place) { return kStep * std::round(place / kStep); }

TEST(StillCoordinate, TakesTheMeanOfATremble) {
  StillCoordinate coordinate;
  EXPECT_EQ(coordinate.take(0.0, kStep), 0.0);
  EXPECT_EQ(coordinate.take(kStep, kStep), kStep);
  EXPECT_EQ(coordinate.take(0.0, kStep), 0.0);
  EXPECT_EQ(coordinate.take(0.0, kStep), 0.0);
  for (int k = 0; k < 1000; ++k) {  // A third of the time on the upper step.
    const double value = coordinate.take(k % 3 == 0 ? kStep : 0.0, kStep);
    EXPECT_NEAR(value, kStep / 3.0, (k < 100 ? 0.2 : 0.02) * kStep) << k;
  }
}

// A long rest before the tremble has no part in it.
TEST(StillCoordinate, ForgetsTheRestBeforeATremble) {
  StillCoordinate coordinate;
  for (int k = 0; k < 10'000; ++k) {
    EXPECT_EQ(coordinate.take(0.0, kStep), 0.0);
  }
  double value = 0.0;
  for (int k = 0; k < 40; ++k) {
    value = coordinate.take(k % 2 == 0 ? kStep : 0.0, kStep);
  }
  EXPECT_NEAR(value, 0.5 * kStep, 0.05 * kStep);
}

TEST(StillCoordinate, ReadsAtOnceWhereATrembleEnds) {
  for (const double end : {2.0 * kStep, -kStep, 1.0}) {
    StillCoordinate coordinate;
    for (int k = 0; k < 100; ++k) {
      (void)coordinate.take(k % 2 == 0 ? kStep : 0.0, kStep);
    }
    EXPECT_EQ(coordinate.take(end, kStep), end);
    EXPECT_EQ(coordinate.take(end, kStep), end);
  }
}

/// The number of turns after which a tremble from 0 to a step is held.
int turns_until_held(StillCoordinate& coordinate) {
  (void)coordinate.take(0.0, kStep);
  for (int turns = 0; turns < 10'000; ++turns) {
    const double reading = turns % 2 == 0 ? kStep : 0.0;
    if (coordinate.take(reading, kStep) != reading) {
      return turns;
    }
  }
  return -1;
}

// A handle that swings about a step leaves each tremble. It is held ever more rarely there, so that
// the energy of all ends is bounded by the logarithm of time.
TEST(StillCoordinate, TakesTwiceAsManyTurnsAfterEachTremble) {
  StillCoordinate coordinate;
  int before = turns_until_held(coordinate);
  EXPECT_EQ(before, 2);
  for (int k = 0; k < 8; ++k) {
    (void)coordinate.take(-kStep, kStep);
    (void)coordinate.take(2.0 * kStep, kStep);
    const int turns = turns_until_held(coordinate);
    EXPECT_EQ(turns, 2 * before) << k;
    before = turns;
  }
  (void)coordinate.take(200.0 * kStep, kStep);  // Elsewhere it begins anew.
  EXPECT_EQ(turns_until_held(coordinate), 2);
}

// No lag: a motion that goes on or turns back once is taken as it is read, however slow it is.
TEST(StillCoordinate, DelaysNoMotion) {
  for (const double speed : {1e-4, 0.03, 0.7, 5.0}) {  // In steps a reading.
    StillCoordinate coordinate;
    for (double phase = 0.0; phase < 60.0; phase += speed) {  // Strokes of 5 steps, there and back.
      const double reading = read(kStep * std::abs(std::fmod(phase, 10.0) - 5.0));
      ASSERT_EQ(coordinate.take(reading, kStep), reading) << speed << ", " << phase;
    }
  }
}

TEST(StillCoordinate, IsNeverFartherThanAStepFromItsReading) {
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  StillCoordinate coordinate;
  double place = 0.0;
  double farthest = 0.0;
  for (int k = 0; k < 100'000; ++k) {
    place += 0.2 * kStep * normal(rng);
    const double reading = read(place);
    farthest = std::max(farthest, std::abs(coordinate.take(reading, kStep) - reading));
  }
  EXPECT_LE(farthest, kStep * (1.0 + 1e-6));
  EXPECT_GT(farthest, 0.5 * kStep);  // It trembled, or nothing was tested.
}

TEST(StillCoordinate, TakesAReadingThatIsNoNumber) {
  StillCoordinate coordinate;
  (void)coordinate.take(0.0, kStep);
  EXPECT_TRUE(std::isnan(coordinate.take(std::numeric_limits<double>::quiet_NaN(), kStep)));
  EXPECT_EQ(coordinate.take(kStep, kStep), kStep);
}

/// [-]  The work that a spring of stiffness 1 does on the hand along a path, in squares of a step.
double work_on_hand(const std::vector<double>& path, bool is_still) {
  StillCoordinate coordinate;
  double work = 0.0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const double reading = read(path[k]);
    const double value = coordinate.take(reading, kStep);
    work -= (is_still ? value : reading) * (path[k + 1] - path[k]);
  }
  return work / (kStep * kStep);
}

// The worst path: the handle trembles where the mean is low, goes on inwards, and comes back. Each
// time it gains at most the square of a step, however long it stayed.
TEST(StillCoordinate, GivesTheHandAtMostTheSquareOfAStepPerTremble) {
  constexpr int kTrembles = 20;
  for (const double low_part : {0.1, 0.5, 0.9}) {
    std::vector<double> path;
    const auto go_to = [&](double to) {
      constexpr int kPoints = 1000;
      const double from = path.empty() ? to : path.back();
      for (int i = 1; i <= kPoints; ++i) {
        path.push_back(from + (to - from) * i / kPoints);
      }
    };
    const auto wait = [&](double readings) {
      path.insert(path.end(), static_cast<std::size_t>(readings), path.back());
    };
    go_to(0.0);
    for (int k = 0; k < kTrembles; ++k) {
      for (int turns = 0; turns < 4; ++turns) {
        go_to(2.45 * kStep);
        wait(10'000.0 * low_part);
        go_to(2.55 * kStep);
        wait(10'000.0 * (1.0 - low_part));
      }
      go_to(4.0 * kStep);
      go_to(0.0);
    }
    const double gained = work_on_hand(path, true) - work_on_hand(path, false);
    EXPECT_LE(gained, 1.0 * kTrembles) << low_part;
  }
}

TEST(StillPose, HoldsPositionAndRotation) {
  StillPose still(kStep, 5e-5);
  Pose last;
  for (int k = 0; k < 1000; ++k) {
    Pose X_DH;
    X_DH.position = {0.1 + (k % 2) * kStep, -0.2, 0.3 + (k % 2) * kStep};
    X_DH.rotation = turn(Vector3d(0.4, 0.5 + (k % 2) * 5e-5, -0.1));
    last = still.take(X_DH);
  }
  EXPECT_LT((last.position - Vector3d(0.1 + 0.5 * kStep, -0.2, 0.3 + 0.5 * kStep)).norm(),
            0.01 * kStep);
  EXPECT_LT(last.rotation.angularDistance(turn(Vector3d(0.4, 0.5 + 2.5e-5, -0.1))), 5e-7);
}

TEST(StillPose, TakesPosesAsTheyAreWithoutADeclaredStep) {
  StillPose still(0.0, 0.0);
  for (int k = 0; k < 100; ++k) {
    Pose X_DH;
    X_DH.position.x() = (k % 2) * kStep;
    X_DH.rotation = turn(Vector3d(0.0, (k % 2) * 5e-5, 0.0));
    const Pose taken = still.take(X_DH);
    EXPECT_EQ(taken.position, X_DH.position);
    EXPECT_EQ(taken.rotation.coeffs(), X_DH.rotation.coeffs());
  }
}

TEST(StillPose, ForgetsATremble) {
  StillPose still(kStep, 0.0);
  Pose X_DH;
  for (int k = 0; k < 100; ++k) {
    X_DH.position.x() = (k % 2) * kStep;
    (void)still.take(X_DH);
  }
  still.forget();
  EXPECT_EQ(still.take(X_DH).position, X_DH.position);
}

}  // namespace
}  // namespace firstcontact::detail
