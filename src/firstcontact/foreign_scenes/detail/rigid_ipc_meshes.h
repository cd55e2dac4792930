/// @file
/// The meshes of a fixture of Rigid IPC.

#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Finds and reads meshes, each file once.
class RigidIpcMeshes {
 public:
  /// Begins without meshes.
  ///
  /// @param fixture  the file that names the meshes
  explicit RigidIpcMeshes(std::filesystem::path fixture) : fixture_(std::move(fixture)) {}

  /// Finds the file of a name: beside the fixture, or in a folder `meshes` of a folder above it.
  ///
  /// @throws ParseError that lists the places where it looked
  [[nodiscard]] std::filesystem::path find(const JsonValue& name, const JsonReader& read) const;

  /// Loads a mesh, welded. A file of vertices alone is a cloud of points.
  ///
  /// @throws ParseError
  const Mesh& load(const std::filesystem::path& path);

  /// Lists SHA-256 of the files that were read, a line for each.
  [[nodiscard]] std::string digests() const;

  /// Lists the files that were read.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

 private:
  struct Loaded {
    Mesh mesh;
    std::string digest;
  };

  std::filesystem::path fixture_;
  std::map<std::filesystem::path, Loaded> loaded_;
};

/// [m]  Computes the size of a mesh along each axis.
[[nodiscard]] Eigen::Vector3d extent(const Mesh& mesh);

/// Scales a mesh.
///
/// @param factors  for x, y, z
[[nodiscard]] Mesh scaled(Mesh mesh, const Eigen::Vector3d& factors);

[[nodiscard]] Mesh moved(Mesh mesh, const Eigen::Vector3d& translation);

/// Splits a mesh into the sets of triangles that share vertices, each a mesh of its own.
[[nodiscard]] std::vector<Mesh> split_components(const Mesh& mesh);

}  // namespace firstcontact::detail
