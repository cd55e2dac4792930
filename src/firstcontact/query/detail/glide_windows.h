/// @file
/// Windows of a search in which surfaces glide along each other.

#pragma once

#include <limits>

#include <firstcontact/query/detail/search_state.h>

namespace firstcontact::detail {

/// Leaves out the pairs of triangles that stay apart by their surfaces' gliding, as of a nut on its
/// bolt, window after window.
class GlideWindows {
 public:
  explicit GlideWindows(SearchState& search) : search_(search) {}

  /// Whether the surfaces of both bodies glide, from what is proven free on.
  [[nodiscard]] bool may_glide() const;

  /// Goes on from t with the pairs of triangles that are not proven apart by their surfaces'
  /// gliding, for as long as these are few. False if they are not, or nothing glides.
  [[nodiscard]] bool glide_on(double t);

 private:
  /// Whether a window from t on would be as short as the time that is left, or long enough.
  [[nodiscard]] bool may_end_after(double t, double width) const;

  /// Starts with the pairs that gliding left.
  void follow_left(double t);

  SearchState& search_;
  double glide_width_ = std::numeric_limits<double>::infinity();  // Of the next window.
};

}  // namespace firstcontact::detail
