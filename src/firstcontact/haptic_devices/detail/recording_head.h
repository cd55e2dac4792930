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

/// Reads one line of the head: "key: value".
///
/// @throws ParseError  if the key is unknown, or the value does not fit the key
void read_recording_key(std::string_view line, const std::string& source, std::size_t number,
                        Recording& recording);

/// Writes all lines of the head, each with "# " before it.
[[nodiscard]] std::string recording_keys(const DeviceCapabilities& capabilities,
                                         const DeviceCalibration& calibration);

/// Reads a finite number, or an infinite one if `infinite` permits it; NaN where the text is
/// neither.
[[nodiscard]] double number_or_nan(std::string_view text, bool infinite = false);

}  // namespace firstcontact::detail
