/// @file
/// Loads devices of vendors from plug-ins.

#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Loads a plug-in (see device_plugin.h) and opens its device.
///
/// The device checks the samples of the plug-in. It drops a sample with a number that is not
/// finite, or without a rotation, and counts it as malformed. Commands reach the plug-in within its
/// limits. The library stays loaded as long as the device.
///
/// A plug-in runs in this process with all of its rights: load only what you trust.
///
/// @param settings  for the plug-in, as its documentation describes them
/// @throws ParseError  names the library: it cannot be loaded, is no plug-in, was made for another
///                     version of the interface, gives abilities that make no sense, or cannot open
///                     its device
[[nodiscard]] FIRSTCONTACT_API std::unique_ptr<Device> load_device_plugin(
    const std::filesystem::path& path, const std::string& settings = {});

}  // namespace firstcontact
