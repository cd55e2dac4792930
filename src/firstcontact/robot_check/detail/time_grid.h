/// @file
/// A piece of time, halved again and again.

#pragma once

#include <firstcontact/motion/time_window.h>

namespace firstcontact::detail {

/// Number of halvings of a piece of time. More of them cost more in places of links than they save
/// in searches.
inline constexpr int kHalvings = 3;

/// A window of time from halving a piece, by the numbers of its ends in a grid.
struct GridWindow {
  static constexpr int kSize = 2 << kHalvings;  ///< The shortest windows have a middle, too.

  int begin = 0;
  int end = kSize;

  [[nodiscard]] int middle() const { return (begin + end) / 2; }
  [[nodiscard]] bool can_be_halved() const { return end - begin > 2; }
  [[nodiscard]] GridWindow first_half() const { return {begin, middle()}; }
  [[nodiscard]] GridWindow second_half() const { return {middle(), end}; }

  friend bool operator==(const GridWindow&, const GridWindow&) = default;
};

/// The times of the grid of a piece.
struct TimeGrid {
  static constexpr int kMiddle = GridWindow::kSize / 2;

  TimeWindow piece;

  [[nodiscard]] double at(int k) const {
    constexpr double kStep = 1.0 / GridWindow::kSize;
    return k == GridWindow::kSize ? piece.end
                                  : piece.begin + (piece.end - piece.begin) * (k * kStep);
  }
  [[nodiscard]] TimeWindow at(const GridWindow& window) const {
    return {at(window.begin), at(window.end)};
  }
};

}  // namespace firstcontact::detail
