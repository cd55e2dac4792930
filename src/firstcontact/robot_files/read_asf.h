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

/// The contents of an ASF file.
struct AsfSkeleton {
  MotionCapture figure;  ///< Without frames and frame time.
  /// The axes of the turns of each bone (0, 1, 2 for x, y, z), in the order of a frame's numbers.
  ///
  /// The root has 0 ... 2 for positions, 3 ... 5 for turns.
  std::vector<std::vector<std::size_t>> channels;
  double unit_length = 1.0;  ///< [m]  Length of one unit of the files.
  /// Whether angles of the files are in degrees, else in radians.
  bool degrees = true;
  Pose root = {};  ///< Pose of the root bone at zero position and turns.
};

/// The options of reading an ASF file.
struct AsfOptions {
  /// [m]  The length in which the file's unit `length` counts; an inch by default.
  ///
  /// With a `length` of l, a coordinate of x is x / l of these. Inches are those of the motion
  /// capture laboratory of Carnegie Mellon University.
  double unit_length = 0.0254;
};

/// Reads an ASF file.
///
/// A bone's axis gives the turn of its own frame at zero. The bone turns about x, y and z of that
/// frame, in the order of `dof`, the first turn innermost. Bones without `dof` are rigid in their
/// parents. The reader passes over limits and masses.
///
/// @throws ParseError  one line with path, line and what was expected: an axis order other than
///         XYZ, a dof other than rx, ry, rz, a bone that is not in the hierarchy, ...
/// @throws std::invalid_argument if an option is out of its range
[[nodiscard]] FIRSTCONTACT_API AsfSkeleton read_asf(const std::filesystem::path& path,
                                                    const AsfOptions& options = {});

/// Parses the text of an ASF file, as read_asf() reads it.
///
/// @param source  names the text in errors
[[nodiscard]] FIRSTCONTACT_API AsfSkeleton parse_asf(std::string_view text,
                                                     const std::string& source,
                                                     const AsfOptions& options = {});

}  // namespace firstcontact
