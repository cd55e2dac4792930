/// @file
/// Reads robots from URDF.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/articulated/robot_model.h>
#include <firstcontact/math/export.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// Which shapes are made while reading; the others stay descriptions.
enum class LoadShapes { none, collision, all };

struct UrdfOptions {
  /// Folders that hold packages: `package://NAME/rest` is ROOT/NAME/rest, of the first root that
  /// has NAME; then of the folders above the file.
  std::vector<std::filesystem::path> package_roots = {};
  LoadShapes shapes = LoadShapes::collision;
  ReadingOptions reading = {};
};

/// A robot and what became of its files.
struct RobotReading {
  RobotModel model;
  std::vector<FileReport> files;  ///< The URDF, then its meshes in the order of their first use.
};

/// Reads a URDF file. Each mesh file is read once for each scale.
///
/// Beyond URDF: joints of type `screw` (with an attribute `pitch` [m/rad] of the joint) and `ball`
/// or `spherical`, and `<capsule radius length>`, its length without the caps. Inertia, materials,
/// dynamics and what is outside of links and joints is passed over. Inside of them a name that
/// URDF does not know is an error: a misspelt `<collision>` must not mean "cannot collide".
///
/// Numbers are read exactly, whatever the locale. An `rpy` becomes a quaternion of doubles, which
/// from then on means the exact rotation.
///
/// @throws ParseError  one line with path, place, element and what was expected
[[nodiscard]] FIRSTCONTACT_API RobotReading read_robot(const std::filesystem::path& path,
                                                       const UrdfOptions& options = {});

/// @param source  names the text in errors; mesh paths are relative to its folder
[[nodiscard]] FIRSTCONTACT_API RobotReading parse_robot(std::string_view text,
                                                        const std::filesystem::path& source,
                                                        const UrdfOptions& options = {});

/// The model of read_robot() alone.
[[nodiscard]] FIRSTCONTACT_API RobotModel read_urdf(const std::filesystem::path& path,
                                                    const UrdfOptions& options = {});

/// The model of parse_robot() alone.
[[nodiscard]] FIRSTCONTACT_API RobotModel parse_urdf(std::string_view text,
                                                     const std::filesystem::path& source,
                                                     const UrdfOptions& options = {});

}  // namespace firstcontact
