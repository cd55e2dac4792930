/// @file
/// The words of `--device`: the haptic device that moves a tool, and its address.

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <firstcontact/haptic_devices/browser_device.h>
#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/haptic_devices/haply.h>
#include <firstcontact/haptic_devices/recording.h>
#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_devices/space_mouse.h>
#include <firstcontact/haptics/force_loop.h>

namespace firstcontact::app {

/// A simulated hand, without hardware.
struct SimulatedChoice {};

/// A plug-in, and the settings for its device.
struct PluginChoice {
  std::string path;
  std::string settings;
};

/// A device that is named but not open yet.
using DeviceChoice = std::variant<SimulatedChoice, Recording, BrowserDeviceOptions,
                                  SpaceMouseOptions, HaplyOptions, PluginChoice>;

/// The port of a whole number from 1 on; none if the text is something else.
[[nodiscard]] std::optional<std::uint16_t> port_of(std::string_view text);

/// Reads one word: "simulated", "mouse", "mouse=PORT", "spacemouse", "spacemouse=SOCKET", "haply",
/// "haply=ws://HOST:PORT", "plugin=FILE", "plugin=FILE,SETTINGS", or else the path of a recording.
///
/// @throws ParseError  where an address has another form, or the recording is none
[[nodiscard]] DeviceChoice read_device_choice(const std::string& word);

/// Whether a person's hand moves the device, so that it needs the wall clock.
[[nodiscard]] bool is_live(const DeviceChoice& choice);

/// The file that a word names; none where it names no file.
[[nodiscard]] std::optional<std::filesystem::path> file_of_device(const std::string& word);

/// [s]  The time to the end of the last sample, as the device holds it: all samples are used.
///
/// @param word  the word that names the recording
/// @throws ParseError  where it is longer than a session can be
[[nodiscard]] double duration_of_recording(const std::string& word, const Recording& recording);

/// The number of grip values that a device has to sense: up to the last that no button closes.
[[nodiscard]] int grips_of_device(const DeviceMapping& mapping);

/// [m]  The radius of the ball in which a simulated hand moves its handle.
///
/// @param radius  [m]  of the ball to which it leads the tool
/// @throws std::invalid_argument  where the handle would go beyond the poses of a device
[[nodiscard]] double radius_of_hand(double radius, double scale);

/// Opens the device.
///
/// @param hand  options of a simulated hand
/// @throws std::runtime_error  where a service does not answer; names its address and the mend
[[nodiscard]] std::unique_ptr<Device> open_device(const DeviceChoice& choice,
                                                  const SimulatedOperatorOptions& hand);

}  // namespace firstcontact::app
