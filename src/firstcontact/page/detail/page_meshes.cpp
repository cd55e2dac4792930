#include <firstcontact/page/detail/page_meshes.h>

#include <array>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/page/page_numbers.h>
#include <firstcontact/robot_files/link_shape.h>
#include <firstcontact/scene_files/detail/result_json.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Most vertices of a mesh whose corners have two bytes.
constexpr std::size_t kShortIndices = 65'536;

/// Writes a mesh with vertices relative to the middle: so single precision suffices far from the
/// origin, too.
JsonObject mesh_to_json(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  const Eigen::Vector3d middle = box.center();
  PageNumbers positions;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (const double coordinate : Eigen::Vector3d(vertex - middle)) {
      positions.add(static_cast<float>(coordinate));
    }
  }
  PageNumbers triangles;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      triangles.add(corner, mesh.vertices.size() <= kShortIndices ? 2 : 4);
    }
  }
  return {{"origin", to_json(middle)},
          {"positions", {.value = positions.base64()}},
          {"triangles", {.value = triangles.base64()}}};
}

/// The key of a geometry's file; empty where the geometry is of no file.
std::string key_of(const LinkGeometry& geometry) {
  const auto* file = std::get_if<MeshGeometry>(&geometry.source);
  return file == nullptr || file->path.empty()
             ? ""
             : write_json(to_json(file->scale)) + file->path.string();
}

}  // namespace

std::size_t PageMeshes::append(const Shape& shape) {
  JsonObject mesh = mesh_to_json(shape.mesh());
  if (shape.is_curved()) {
    mesh.push_back({"smooth", {.value = true}});
  }
  // Spheres and capsules have one triangle, of equal corners.
  const bool is_solid = shape.mesh().triangles.size() > 1;
  if (is_solid && shape.radius() > 0.0 && shape.convex_set() != nullptr) {
    mesh.push_back({"convex", {.value = true}});
  }
  meshes_.push_back({.value = std::move(mesh)});
  return meshes_.size() - 1;
}

std::size_t PageMeshes::add(const Shape& shape) {
  const Mesh* mesh = &shape.mesh();
  const auto found = of_objects_.find(mesh);
  return found != of_objects_.end() ? found->second : of_objects_[mesh] = append(shape);
}

std::size_t PageMeshes::add(const LinkGeometry& geometry) {
  const std::string key = key_of(geometry);
  if (const auto found = of_files_.find(key); found != of_files_.end()) {
    return found->second;
  }
  const std::size_t index = append(geometry.shape ? *geometry.shape : make_shape(geometry.source));
  if (!key.empty()) {
    of_files_[key] = index;
  }
  return index;
}

JsonArray PageMeshes::take() { return std::exchange(meshes_, {}); }

}  // namespace firstcontact::detail
