/// @file
/// Recordings of haptic devices: their data, reader and writer.

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/haptic_devices/device.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The map from the frame R in which a device was recorded to the device frame D.
///
/// p_D = X_DR.position + R_DR (scale p_R). Rotations turn by R_DR, linear rates turn and scale,
/// angular rates turn.
struct DeviceCalibration {
  double scale = 1.0;  ///< [-]  Metres per recorded unit; > 0.
  Pose X_DR;
};

/// A recording of one device.
struct Recording {
  DeviceCapabilities capabilities;
  DeviceCalibration calibration;
  /// The samples as recorded, in R. Times and sequence numbers do not decrease. A repeated sequence
  /// number is the same sample again; a jump of it means that samples are missing.
  std::vector<DeviceState> samples;
};

/// Parses a recording. docs/haptic_devices.md describes the format.
///
/// @param source  names the text in errors
/// @throws ParseError  with the line, the column and the mend
[[nodiscard]] FIRSTCONTACT_API Recording parse_recording(std::string_view text,
                                                         const std::filesystem::path& source);

/// Reads a recording.
///
/// @throws ParseError  as parse_recording, or if the file cannot be read
[[nodiscard]] FIRSTCONTACT_API Recording read_recording(const std::filesystem::path& path);

/// Writes the lines of a recording before its samples, with line ends.
///
/// With `recording_line` a program writes a recording while it runs.
///
/// @throws std::invalid_argument  if a name or id is longer than 200 bytes or has a
///                                control character, or a number is NaN
[[nodiscard]] FIRSTCONTACT_API std::string recording_head(
    const DeviceCapabilities& capabilities, const DeviceCalibration& calibration = {});

/// Writes the line of one sample, with its line end. The line reads back to the same numbers.
///
/// @param grips  number of values of grips that the device senses
[[nodiscard]] FIRSTCONTACT_API std::string recording_line(const DeviceState& sample,
                                                          DeviceKind kind, int grips = 0);

/// Writes a whole recording as text.
[[nodiscard]] FIRSTCONTACT_API std::string write_recording(const Recording& recording);

/// Maps a sample to the device frame D. One that is there already stays the same, bit for bit.
[[nodiscard]] FIRSTCONTACT_API DeviceState
calibrated(const DeviceState& sample, const DeviceCalibration& calibration) noexcept;

}  // namespace firstcontact
