/// @file
/// The forces of a haptic session over time as a picture (SVG).

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::app {

/// Collects ticks in columns.
///
/// Each column keeps its greatest values, so that no peak is lost. Columns become wider with time.
class HapticPlot {
 public:
  explicit HapticPlot(std::size_t tools) : tools_(tools) {}

  /// @param god_objects  their poses, one for each tool
  void add(const ForceTick& tick, std::int64_t begin_ns,
           const std::array<Pose, kMostTools>& god_objects);

  /// Draws from the first tick to the last one.
  ///
  /// @param undriven  as in HapticReport
  [[nodiscard]] std::string draw(std::string_view title, const std::string& undriven) const;

 private:
  struct Column {
    std::array<double, kMostTools> force = {};   // [N]
    std::array<double, kMostTools> torque = {};  // [N m]
    std::array<double, kMostTools> apart = {};   // [m]  Distance from target to god-object.
    double contacts = 0.0;

    void take(const Column& other);
  };
  Column& column_at(std::int64_t time_ns);

  std::size_t tools_;
  std::int64_t column_ns_ = 250'000;  // > 0
  std::int64_t end_ns_ = 0;
  std::vector<Column> columns_;
};

}  // namespace firstcontact::app
