/// @file
/// Reads robots from URDF.

#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// The shapes that are made while reading; the others stay descriptions.
enum class LoadShapes {
  none,
  collision,  ///< Shapes of the geometry that can touch.
  all,
};

/// The geometry of a robot that can touch.
enum class RobotSurface {
  collision,
  visual,
  collision_or_visual,  ///< Collision geometry; for a link without any its visual geometry.
};

/// The words of RobotSurface in files and in Python, in this order.
inline constexpr std::array<const char*, 3> kRobotSurfaceWords{"collision", "visual",
                                                               "collision_or_visual"};

/// The options of reading a URDF file.
struct UrdfOptions {
  /// Folders that hold packages: `package://NAME/rest` is ROOT/NAME/rest of the first that has it.
  ///
  /// Behind them come the package NAME that holds the URDF, and all folders above.
  std::vector<std::filesystem::path> package_roots = {};
  LoadShapes shapes = LoadShapes::collision;
  RobotSurface surface = RobotSurface::collision;  ///< The geometry that becomes the collision
                                                   ///< geometry of links.
  ReadingOptions reading = {};
};

/// A robot and the reports on its files.
struct RobotReading {
  RobotModel model;
  std::vector<FileReport> files;  ///< The URDF, then its meshes in the order of their first use.
};

/// Reads a URDF file. Each mesh file is read once for each scale.
///
/// Beyond URDF 1.2 the reader knows joints of type `screw` (with an attribute `pitch` [m/rad] of
/// the joint) and `ball` or `spherical`. It also knows Drake's `<drake:capsule>` and
/// `<drake:mimic>`.
///
/// Elements that do not matter for contacts are left out by name: looks, settings of simulators and
/// controllers, and sensors. So are elements and attributes with a prefix, and an `<inertial>` that
/// is wrong (LinkInertia::defect). An unknown name is an error where it is near a known one, holds
/// or places geometry, or is xacro's. Elsewhere it is a warning. docs/robot_files.md has the table.
///
/// Numbers are read exactly, whatever the locale. An `rpy` becomes a quaternion of doubles, which
/// from then on means the exact rotation.
///
/// @throws ParseError  one line with path, place, element and what was expected, for all errors
[[nodiscard]] FIRSTCONTACT_API RobotReading read_robot(const std::filesystem::path& path,
                                                       const UrdfOptions& options = {});

/// Parses the text of a URDF file, as read_robot() reads it.
///
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
