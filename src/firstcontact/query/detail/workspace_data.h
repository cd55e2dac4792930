/// @file
/// What a workspace holds.

#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <firstcontact/query/detail/box_bounds.h>
#include <firstcontact/query/detail/moving_pair.h>

namespace firstcontact::detail {

/// Pairs of boxes that still may come into contact: box i of node a with box j of node b in lane
/// 4 i + j. No contact of a live lane before base + time is proven.
struct BoxGroup {
  double base = 0.0;
  std::array<float, 16> time{};
  std::uint32_t node_a = 0;
  std::uint32_t node_b = 0;
  std::uint16_t live = 0;
  std::uint16_t far = 0;  ///< Were well apart at their last bound: bound again before opening.
  std::uint16_t larger_a = 0;
  std::uint16_t larger_b = 0;
  std::uint32_t level = 0;  ///< How often boxes were opened to get here.
};

/// A pair of triangles that still may come into contact, as indices in the hierarchies' order.
struct TriangleEntry {
  double key = 0.0;             ///< [-]  No contact of the pair before this time is proven.
  double threshold = 0.0;       ///< [m]  Closer than this is contact.
  double held_tolerance = 0.0;  ///< [m]  Positive: held to half its start distance, to this.
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  bool start_checked = false;  ///< The threshold accounts for the start distance.
};

/// An entry of the search queue: a group or a pair of triangles, by the order of the search.
struct QueueItem {
  double priority = 0.0;  ///< [-]  At most the least key of what it stands for.
  std::uint32_t index = 0;
  bool is_triangle_pair = false;
};

/// Entries at fixed places, reused when they are done.
template <class Entry>
class Pool {
 public:
  void clear() {
    entries_.clear();
    free_.clear();
  }

  [[nodiscard]] std::uint32_t add(const Entry& entry) {
    if (free_.empty()) {
      entries_.push_back(entry);
      return static_cast<std::uint32_t>(entries_.size() - 1);
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    entries_[index] = entry;
    return index;
  }

  void release(std::uint32_t index) { free_.push_back(index); }
  [[nodiscard]] Entry& operator[](std::uint32_t index) { return entries_[index]; }
  [[nodiscard]] std::size_t bytes() const { return entries_.size() * sizeof(Entry); }

 private:
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> free_;
};

struct WorkspaceData {
  std::vector<QueueItem> queue;
  Pool<BoxGroup> groups;
  Pool<TriangleEntry> triangle_pairs;
  std::vector<std::pair<BoxId, BoxId>> stack;
  std::vector<std::pair<double, std::pair<BoxId, BoxId>>> nearest;
};

}  // namespace firstcontact::detail
