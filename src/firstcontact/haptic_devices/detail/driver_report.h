/// @file
/// The report of a driver's thread to threads that are not the force loop.

#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

#include <firstcontact/haptic_devices/device.h>

namespace firstcontact::detail {

/// Counts and the last problem of a driver.
class DriverReport {
 public:
  std::atomic<std::uint64_t> samples{0};
  std::atomic<std::uint64_t> missed{0};
  std::atomic<std::uint64_t> malformed{0};
  std::atomic<std::uint64_t> connections{0};

  [[nodiscard]] DeviceCounts counts() const {
    return {samples.load(), missed.load(), malformed.load(), connections.load()};
  }

  void set_problem(std::string problem) {
    const std::lock_guard lock(mutex_);
    problem_ = std::move(problem);
  }

  [[nodiscard]] std::string problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

 private:
  mutable std::mutex mutex_;
  std::string problem_;
};

}  // namespace firstcontact::detail
