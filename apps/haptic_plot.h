/// @file
/// The forces of a haptic session over time as a picture (SVG).

#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::app {

/// Gathers ticks in columns, of which each keeps its greatest values: no peak is lost.
class HapticPlot {
 public:
  /// @param duration  [s]
  HapticPlot(std::size_t tools, double duration);

  /// @param god_objects  where they are, one for each tool
  void add(const ForceTick& tick, std::int64_t begin_ns,
           const std::array<Pose, kMostTools>& god_objects);

  [[nodiscard]] std::string draw(std::string_view title) const;

 private:
  struct Column {
    std::array<double, kMostTools> force = {};   // [N]
    std::array<double, kMostTools> torque = {};  // [N m]
    std::array<double, kMostTools> apart = {};   // [m]  From target to god-object.
    double contacts = 0.0;
  };
  std::size_t tools_;
  double duration_;
  std::vector<Column> columns_;
};

}  // namespace firstcontact::app
