/// @file
/// Bounds groups of pairs of boxes of a search: until when each pair stays apart.

#pragma once

#include <cstdint>
#include <optional>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/narrowphase/detail/box_bounds.h>
#include <firstcontact/query/detail/group_queue.h>
#include <firstcontact/query/detail/search_state.h>
#include <firstcontact/query/detail/triangle_follower.h>
#include <firstcontact/query/detail/workspace_data.h>

namespace firstcontact::detail {

/// Bounds the groups of a search, and queues them by the times that it finds.
class GroupBounder {
 public:
  GroupBounder(SearchState& search, const TriangleFollower& triangles)
      : search_(search), triangles_(triangles) {}

  /// Bounds a group at the time until which it is proven, and the next one along with it if that
  /// can be done at the same instant: two take less than twice the time of one. Queues both.
  void bound(const Bounding& first);

  /// Bounds the groups of a front of which lanes may come near in the window that begins at t.
  /// False, with nothing done, where these are many.
  [[nodiscard]] bool bound_front(const BoxFront& front, double t);

 private:
  void bound_one(const Bounding& bounding);
  void bound_both(const Bounding& first, const Bounding& second);

  /// Bounds the lanes that WorkspaceData::front_seeds lists.
  void bound_seeds(const BoxFront& front, double t);

  /// What comes next in the queue, if it is to be bounded and due soon after the bodies were
  /// placed. Not what is due as early as t: of ties one may turn out to be the contact.
  [[nodiscard]] std::optional<Bounding> take_after(double t);

  /// Keeps the lanes of a group that are not free for good, and queues them.
  void take(const Bounding& bounding, BoxBounds& bounds);

  /// Bodies that graze each other come near in many pairs of triangles, most of which one step
  /// frees for good. It costs less to take it here, where the bodies are placed and the triangles
  /// are at hand, than when the pair is due. Returns the lanes that are done with, and improves
  /// the times of others.
  unsigned free_triangles(const BoxGroup& group, unsigned live, BoxBounds& bounds);

  /// Lanes in which double precision, and the corners of triangles in place of their boxes, may
  /// find more. Two triangles are as quickly tested themselves; a large one matters to many small
  /// boxes, unless it turned out not to.
  [[nodiscard]] unsigned in_doubt(const HierarchyNode& a, const HierarchyNode& b,
                                  const BoxBounds& bounds) const;

  /// Repeats lanes where single precision could not tell; returns those that are done with, and
  /// improves the times of others.
  unsigned bound_in_double(const BoxGroup& group, unsigned lanes, BoxBounds& bounds);

  /// Whether a lane that is proven for so long is done with; else improves its time.
  [[nodiscard]] bool finishes(int lane, double apart, BoxBounds& bounds) const;

  SearchState& search_;
  const TriangleFollower& triangles_;
  std::uint64_t repeated_ = 0;  // Bounds in double precision.
  std::uint64_t worth_repeating_ = 0;
};

}  // namespace firstcontact::detail
