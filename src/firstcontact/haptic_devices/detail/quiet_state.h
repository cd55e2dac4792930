/// @file
/// The states of a device that gives no live samples.

#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include <firstcontact/haptic_devices/device.h>

namespace firstcontact::detail {

/// The pose of a sample, without rates and with all buttons released.
[[nodiscard]] inline DeviceState quiet(DeviceState sample, DeviceStatus status) noexcept {
  sample.linear_rate.setZero();
  sample.angular_rate.setZero();
  sample.buttons = 0;
  sample.status = status;
  return sample;
}

/// Whether all numbers of a sample are finite and its quaternion is a rotation.
[[nodiscard]] inline bool makes_sense(const DeviceState& sample) noexcept {
  const double length = sample.X_DH.rotation.coeffs().norm();
  return sample.X_DH.position.allFinite() && std::abs(length - 1.0) < 1e-3 &&
         sample.linear_rate.allFinite() && sample.angular_rate.allFinite();
}

}  // namespace firstcontact::detail
