/// @file
/// The positions that the grips of a device want for the joints of its tool.

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
  /// Prepares the grips of a device.
  ///
  /// @param links  outlives this
  GripFollower(const std::vector<GripMapping>& grips, std::size_t tool, const ToolLinks& links);

  /// Computes the wanted positions. While the device is not engaged, they are those of the
  /// god-object at the end of the engagement, and grips by buttons stay.
  ///
  /// @param seconds  since the last tick.
  /// @param still_follows  as in TargetFollower::follow()
  /// @param values   takes the values of the grips.
  /// @param targets  takes the wanted positions of the tool's joints [rad or m], within their
  ///         limits.
  void follow(const DeviceState& device, bool is_engaged, const HapticContactSet& set,
              double seconds, bool still_follows, std::array<double, kMostGrips>& values,
              std::array<double, kMostHapticJoints>& targets) noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return grips_.size(); }

  /// [J]  Computes the effort on a grip from those of joints.
  [[nodiscard]] double effort(std::size_t grip,
                              const std::array<double, kMostHapticJoints>& efforts) const noexcept;

 private:
  std::vector<GripMapping> grips_;  // Joints have their numbers among those of all tools.
  std::size_t tool_ = 0;
  const ToolLinks* links_ = nullptr;
  std::array<double, kMostGrips> values_{};
  bool was_engaged_ = false;
};

}  // namespace firstcontact::detail
