/// @file
/// Warnings about devices and recordings of a haptic session.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/recording.h>
#include <firstcontact/haptics/haptic_scene.h>

namespace firstcontact::app {

/// Lists what a scene asks of a device beyond the stiffness and the damping that it declares.
///
/// @param scale  [-]  DeviceMapping::scale; the device feels the spring's stiffness times its
/// square
[[nodiscard]] std::vector<std::string> device_warnings(const HapticTool& tool, double scale,
                                                       const DeviceCapabilities& device);

/// Tells that a recording is faster than a hand through most of its motion, as one in millimetres
/// is that declares no scale. Empty for another one.
///
/// @param word  the recording as the user named it
[[nodiscard]] std::string recording_warning(const std::string& word, const Recording& recording);

}  // namespace firstcontact::app
