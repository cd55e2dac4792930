#include <firstcontact/haptic_devices/device.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

namespace firstcontact {
namespace {

/// Takes the driven components of a vector.
Eigen::Vector3d along_driven(const Eigen::Vector3d& vector, const std::array<bool, 3>& driven) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    result[i] = driven[axis] ? vector[i] : 0.0;
  }
  return result;
}

/// Takes the driven components of a vector, with a length of at most `most`.
Eigen::Vector3d limited_part(const Eigen::Vector3d& vector, const std::array<bool, 3>& driven,
                             double most) {
  const Eigen::Vector3d result = along_driven(vector, driven);
  const double largest = result.lpNorm<Eigen::Infinity>();
  if (!(most > 0.0) || !(largest > 0.0)) {
    return Eigen::Vector3d::Zero();
  }
  // Scaled before the norm, as the square of a length may overflow.
  const Eigen::Vector3d scaled = result / largest;
  const double length = scaled.norm();
  return length <= most / largest ? result : Eigen::Vector3d(scaled * (most / length));
}

}  // namespace

Device::~Device() = default;

std::int64_t steady_now_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

ForceCommand driven_part(const ForceCommand& command,
                         const DeviceCapabilities& capabilities) noexcept {
  ForceCommand driven{.force_D = along_driven(command.force_D, capabilities.driven.linear),
                      .torque_D = along_driven(command.torque_D, capabilities.driven.angular)};
  for (std::size_t k = 0; k < kMostGrips; ++k) {
    const bool is_driven =
        capabilities.max_grip_effort > 0.0 && static_cast<int>(k) < capabilities.grips;
    driven.grips[k] = is_driven ? command.grips[k] : 0.0;
  }
  return driven;
}

ForceCommand limited(const ForceCommand& command, const DeviceCapabilities& capabilities) noexcept {
  const bool are_finite = std::all_of(command.grips.begin(), command.grips.end(),
                                      [](double effort) { return std::isfinite(effort); });
  if (!command.force_D.allFinite() || !command.torque_D.allFinite() || !are_finite) {
    return {};
  }
  ForceCommand allowed{
      .force_D = limited_part(command.force_D, capabilities.driven.linear, capabilities.max_force),
      .torque_D =
          limited_part(command.torque_D, capabilities.driven.angular, capabilities.max_torque)};
  const double most = capabilities.max_grip_effort;
  for (std::size_t k = 0; k < kMostGrips; ++k) {
    const bool is_driven = most > 0.0 && static_cast<int>(k) < capabilities.grips;
    allowed.grips[k] = is_driven ? std::clamp(command.grips[k], -most, most) : 0.0;
  }
  return allowed;
}

}  // namespace firstcontact
