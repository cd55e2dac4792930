#include <firstcontact/haptics/detail/grip_follower.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <firstcontact/haptics/detail/haptic_scene_check.h>

namespace firstcontact::detail {

void check_grips(std::span<const GripMapping> grips, const HapticTool& tool) {
  require_haptic(grips.size() <= kMostGrips,
                 "a tool has at most " + std::to_string(kMostGrips) + " grips");
  std::vector<bool> is_moved(tool.joints.size(), false);
  for (const GripMapping& grip : grips) {
    require_haptic(grip.button < 32 && grip.seconds > 0.0 && std::isfinite(grip.seconds),
                   "GripMapping: a device has at most 32 buttons, and seconds must be > 0");
    for (const GripMapping::Joint& joint : grip.joints) {
      require_haptic(joint.joint < tool.joints.size() && !is_moved[joint.joint],
                     "GripMapping: each joint of a tool belongs to one grip at most");
      require_haptic(std::isfinite(joint.open) && std::isfinite(joint.closed),
                     "GripMapping: open and closed must be finite");
      is_moved[joint.joint] = true;
    }
  }
}

GripFollower::GripFollower(const std::vector<GripMapping>& grips, std::size_t tool,
                           const ToolLinks& links)
    : grips_(grips), tool_(tool), links_(&links) {
  std::size_t first = 0;
  while (first < links.joints().size() && links.tool_of_joint(first) != tool) {
    ++first;
  }
  for (GripMapping& grip : grips_) {
    for (GripMapping::Joint& joint : grip.joints) {
      joint.joint += first;
    }
  }
}

void GripFollower::follow(const DeviceState& device, bool is_engaged, const HapticContactSet& set,
                          double seconds, bool still_follows,
                          std::array<double, kMostGrips>& values,
                          std::array<double, kMostHapticJoints>& targets) noexcept {
  if (!is_engaged) {
    const bool moves_on = was_engaged_ || still_follows;
    for (std::size_t joint = 0; joint < links_->joints().size() && moves_on; ++joint) {
      if (links_->tool_of_joint(joint) == tool_ && set.sequence > 0) {
        targets[joint] = set.joints[joint];
      }
    }
    was_engaged_ = false;
    return;
  }
  was_engaged_ = true;
  for (std::size_t k = 0; k < grips_.size(); ++k) {
    const GripMapping& grip = grips_[k];
    if (grip.button < 0) {
      values_[k] = std::clamp(device.grips[k], 0.0, 1.0);
    } else {
      const bool closes = (device.buttons >> static_cast<unsigned>(grip.button) & 1U) != 0;
      const double way = seconds / grip.seconds;
      values_[k] = std::clamp(values_[k] + (closes ? way : -way), 0.0, 1.0);
    }
    values[k] = values_[k];
    for (const GripMapping::Joint& joint : grip.joints) {
      const HapticJoint& limits = links_->joints()[joint.joint];
      targets[joint.joint] = std::clamp(joint.open + values_[k] * (joint.closed - joint.open),
                                        limits.lower, limits.upper);
    }
  }
}

double GripFollower::effort(std::size_t grip,
                            const std::array<double, kMostHapticJoints>& efforts) const noexcept {
  double effort = 0.0;
  for (const GripMapping::Joint& joint : grips_[grip].joints) {
    effort += efforts[joint.joint] * (joint.closed - joint.open);
  }
  return effort;
}

}  // namespace firstcontact::detail
