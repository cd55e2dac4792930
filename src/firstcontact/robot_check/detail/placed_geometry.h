/// @file
/// A geometry at the times of a grid, and in the windows between them.

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/robot_check/detail/robot_timeline.h>
#include <firstcontact/robot_check/detail/swept_geometry.h>
#include <firstcontact/robot_check/detail/time_grid.h>
#include <firstcontact/robot_check/detail/tree_poses.h>

namespace firstcontact::detail {

/// A geometry in one frame over a piece of time. Windows share the places at common times.
class PlacedGeometry {
 public:
  /// @param memory  for the places
  /// @param path    its path in F, for tracking errors
  PlacedGeometry(std::pmr::memory_resource& memory, const BoundedGeometry& geometry,
                 const GeometryMount& mount, std::size_t frame, const TimeGrid& grid,
                 std::optional<GeometryPath> path)
      : geometry_(&geometry),
        track_(geometry, mount, frame),
        grid_(grid),
        path_(std::move(path)),
        places_(&memory) {
    known_.fill(-1);
    if (track_.rests()) {
      swept_ = track_.rest();
    } else {
      places_.reserve(kFewPlaces);
    }
  }

  /// The geometry over a window. Valid until the next call.
  const SweptGeometry& over(const GridWindow& window) {
    if (!track_.rests() && !(window == window_)) {
      const GeometryPlace begin = place(window.begin);
      const GeometryPlace middle = place(window.middle());
      swept_ = track_.sweep(grid_.at(window), begin, middle, place(window.end));
      window_ = window;
    }
    return swept_;
  }

  /// [m]  Bound of the distance of any point from its place in the window.
  [[nodiscard]] double tracking_bound(const GridWindow& window, LinkScratch& scratch) const {
    return path_ ? path_->tracking_bound(geometry_->core, grid_.at(window), scratch) : 0.0;
  }

 private:
  static constexpr std::size_t kFewPlaces = 5;  // Places of the piece and its halves.

  const GeometryPlace& place(int k) {
    std::int16_t& index = known_[static_cast<std::size_t>(k)];
    if (index < 0) {
      index = static_cast<std::int16_t>(places_.size());
      places_.push_back(track_.place(k));
    }
    return places_[static_cast<std::size_t>(index)];
  }

  const BoundedGeometry* geometry_;
  GeometryTrack track_;
  TimeGrid grid_;
  std::optional<GeometryPath> path_;
  std::array<std::int16_t, GridWindow::kSize + 1> known_ =
      {};  // Indices into places_; < 0 for none.
  std::pmr::vector<GeometryPlace> places_;
  GridWindow window_ = {0, 0};  // Window of swept_.
  SweptGeometry swept_;
};

}  // namespace firstcontact::detail
