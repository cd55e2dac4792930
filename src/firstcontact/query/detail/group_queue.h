/// @file
/// The queue of a search: groups of pairs of boxes, and pairs of triangles, the earliest first.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <firstcontact/math/root_isolation.h>
#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/moving_pairs/detail/lane_times.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// A group that the kernel is to bound: a new one, or again one of well separated pairs.
struct Bounding {
  static constexpr int kNew = -1;

  std::uint32_t index;
  double t;      // All lanes are proven until then.
  int far_lane;  // The lane that causes another bound, or kNew.
};

/// Groups and pairs of triangles in the order of the times until which they are proven free.
class GroupQueue {
 public:
  /// @param tie_window  [-]  how much earlier the deepest level may come
  GroupQueue(const MovingPair& pair, double tie_window, WorkspaceData& workspace)
      : pair_(pair),
        tie_window_(tie_window),
        queue_(workspace.queue),
        groups_(workspace.groups),
        triangle_pairs_(workspace.triangle_pairs) {}

  void clear() {
    queue_.clear();
    groups_.clear();
    triangle_pairs_.clear();
  }

  [[nodiscard]] bool empty() const { return queue_.empty(); }
  [[nodiscard]] const QueueItem& top() const { return queue_.top(); }
  [[nodiscard]] BoxGroup& group(std::uint32_t index) { return groups_[index]; }
  [[nodiscard]] std::size_t bytes() const {
    return queue_.size() * sizeof(QueueItem) + groups_.bytes() + triangle_pairs_.bytes();
  }

  void push(const TriangleEntry& entry) {
    const std::uint32_t index = triangle_pairs_.add();
    triangle_pairs_[index] = entry;
    queue_.push({entry.key, index, true});
  }

  /// Removes the pair of triangles at the top of the queue, and returns it.
  [[nodiscard]] TriangleEntry take_triangles() {
    const std::uint32_t index = queue_.top().index;
    queue_.pop();
    const TriangleEntry entry = triangle_pairs_[index];
    triangle_pairs_.release(index);
    return entry;
  }

  /// Queues a group that was bounded.
  void push_group(std::uint32_t index) { queue_.push(item(index)); }
  void release_group(std::uint32_t index) { groups_.release(index); }

  /// [-]  The time before which no contact of a lane is possible.
  static double due(const BoxGroup& group, LaneTime lane) {
    return after(group.base, static_cast<double>(lane.time()));
  }

  static bool is_far(const BoxGroup& group) { return (group.far >> group.next.lane() & 1u) != 0; }

  /// The boxes in the earliest lane of a group.
  [[nodiscard]] BoxPair next_inside(const BoxGroup& group) const {
    const int lane = group.next.lane();
    return open_lane(pair_, group.node_a, group.node_b, lane, (group.larger_a >> lane & 1u) != 0,
                     (group.larger_b >> lane & 1u) != 0);
  }

  /// Removes the group at the top of the queue, to be bound again.
  [[nodiscard]] Bounding take_again(std::uint32_t index) {
    queue_.pop();
    return {index, groups_[index].due, groups_[index].next.lane()};
  }

  /// Takes the boxes in the earliest lane of the group at the top of the queue.
  [[nodiscard]] Bounding take_inside(std::uint32_t index, const BoxPair& inside) {
    const double t = groups_[index].due;
    const unsigned level = groups_[index].level + 1u;
    drop_next(index);
    return new_group(t, inside.A, inside.B, level);
  }

  [[nodiscard]] Bounding new_group(double t, const NodeBoxes& a, const NodeBoxes& b,
                                   unsigned level) {
    const std::uint32_t index = groups_.add();
    BoxGroup& group = groups_[index];
    group.lanes = kNoTimes;
    group.base = t;
    group.node_a = a.node;
    group.node_b = b.node;
    group.live = lanes_of(a.used, b.used);
    group.level = static_cast<std::uint16_t>(std::min(level, 0xffffu));
    return {index, t, Bounding::kNew};
  }

  /// Drops the earliest lane of the group at the top of the queue.
  void drop_next(std::uint32_t index) {
    BoxGroup& group = groups_[index];
    const int lane = group.next.lane();
    group.live = static_cast<std::uint16_t>(group.live & ~(1u << lane));
    if (group.live == 0) {
      queue_.pop();
      groups_.release(index);
    } else {
      group.next = drop(group.lanes, lane);
      group.due = due(group, group.next);
      queue_.replace_top(item(index));
    }
  }

 private:
  /// The queue's item for a group.
  [[nodiscard]] QueueItem item(std::uint32_t index) {
    const BoxGroup& group = groups_[index];
    return {group.due - lag(group.level), index, false};
  }

  /// [-]  Makes each level come a little earlier than the last, so that ties are searched
  /// depth-first.
  [[nodiscard]] double lag(std::uint32_t level) const {
    return std::min(tie_window_, static_cast<double>(level) * (tie_window_ / 64.0));
  }

  const MovingPair& pair_;
  double tie_window_;
  SearchQueue& queue_;
  Pool<BoxGroup>& groups_;
  Pool<TriangleEntry>& triangle_pairs_;
};

}  // namespace firstcontact::detail
