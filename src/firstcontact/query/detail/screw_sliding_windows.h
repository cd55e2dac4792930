/// @file
/// Windows of a search in which surfaces slide on a screw.

#pragma once

#include <limits>

#include <firstcontact/query/detail/search_state.h>

namespace firstcontact::detail {

/// Leaves out pairs of triangles that screw sliding keeps apart, as of a nut on its bolt, window
/// after window.
class ScrewSlidingWindows {
 public:
  explicit ScrewSlidingWindows(SearchState& search) : search_(search) {}

  /// Whether the surfaces of both bodies may slide on a screw from the end of the proven time on.
  [[nodiscard]] bool may_screw_sliding() const;

  /// Goes on from t with the pairs of triangles that screw sliding does not prove apart, for as
  /// long as these are few.
  ///
  /// It returns false if they are not few, or nothing slides on a screw.
  [[nodiscard]] bool screw_sliding_on(double t);

 private:
  /// Whether a window from t on would reach the end of the time, or be long enough.
  [[nodiscard]] bool may_end_after(double t, double width) const;

  /// Starts with the pairs that screw sliding left.
  void follow_left(double t);

  SearchState& search_;
  // Width of the next window.
  double screw_sliding_width_ = std::numeric_limits<double>::infinity();
};

}  // namespace firstcontact::detail
