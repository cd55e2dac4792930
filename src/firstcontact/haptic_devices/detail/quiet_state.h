/// @file
/// The states of a device that gives no live samples.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include <firstcontact/haptic_devices/device.h>

namespace firstcontact::detail {

/// Makes a state with the pose of a sample, without rates and with all buttons released.
[[nodiscard]] inline DeviceState quiet(DeviceState sample, DeviceStatus status) noexcept {
  sample.linear_rate.setZero();
  sample.angular_rate.setZero();
  sample.buttons = 0;
  sample.status = status;
  return sample;
}

/// [m, m/s and rad/s]  Bound of a valid sample. A device that is farther away or faster has lost
/// its reading.
inline constexpr double kMostOfSample = 1e6;

/// Whether the values of grips are finite and within the bound.
[[nodiscard]] inline bool are_grips(const DeviceState& sample) noexcept {
  return std::all_of(sample.grips.begin(), sample.grips.end(),
                     [](double value) { return std::abs(value) <= kMostOfSample; });
}

/// Whether the numbers of a sample are those of a device, and its quaternion is a rotation.
[[nodiscard]] inline bool makes_sense(const DeviceState& sample) noexcept {
  const double length = sample.X_DH.rotation.coeffs().norm();
  return are_grips(sample) && sample.X_DH.position.norm() <= kMostOfSample &&
         std::abs(length - 1.0) < 1e-3 && sample.linear_rate.norm() <= kMostOfSample &&
         sample.angular_rate.norm() <= kMostOfSample;
}

}  // namespace firstcontact::detail
