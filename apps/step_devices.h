/// @file
/// The devices of the steps of a haptic record: those of the ticks that the cycles followed.

#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include <firstcontact/record/run_step.h>

namespace firstcontact::app {

/// Keeps the devices of ticks until the cycle comes that followed one of them.
///
/// On the wall clock ticks are handed over before the cycles of the same time.
class StepDevices {
 public:
  void add(std::int64_t time_ns, std::vector<RunDevice> devices) {
    ticks_.emplace_back(time_ns, std::move(devices));
  }

  /// Returns the devices of the newest tick up to a time, else of the first tick.
  ///
  /// @param time_ns  not less than before; earlier ticks are forgotten
  [[nodiscard]] std::vector<RunDevice> at(std::int64_t time_ns) {
    while (ticks_.size() > 1 && ticks_[1].first <= time_ns) {
      ticks_.pop_front();
    }
    return ticks_.empty() ? std::vector<RunDevice>() : ticks_.front().second;
  }

 private:
  std::deque<std::pair<std::int64_t, std::vector<RunDevice>>> ticks_;
};

}  // namespace firstcontact::app
