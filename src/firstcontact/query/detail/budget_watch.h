/// @file
/// The check of a budget during a search.

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include <firstcontact/query/first_contact.h>

namespace firstcontact::detail {

/// Watches the budget of a search.
class BudgetWatch {
 public:
  explicit BudgetWatch(const WorkBudget& budget) : budget_(budget) {}

  /// @param steps  number of steps done so far
  /// @param bytes  in use
  [[nodiscard]] UndecidedReason spent(std::uint64_t steps, std::size_t bytes) {
    if (steps >= budget_.steps) {
      return UndecidedReason::work;
    }
    if (bytes > budget_.memory) {
      return UndecidedReason::memory;
    }
    if (budget_.stop.stop_requested()) {
      return UndecidedReason::cancelled;
    }
    constexpr std::uint64_t kClockInterval = 64;  // Reading the clock costs as much as a step.
    if (budget_.deadline && is_clock_due(steps)) {
      next_clock_ = steps + kClockInterval;
      if (std::chrono::steady_clock::now() >= *budget_.deadline) {
        return UndecidedReason::deadline;
      }
    }
    return UndecidedReason::none;
  }

  /// Whether spent() is to be called: it may find a limit of steps, of time or the stop token.
  [[nodiscard]] bool may_be_spent(std::uint64_t steps) const {
    return steps >= budget_.steps || budget_.stop.stop_requested() ||
           (budget_.deadline && is_clock_due(steps));
  }

 private:
  [[nodiscard]] bool is_clock_due(std::uint64_t steps) const { return steps >= next_clock_; }

  const WorkBudget& budget_;
  std::uint64_t next_clock_ = 0;
};

}  // namespace firstcontact::detail
