#include "haptic_warnings.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include <fmt/format.h>

#include "terminal_text.h"

namespace firstcontact::app {
namespace {

constexpr double kFastestHand = 20.0;  // [m/s]
constexpr double kWorkspaces = 4.0;    // [-]  Farther off, a place is in another unit.

/// Also for times that lie farther apart than a signed number can tell.
std::uint64_t nanoseconds_between(std::int64_t from, std::int64_t to) {
  return static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from);
}

/// The speeds of a recording at which its device moved.
struct Speeds {
  std::size_t moving = 0;
  std::size_t too_fast = 0;
  void add(double speed) {
    moving += speed > 0.0 ? 1 : 0;
    too_fast += speed > kFastestHand ? 1 : 0;
  }
};

/// A warning where a device goes farther from its first place than its workspace is wide.
std::string workspace_warning(const std::string& word, const Recording& recording) {
  const double radius = recording.capabilities.workspace_radius;
  double farthest = 0.0;
  for (const DeviceState& sample : recording.samples) {
    const Eigen::Vector3d way = sample.X_DH.position - recording.samples.front().X_DH.position;
    farthest = std::max(farthest, recording.calibration.scale * way.norm());
  }
  if (recording.capabilities.kind == DeviceKind::rate || !(farthest > kWorkspaces * radius)) {
    return {};
  }
  return fmt::format(
      "{}: goes {:.4g} m from its first place, but workspace_radius is {:.4g} m; for millimetres "
      "write \"# calibration_scale: 0.001\"",
      visible(word), farthest, radius);
}

}  // namespace

std::vector<std::string> device_warnings(const HapticTool& tool, double scale,
                                         const DeviceCapabilities& device) {
  struct Demand {
    const char* key;
    double asked;  // At the device.
    const char* limit_key;
    double limit;  // 0 where the device does not drive the axes: nothing is asked there.
    const char* unit;
  };
  const HapticCoupling& spring = tool.coupling;
  // The translation is scaled, and so is the force; rotations are not.
  const std::array<Demand, 4> demands{{
      {"stiffness", scale * scale * spring.stiffness, "max_stiffness", device.max_stiffness, "N/m"},
      {"angular_stiffness", spring.angular_stiffness, "max_angular_stiffness",
       device.max_angular_stiffness, "N m/rad"},
      {"damping", scale * scale * spring.damping, "max_damping", device.max_damping, "N s/m"},
      {"damping about axes", spring.angular_stiffness * spring.damping / spring.stiffness,
       "max_angular_damping", device.max_angular_damping, "N m s/rad"},
  }};
  std::vector<std::string> warnings;
  for (const Demand& demand : demands) {
    if (demand.limit > 0.0 && demand.asked > demand.limit) {
      warnings.push_back(fmt::format(
          "the {} of \"{}\" is {:.4g} {} at the device, whose {} is {:.4g}; walls may hum or kick",
          demand.key, visible(tool.name), demand.asked, demand.unit, demand.limit_key,
          demand.limit));
    }
  }
  return warnings;
}

std::string recording_warning(const std::string& word, const Recording& recording) {
  if (const std::string far = workspace_warning(word, recording); !far.empty()) {
    return far;
  }
  const double scale = recording.calibration.scale;
  Speeds speeds;
  for (std::size_t k = 0; k < recording.samples.size(); ++k) {
    const DeviceState& sample = recording.samples[k];
    if (recording.capabilities.kind == DeviceKind::rate) {
      speeds.add(scale * sample.linear_rate.norm());
    } else if (k > 0 && sample.time_ns > recording.samples[k - 1].time_ns) {
      const DeviceState& last = recording.samples[k - 1];
      speeds.add(1e9 * scale * (sample.X_DH.position - last.X_DH.position).norm() /
                 static_cast<double>(nanoseconds_between(last.time_ns, sample.time_ns)));
    }
  }
  if (2 * speeds.too_fast <= speeds.moving) {
    return {};
  }
  return fmt::format(
      "{}: faster than {:.4g} m/s in {} of {} samples that move; for millimetres write "
      "\"# calibration_scale: 0.001\"",
      visible(word), kFastestHand, speeds.too_fast, speeds.moving);
}

}  // namespace firstcontact::app
