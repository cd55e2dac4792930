/// @file
/// The memory of a search for candidates.

#pragma once

#include <array>
#include <cstddef>
#include <memory_resource>

namespace firstcontact::detail {

/// Memory of a search, which is asked for once for most edges of planners.
class SearchMemory {
 public:
  SearchMemory() = default;
  SearchMemory(const SearchMemory&) = delete;
  SearchMemory& operator=(const SearchMemory&) = delete;

  [[nodiscard]] std::pmr::memory_resource& resource() { return memory_; }

 private:
  static constexpr std::size_t kBytes = std::size_t{3} << 14;  // Two dozen geometries, a robot.

  alignas(std::max_align_t) std::array<std::byte, kBytes> first_;
  std::pmr::monotonic_buffer_resource memory_{first_.data(), kBytes};
};

}  // namespace firstcontact::detail
