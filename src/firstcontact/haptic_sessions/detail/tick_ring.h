/// @file
/// A queue without locks from one thread to another, of a fixed size.

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace firstcontact::detail {

/// A ring of items between one thread that pushes and one that pops.
///
/// Pushing allocates nothing and never waits. Where the ring is full the item is dropped, and
/// counted.
template <class Item>
class TickRing {
 public:
  /// Makes an empty ring.
  ///
  /// @param size  a power of two
  explicit TickRing(std::size_t size) : items_(size), mask_(size - 1) {}

  void push(const Item& item) noexcept {
    const std::uint64_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == items_.size()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    items_[end & mask_] = item;
    end_.store(end + 1, std::memory_order_release);
  }

  [[nodiscard]] bool pop(Item& item) {
    const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) {
      return false;
    }
    item = items_[begin & mask_];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }

 private:
  std::vector<Item> items_;
  std::size_t mask_;
  alignas(64) std::atomic<std::uint64_t> begin_{0};
  alignas(64) std::atomic<std::uint64_t> end_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace firstcontact::detail
