/// @file
/// Bounds of the times for which groups of pairs of boxes stay apart.

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

/// Bounds the groups of a search, and queues them by their times.
class GroupBounder {
 public:
  GroupBounder(SearchState& search, const TriangleFollower& triangles)
      : search_(search), triangles_(triangles) {}

  /// Bounds a group at the time until which it is proven, and queues it.
  ///
  /// If the next group can be bounded at the same instant, it is, too: two take less than twice the
  /// time of one.
  void bound(const Bounding& first);

  /// Bounds the groups of a front whose lanes may come near in the window that begins at t.
  ///
  /// It returns false, with nothing done, where these are many.
  [[nodiscard]] bool bound_front(const BoxFront& front, double t);

 private:
  void bound_one(const Bounding& bounding);
  void bound_both(const Bounding& first, const Bounding& second);

  /// Bounds the lanes that WorkspaceData::front_seeds lists.
  void bound_seeds(const BoxFront& front, double t);

  /// The next group in the queue, if it is due soon after the bodies were placed.
  ///
  /// A group that is due as early as t is not taken: of ties one may turn out to be the contact.
  [[nodiscard]] std::optional<Bounding> take_after(double t);

  /// Keeps the lanes of a group that are not free for good, and queues them.
  void take(const Bounding& bounding, BoxBounds& bounds);

  /// Proves pairs of triangles free for good, where one step does so.
  ///
  /// Bodies that graze each other come near in many pairs of triangles, most of which one step
  /// frees for good. That step costs less here, where bodies and triangles are placed, than when
  /// the pair is due. It returns the lanes that are done with, and improves the times of others.
  unsigned free_triangles(const BoxGroup& group, unsigned live, BoxBounds& bounds);

  /// Lanes for which double precision, and the corners of triangles in place of their boxes, may
  /// prove a longer time.
  ///
  /// Two triangles are tested as quickly themselves. A large triangle matters to many small boxes,
  /// unless it turned out not to.
  [[nodiscard]] unsigned in_doubt(const HierarchyNode& a, const HierarchyNode& b,
                                  const BoxBounds& bounds) const;

  /// Repeats lanes that single precision could not decide.
  ///
  /// It returns those that are done with, and improves the times of others.
  unsigned bound_in_double(const BoxGroup& group, unsigned lanes, BoxBounds& bounds);

  /// Whether a lane that is proven for so long is done with; else its time improves.
  [[nodiscard]] bool finishes(int lane, double apart, BoxBounds& bounds) const;

  SearchState& search_;
  const TriangleFollower& triangles_;
  std::uint64_t repeated_ = 0;  // Number of bounds in double precision.
  std::uint64_t worth_repeating_ = 0;
};

}  // namespace firstcontact::detail
