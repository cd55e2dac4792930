/// @file
/// Hands the newest value from one thread to another without a lock and without waiting.

#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace firstcontact {

/// A slot for the newest value, between one thread that puts and one thread that takes.
///
/// Both sides are wait-free. The slot has three copies: one for each side, and one between them. A
/// value that nobody took is overwritten. Nothing is allocated where assigning a T allocates
/// nothing.
///
/// Other names of the method: triple buffer, three-slot communication mechanism.
template <class T>
class MailSlot {
 public:
  /// Puts a value. For the putting thread only.
  void put(const T& value) noexcept {
    slots_[back_].value = value;
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) &
            kIndex;
  }

  /// Takes the newest value, or the last one again if there is no newer one. For the taking thread
  /// only. The reference holds until the next call. Before the first put it is a default T.
  [[nodiscard]] const T& newest() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[front_].value;
  }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  // A cache line of its own for each copy, so that the two threads do not disturb each other.
  struct alignas(64) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_{};
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t back_ = 0;   // Index of the putting thread's copy.
  alignas(64) std::uint8_t front_ = 2;  // Index of the taking thread's copy.
};

}  // namespace firstcontact
