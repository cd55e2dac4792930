/// @file
/// Where the grips of a device want the joints of its tool to be.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/tool_links.h>
#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::detail {

/// Checks the grips of a tool.
///
/// @throws std::invalid_argument for too many grips, a joint that the tool lacks or that two grips
///         have, or a number out of its range
void check_grips(std::span<const GripMapping> grips, const HapticTool& tool);

/// Follows the grips of one device. After the construction nothing is allocated.
class GripFollower {
 public:
  /// @param links  outlives it
  GripFollower(const std::vector<GripMapping>& grips, std::size_t tool, const ToolLinks& links);

  /// While the device is not engaged, joints are wanted where the god-object had them when the
  /// engagement ended, and grips by buttons stay.
  ///
  /// @param seconds  since the last tick.
  /// @param values   takes the values of the grips.
  /// @param targets  takes where the tool's joints are wanted [rad or m], within their limits.
  void follow(const DeviceState& device, bool is_engaged, const HapticContactSet& set,
              double seconds, std::array<double, kMostGrips>& values,
              std::array<double, kMostHapticJoints>& targets) noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return grips_.size(); }

  /// [J]  The effort on a grip by those of joints.
  [[nodiscard]] double effort(std::size_t grip,
                              const std::array<double, kMostHapticJoints>& efforts) const noexcept;

 private:
  std::vector<GripMapping> grips_;  // Joints numbered among those of all tools.
  std::size_t tool_ = 0;
  const ToolLinks* links_ = nullptr;
  std::array<double, kMostGrips> values_{};
  bool was_engaged_ = false;
};

}  // namespace firstcontact::detail
