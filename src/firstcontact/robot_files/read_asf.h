/// @file
/// Reads the skeleton of a captured motion from Acclaim's files: ASF.

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot_files/motion_capture.h>

namespace firstcontact {

/// What an ASF file says.
struct AsfSkeleton {
  MotionCapture figure;  ///< Without frames and frame time.
  /// Of each bone, the axes (0, 1, 2 for x, y, z) of the turns that a frame gives, in their order;
  /// of the root 0 ... 2 for positions, 3 ... 5 for turns.
  std::vector<std::vector<std::size_t>> channels;
  double unit_length = 1.0;  ///< [m]  Of one unit of length in the files.
  bool degrees = true;
  Pose root = {};  ///< Of the root bone at zero position and turns.
};

struct AsfOptions {
  /// [m]  What the file's unit `length` counts in: a number l there means that a coordinate of x is
  /// x / l of these. Inches, as of the motion capture laboratory of Carnegie Mellon University.
  double unit_length = 0.0254;
};

/// Reads an ASF file. A bone's axis says how its own frame is turned at zero; its turns about x, y
/// and z are those of its own frame, in the order of `dof`, the first one innermost. Bones without
/// `dof` are rigid in their parents. Limits and masses are passed over.
///
/// @throws ParseError  one line with path, line and what was expected: an axis order other than
///         XYZ, a dof other than rx, ry, rz, a bone that is not in the hierarchy, ...
/// @throws std::invalid_argument if an option is out of its range
[[nodiscard]] FIRSTCONTACT_API AsfSkeleton read_asf(const std::filesystem::path& path,
                                                    const AsfOptions& options = {});

/// @param source  names the text in errors
[[nodiscard]] FIRSTCONTACT_API AsfSkeleton parse_asf(std::string_view text,
                                                     const std::string& source,
                                                     const AsfOptions& options = {});

}  // namespace firstcontact
