/// @file
/// The contents of a workspace.

#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <firstcontact/geometry/screw_sliding_bounds.h>
#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/moving_pairs/detail/lane_times.h>
#include <firstcontact/narrowphase/triangle_distance.h>
#include <firstcontact/query/contact.h>

namespace firstcontact::detail {

/// Pairs of boxes that may still come into contact: box i of node a with box j of node b in lane 4
/// i + j.
///
/// No contact of a lane before base + its time is proven.
struct BoxGroup {
  LaneTimes lanes;
  double base;
  double due;  ///< No contact of any lane before this time is proven.
  std::uint32_t node_a;
  std::uint32_t node_b;
  LaneTime next;       ///< The lane with the least time; kNone where all are done with.
  std::uint16_t live;  ///< Bits of lanes that are not done with.
  std::uint16_t far;   ///< Bits of lanes that were well apart at their last bound: they are bound
                       ///< again before opening.
  std::uint16_t larger_a;
  std::uint16_t larger_b;
  std::uint16_t level;  ///< Number of openings of boxes down to this group.
};

/// A pair of triangles that still may come into contact, as indices in the hierarchies' order.
struct TriangleEntry {
  double key = 0.0;  ///< [-]  No contact of the pair before this time is proven.
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t opened = 0;  ///< Its place among the opened pairs, if it has one.
};

/// Two triangles.
struct IndexPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

/// Lanes of a group of a BoxFront with which a search begins.
struct FrontSeed {
  std::uint32_t group = 0;
  unsigned lanes = 0;
};

/// Two triangles in a lane of a BoxFront.
struct FrontTriangles {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t group = 0;
  int lane = 0;
};

/// Nodes of one level of two ScrewSlidingBounds.
struct ScrewSlidingNodes {
  std::size_t level = 0;
  std::uint32_t carrier = 0;
  std::uint32_t other = 0;
};

/// A pair of triangles that a search opened, and its last distance.
struct OpenedPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double t = 0.0;
  double distance = 0.0;  ///< [m]
};

/// Two triangles that are near at an instant.
struct NearTriangles {
  IndexPair at;
  ClosestFeatures closest;
};

/// The closest features of two triangles (indices in the hierarchies' order).
struct ClosePair {
  Feature feature_A;
  Feature feature_B;
  std::uint32_t triangle_A = 0;
  std::uint32_t triangle_B = 0;
  ClosestFeatures closest;
};

/// The key by which pairs of features are sorted: features as numbers, the nearest pair first.
struct CloseKey {
  std::uint64_t feature_A = 0;
  std::uint64_t feature_B = 0;
  double distance = 0.0;
  std::uint32_t triangle_A = 0;
  std::uint32_t triangle_B = 0;
  const ClosePair* pair = nullptr;
};

/// An entry of the search queue: a group or a pair of triangles, by the order of the search.
class QueueItem {
 public:
  QueueItem() = default;
  /// @param priority  [-]  at most the least key of the entry
  QueueItem(double priority, std::uint32_t stands_for, bool a_triangle_pair)
      : index(stands_for),
        is_triangle_pair(a_triangle_pair),
        order_(in_order(std::bit_cast<std::int64_t>(priority))) {}

  std::uint32_t index = 0;
  bool is_triangle_pair = false;

  [[nodiscard]] double priority() const { return std::bit_cast<double>(in_order(order_)); }

  friend bool operator<(const QueueItem& x, const QueueItem& y) { return x.order_ < y.order_; }

 private:
  /// The code of a double as an integer in the same order, and back.
  ///
  /// Integers are compared without branches, which cannot be foreseen in a queue.
  static std::int64_t in_order(std::int64_t code) {
    return code ^ (code < 0 ? std::numeric_limits<std::int64_t>::max() : 0);
  }

  std::int64_t order_ = 0;
};

/// A heap with four children to an entry, which are neighbours in memory; least priority first.
class SearchQueue {
 public:
  void clear() { items_.clear(); }
  [[nodiscard]] bool empty() const { return items_.empty(); }
  [[nodiscard]] std::size_t size() const { return items_.size(); }
  [[nodiscard]] const QueueItem& top() const { return items_.front(); }

  void push(const QueueItem& item) {
    items_.push_back(item);
    std::size_t hole = items_.size() - 1;
    while (hole > 0 && item < items_[(hole - 1) / kWidth]) {
      items_[hole] = items_[(hole - 1) / kWidth];
      hole = (hole - 1) / kWidth;
    }
    items_[hole] = item;
  }

  void pop() {
    const QueueItem last = items_.back();
    items_.pop_back();
    if (!items_.empty()) {
      replace_top(last);
    }
  }

  void replace_top(const QueueItem& item) {
    std::size_t hole = 0;
    std::size_t least = least_child(hole);
    while (least != hole && items_[least] < item) {
      items_[hole] = items_[least];
      hole = least;
      least = least_child(hole);
    }
    items_[hole] = item;
  }

 private:
  static constexpr std::size_t kWidth = 4;

  /// The least child of an entry; the entry itself where it has none.
  [[nodiscard]] std::size_t least_child(std::size_t entry) const {
    const std::size_t first = kWidth * entry + 1;
    if (first + kWidth <= items_.size()) {
      const std::size_t low = first + (items_[first + 1] < items_[first] ? 1 : 0);
      const std::size_t high = first + 2 + (items_[first + 3] < items_[first + 2] ? 1 : 0);
      return items_[high] < items_[low] ? high : low;
    }
    std::size_t least = first < items_.size() ? first : entry;
    for (std::size_t child = first + 1; child < items_.size(); ++child) {
      least = items_[child] < items_[least] ? child : least;
    }
    return least;
  }

  std::vector<QueueItem> items_;
};

/// Entries at fixed places, reused when they are done.
template <class Entry>
class Pool {
 public:
  void clear() {
    entries_.clear();
    free_.clear();
  }

  /// An entry with any content.
  [[nodiscard]] std::uint32_t add() {
    if (free_.empty()) {
      entries_.emplace_back();
      return static_cast<std::uint32_t>(entries_.size() - 1);
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
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
  SearchQueue queue;
  Pool<BoxGroup> groups;
  Pool<TriangleEntry> triangle_pairs;
  std::vector<OpenedPair> opened_pairs;  ///< Pairs that the last search opened.
  std::vector<ClosePair> close_pairs;
  std::vector<CloseKey> close_keys;
  std::vector<BoxPair> stack;
  std::vector<std::pair<double, BoxPair>> nearest;
  ScrewSlidingBounds screw_sliding_bounds;  ///< Bounds of the body that is no carrier.
  std::vector<ScrewSlidingNodes> screw_sliding_stack;
  std::vector<IndexPair> left_by_screw_sliding;
  std::vector<FrontTriangles> front_triangles;
  std::vector<FrontSeed> front_seeds;
  std::vector<NearTriangles> near_triangles;
};

}  // namespace firstcontact::detail
