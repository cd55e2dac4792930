/// @file
/// Reads the motion of a captured figure from Acclaim's files: AMC.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/robot_files/motion_capture.h>

namespace firstcontact {

struct AsfSkeleton;

/// Reads an AMC file: the numbers of its frames, and in each a line for every bone that turns.
///
/// @param frame_time  [s]  > 0; the file does not state it
/// @throws ParseError  as read_asf, and for an unknown, missing or repeated bone. Frames must count
///         up by one.
/// @throws std::invalid_argument if the frame time is out of its range
[[nodiscard]] FIRSTCONTACT_API MotionCapture read_amc(const std::filesystem::path& path,
                                                      const AsfSkeleton& skeleton,
                                                      double frame_time = 1.0 / 120.0);

/// Parses the text of an AMC file, as read_amc() reads it.
///
/// @param source  names the text in errors
[[nodiscard]] FIRSTCONTACT_API MotionCapture parse_amc(std::string_view text,
                                                       const std::string& source,
                                                       const AsfSkeleton& skeleton,
                                                       double frame_time = 1.0 / 120.0);

}  // namespace firstcontact
