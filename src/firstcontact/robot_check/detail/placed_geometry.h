/// @file
/// A part at the times of a grid, and in the windows between them.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/detail/swept_part.h>
#include <firstcontact/robot_check/detail/time_grid.h>
#include <firstcontact/robot_check/detail/tree_poses.h>

namespace firstcontact::detail {

/// A part in one frame over a piece of time. Windows that share times share the places there.
class PlacedPart {
 public:
  /// @param path  the same in F, where it is asked for tracking errors
  PlacedPart(const Part& part, const PartMount& mount, std::size_t frame, const TimeGrid& grid,
             std::optional<PartPath> path)
      : part_(&part), track_(part, mount, frame), grid_(grid), path_(std::move(path)) {
    known_.fill(-1);
    if (track_.rests()) {
      swept_ = track_.rest();
    } else {
      places_.reserve(kFewPlaces);
    }
  }

  /// Valid until the next call.
  const SweptPart& over(const GridWindow& window) {
    if (!track_.rests() && !(window == window_)) {
      const PartPlace begin = place(window.begin);
      const PartPlace middle = place(window.middle());
      swept_ = track_.sweep(grid_.at(window), begin, middle, place(window.end));
      window_ = window;
    }
    return swept_;
  }

  /// [m]  How far any point may be from its place in the window.
  [[nodiscard]] double tracking_bound(const GridWindow& window) const {
    return path_ ? path_->tracking_bound(part_->box, grid_.at(window)) : 0.0;
  }

 private:
  static constexpr std::size_t kFewPlaces = 5;  // Of the piece and its halves.

  const PartPlace& place(int k) {
    std::int16_t& index = known_[static_cast<std::size_t>(k)];
    if (index < 0) {
      index = static_cast<std::int16_t>(places_.size());
      places_.push_back(track_.place(k));
    }
    return places_[static_cast<std::size_t>(index)];
  }

  const Part* part_;
  PartTrack track_;
  TimeGrid grid_;
  std::optional<PartPath> path_;
  std::array<std::int16_t, GridWindow::kSize + 1> known_ =
      {};  // Where in places_; < 0 for nowhere.
  std::vector<PartPlace> places_;
  GridWindow window_ = {0, 0};  // Of swept_.
  SweptPart swept_;
};

}  // namespace firstcontact::detail
