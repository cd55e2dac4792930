/// @file
/// The keys at the top of a recording.

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <firstcontact/haptic_devices/recording.h>

namespace firstcontact::detail {

/// The words that open a recording, before its version.
inline constexpr std::string_view kRecordingTitle = "firstcontact recording";

/// Sets what one line of the head says: "key: value".
///
/// @throws ParseError  if the key is unknown, or the value is not what the key needs
void read_recording_key(std::string_view line, const std::string& source, std::size_t number,
                        Recording& recording);

/// All lines of the head, each with "# " before it.
[[nodiscard]] std::string recording_keys(const DeviceCapabilities& capabilities,
                                         const DeviceCalibration& calibration);

/// A finite number, or an infinite one if `infinite` allows it; NaN where the text is neither.
[[nodiscard]] double number_or_nan(std::string_view text, bool infinite = false);

}  // namespace firstcontact::detail
