// The times of lanes, for every instruction set that this processor has, against plain loops.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include <firstcontact/moving_pairs/detail/lane_times.h>

#include "support/instruction_sets.h"
#include "support/random.h"

namespace firstcontact::detail {
namespace {

using test::Random;

class LaneTimesOn : public test::OnInstructionSet {};

constexpr int kLanes = 16;
constexpr double kBitsOfLane = 0x1p-19;  // The last four of the time are the lane's.

bool is_none(LaneTime lane) {
  return lane.lane() == 15 && !(lane.time() <= std::numeric_limits<float>::max());
}

int earliest_of(const LaneTimes& lanes) {
  int earliest = -1;
  for (int k = 0; k < kLanes; ++k) {
    if (!is_none(lanes[k]) && (earliest < 0 || lanes[k].time() < lanes[earliest].time())) {
      earliest = k;
    }
  }
  return earliest;
}

std::array<float, kLanes> random_times(Random& random) {
  alignas(64) std::array<float, kLanes> times{};
  for (float& time : times) {
    time = random.chance(0.2) ? 0.0f : static_cast<float>(random.logarithmic(1e-30, 2.0));
  }
  return times;
}

// Law: what is proven is the later of what was and what is told, never more, and hardly less.
TEST_P(LaneTimesOn, AreProvenForTheLongerTime) {
  Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    LaneTimes lanes = kNoTimes;
    unsigned live = 0xffff;
    std::array<double, kLanes> proven{};  // From a common origin.
    double base = 0.0;
    for (int step = 0; step < 5; ++step) {
      alignas(64) const std::array<float, kLanes> times = random_times(random);
      const double new_base = random.chance(0.3) ? base : base + random.logarithmic(1e-12, 0.5);
      live &= static_cast<unsigned>(random.uniform(0.0, 65536.0)) | 0x1111u << (trial % 4);
      const auto shift = static_cast<float>((base - new_base) - 0x1p-22 * (new_base - base));
      const LaneTime next = prove(lanes, times.data(), shift, live);
      base = new_base;
      for (int k = 0; k < kLanes; ++k) {
        if ((live >> k & 1u) == 0) {
          ASSERT_TRUE(is_none(lanes[k])) << trial << ", " << k;
          continue;
        }
        proven[k] = std::max(proven[k], base + static_cast<double>(times[k]));
        const double told = base + static_cast<double>(lanes[k].time());
        ASSERT_EQ(lanes[k].lane(), k);
        ASSERT_GE(lanes[k].time(), 0.0f);
        ASSERT_LE(told, proven[k]) << trial << ", " << k;
        ASSERT_GE(told, proven[k] - (step + 1) * kBitsOfLane * 4.0) << trial << ", " << k;
      }
      ASSERT_EQ(next.lane(), earliest_of(lanes)) << trial;
      ASSERT_EQ(next.time(), lanes[next.lane()].time()) << trial;
    }
  }
}

// A group can be bounded for a later time than that of the boxes: nothing of it is lost.
TEST_P(LaneTimesOn, StayProvenWhenTheyCountFromAnEarlierInstant) {
  LaneTimes lanes = kNoTimes;
  alignas(64) const std::array<float, kLanes> nothing{};
  const LaneTime next = prove(lanes, nothing.data(), 0.25f, 0xffff);
  EXPECT_NEAR(next.time(), 0.25f, 1e-6f);
  EXPECT_LE(next.time(), 0.25f);
}

TEST_P(LaneTimesOn, AreDroppedEarliestFirst) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    LaneTimes lanes = kNoTimes;
    alignas(64) const std::array<float, kLanes> times = random_times(random);
    LaneTime next = prove(lanes, times.data(), 0.0f, 0xffff);
    float last = 0.0f;
    for (int left = kLanes; left > 0; --left) {
      ASSERT_GE(next.time(), last) << trial;
      ASSERT_EQ(next.lane(), earliest_of(lanes)) << trial;
      last = next.time();
      const int lane = next.lane();
      next = drop(lanes, lane);
      ASSERT_TRUE(is_none(lanes[lane])) << trial;
    }
    ASSERT_TRUE(is_none(next)) << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(, LaneTimesOn, testing::ValuesIn(test::instruction_sets()),
                         test::instruction_set_name);

}  // namespace
}  // namespace firstcontact::detail
