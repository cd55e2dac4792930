/// @file
/// Reads captured motion from BVH files.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/robot_files/motion_capture.h>

namespace firstcontact {

/// The options of reading a BVH file.
struct BvhOptions {
  double unit_length = 0.01;  ///< [m]  Length of one unit of the file; > 0.
};

/// Reads a BVH file: HIERARCHY with one ROOT, then MOTION.
///
/// A bone reaches from its joint to each of its children's joints and to its end site. The channels
/// give its rotations in degrees, multiplied from left to right. Only the root has position
/// channels. There they replace its offset.
///
/// @throws ParseError  one line with path, line and what was expected
/// @throws std::invalid_argument if an option is out of its range
[[nodiscard]] FIRSTCONTACT_API MotionCapture read_bvh(const std::filesystem::path& path,
                                                      const BvhOptions& options = {});

/// Parses the text of a BVH file, as read_bvh() reads it.
///
/// @param source  names the text in errors
[[nodiscard]] FIRSTCONTACT_API MotionCapture parse_bvh(std::string_view text,
                                                       const std::string& source,
                                                       const BvhOptions& options = {});

}  // namespace firstcontact
