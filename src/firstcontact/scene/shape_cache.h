/// @file
/// Shapes and robots of scenes, kept from scene to scene.

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/scene/body_shape.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

struct Hierarchy;
struct RobotFile;

/// A shape and the digest of the file that it came from.
struct CachedShape {
  Shape shape;
  std::string digest;  ///< SHA-256 of its files, in hexadecimal; empty where there is none.
  std::shared_ptr<const FileReport> report = {};  ///< The report on the file; null where there is
                                                  ///< none.
};

/// A robot with the shapes of what can touch, and the digest of all its files.
struct CachedRobot {
  RobotModel model;
  std::string digest;                                         ///< SHA-256, in hexadecimal.
  std::shared_ptr<const std::vector<FileReport>> files = {};  ///< As RobotReading::files.
};

/// A cache that makes each shape once, with its hierarchy, except for inline geometry of a scene.
///
/// A file that changes after it was loaded is not read again. Thread-safe: a thread that needs a
/// shape that another thread is making waits for it. Different shapes are made side by side.
class FIRSTCONTACT_API ShapeCache {
 public:
  /// Makes or finds the shape that a scene describes.
  ///
  /// Coordinates of files are scaled in double precision. Certificates hold for the rounded
  /// products.
  ///
  /// @throws ParseError as read_mesh, and where no shape can be made of the file
  /// @throws std::invalid_argument if a number is out of its range, or an inline solid not closed
  CachedShape load(const BodyShape& shape, const ReadingOptions& options = {});

  /// Reads or finds a robot of a file, with the collision geometry of the surface that was asked
  /// for.
  ///
  /// @throws ParseError as read_urdf, and where the surface has no geometry at all
  CachedRobot load(const RobotFile& file, const ReadingOptions& options = {});

  /// Whether a shape's mesh is closed and its triangles agree on their inner side.
  ///
  /// It is computed once for each shape of a file.
  ///
  /// @param source  the shape's description in a body; null for that of a link
  bool encloses_space(const Shape& shape, const BodyShape* source);

 private:
  /// The kind of shape, the file, and the bits of all numbers of an entry.
  using Key = std::tuple<std::size_t, std::string, std::vector<std::uint64_t>>;

  struct Entry {
    std::mutex making;
    std::optional<CachedShape> shape;  // None before, or where it cannot be made.
  };

  /// The surface, whether readers are lenient, and the paths of an entry.
  using RobotKey = std::tuple<RobotSurface, bool, std::vector<std::filesystem::path>>;

  struct RobotEntry {
    std::mutex making;
    std::optional<CachedRobot> robot;
  };

  std::mutex mutex_;  // Guards the maps; their entries stay where they are.
  std::map<Key, Entry> shapes_;
  std::map<RobotKey, RobotEntry> robots_;
  /// The answers by the address of the shape's hierarchy; the cache holds these shapes.
  std::map<const Hierarchy*, bool> encloses_space_;
};

}  // namespace firstcontact
