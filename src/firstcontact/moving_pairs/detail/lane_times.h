/// @file
/// The times for which the 16 pairs of boxes of a group are proven apart, and the least of them.

#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace firstcontact::detail {

/// A lane with the time for which its boxes are proven apart, in one number that sorts by time.
///
/// The number is the code of the float; its last four bits are the lane.
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

/// The codes of all lanes; kNone for a lane whose boxes need no more work.
struct LaneTimes {
  alignas(64) std::array<std::int32_t, 16> codes;

  [[nodiscard]] LaneTime operator[](int lane) const { return LaneTime(codes[lane]); }
};

/// The times of lanes for which nothing is proven yet.
inline constexpr LaneTimes kNoTimes{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}};

/// Counts times from another instant, and takes in new proofs.
///
/// A lane of `live` stays proven until its old time or its new one, whichever is later. All other
/// lanes are dropped.
///
/// @param time  [-]  new times of the 16 lanes, >= 0
/// @param shift  [-]  how long the new instant is before the last one, negative where after it; at
///         most the true value
/// @return the lane with the least time
LaneTime prove(LaneTimes& lanes, const float* time, float shift, unsigned live);

/// Drops a lane; returns the one with the least time of those left.
LaneTime drop(LaneTimes& lanes, int lane);

}  // namespace firstcontact::detail
