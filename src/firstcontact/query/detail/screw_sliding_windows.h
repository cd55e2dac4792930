/// @file
/// Windows of a search in which surfaces screw_sliding along each other.

#pragma once

#include <limits>

#include <firstcontact/query/detail/search_state.h>

namespace firstcontact::detail {

/// Leaves out the pairs of triangles that stay apart by their surfaces' screw_sliding, as of a nut
/// on its bolt, window after window.
class ScrewSlidingWindows {
 public:
  explicit ScrewSlidingWindows(SearchState& search) : search_(search) {}

  /// Whether the surfaces of both bodies screw_sliding, from what is proven free on.
  [[nodiscard]] bool may_screw_sliding() const;

  /// Goes on from t with the pairs of triangles that are not proven apart by their surfaces'
  /// screw_sliding, for as long as these are few. False if they are not, or nothing glides.
  [[nodiscard]] bool screw_sliding_on(double t);

 private:
  /// Whether a window from t on would be as short as the time that is left, or long enough.
  [[nodiscard]] bool may_end_after(double t, double width) const;

  /// Starts with the pairs that screw_sliding left.
  void follow_left(double t);

  SearchState& search_;
  double screw_sliding_width_ = std::numeric_limits<double>::infinity();  // Of the next window.
};

}  // namespace firstcontact::detail
