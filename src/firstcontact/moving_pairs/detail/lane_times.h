/// @file
/// For how long the 16 pairs of boxes of a group are proven apart, and which of them is the first.

#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace firstcontact::detail {

/// A lane with the time for which its boxes are proven apart, in one number that sorts by time.
///
/// The number is the code of the float, its last four bits the lane.
class LaneTime {
 public:
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();

  LaneTime() = default;
  explicit LaneTime(std::int32_t code) : code_(code) {}

  [[nodiscard]] int lane() const { return code_ & 15; }
  [[nodiscard]] float time() const { return std::bit_cast<float>(code_ & ~15); }

 private:
  std::int32_t code_ = kNone;
};

/// One of each lane; kNone where its boxes are done with.
struct LaneTimes {
  alignas(64) std::array<std::int32_t, 16> codes;

  [[nodiscard]] LaneTime operator[](int lane) const { return LaneTime(codes[lane]); }
};

/// Times of lanes of which nothing is proven yet.
inline constexpr LaneTimes kNoTimes{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}};

/// Counts from another instant, `shift` before the last one (negative: after it). Lanes stay proven
/// for as long as they were, or as the new times say where that is longer; but for those of `live`,
/// they are done with.
///
/// @param time  [-]  of 16 lanes, >= 0
/// @param shift  [-]  at most the true one
/// @return the lane with the least time
LaneTime prove(LaneTimes& lanes, const float* time, float shift, unsigned live);

/// Is done with a lane; returns the one with the least time of those left.
LaneTime drop(LaneTimes& lanes, int lane);

}  // namespace firstcontact::detail
