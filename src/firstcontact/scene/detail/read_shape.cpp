#include <firstcontact/scene/detail/read_shape.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include <firstcontact/scene/detail/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kPackage = "package://";

bool is_file(const std::filesystem::path& path) {
  // A NUL would end the name for the operating system, and another file would be opened.
  std::error_code error;
  return path.native().find('\0') == std::string::npos &&
         std::filesystem::is_regular_file(path, error);
}

std::filesystem::path find_in_packages(const JsonValue& value, const std::string& uri,
                                       const SceneFolders& folders, const JsonReader& read) {
  const std::string below = uri.substr(kPackage.size());
  for (const std::filesystem::path& root : folders.package_roots) {
    if (is_file(root / below)) {
      return root / below;
    }
  }
  if (folders.package_roots.empty()) {
    read.fail(value, "expected \"package_roots\" in the scene, to find " + in_quotes(uri));
  }
  read.fail(value, "expected a file, found " + in_quotes(uri) + " in none of the " +
                       std::to_string(folders.package_roots.size()) +
                       " package_roots (looked for " +
                       in_quotes((folders.package_roots.front() / below).string()) + ")");
}

std::filesystem::path read_mesh_path(const JsonValue& value, const SceneFolders& folders,
                                     const JsonReader& read) {
  const std::string& name = read.string(value, "the path of a mesh file");
  if (name.starts_with(kPackage)) {
    return find_in_packages(value, name, folders, read);
  }
  std::filesystem::path path = folders.scene / name;
  if (!is_file(path)) {
    read.fail(value, "expected a mesh file, found none at " + in_quotes(path.string()));
  }
  return path;
}

std::vector<Eigen::Vector3d> read_vertices(const JsonValue& value, const JsonReader& read) {
  std::vector<Eigen::Vector3d> vertices;
  for (const JsonValue& vertex : read.array(value, "an array of vertices [x, y, z]")) {
    vertices.push_back(read.vector3(vertex));
  }
  if (vertices.empty()) {
    read.fail(value, "expected at least one vertex, got none");
  }
  return vertices;
}

std::vector<std::array<std::uint32_t, 3>> read_triangles(const JsonValue& value,
                                                         std::size_t vertex_count,
                                                         const JsonReader& read) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const JsonValue& triangle : read.array(value, "an array of triangles [i, j, k]")) {
    const JsonArray& corners = read.array(triangle, "three vertex indices");
    if (corners.size() != 3) {
      read.fail_expected("three vertex indices", triangle);
    }
    std::array<std::uint32_t, 3>& indices = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      indices[i] =
          static_cast<std::uint32_t>(read.index(corners[i], vertex_count, "a vertex index"));
    }
  }
  if (triangles.empty()) {
    read.fail(value, "expected at least one triangle, got none (a point is a triangle [i, i, i])");
  }
  return triangles;
}

}  // namespace

BodyShape read_shape(const JsonValue& value, const SceneFolders& folders, const JsonReader& read) {
  const JsonObject& object =
      read.object(value, {{"mesh", "scale", "vertices", "triangles", "radius"},
                          {"sphere", "capsule", "box", "cylinder", "cone", "convex_hull", "points",
                           "heightmap", "solid"}});
  const JsonValue* mesh = find(object, "mesh");
  const JsonValue* scale = find(object, "scale");
  const JsonValue* vertices = find(object, "vertices");
  const JsonValue* triangles = find(object, "triangles");
  if ((mesh != nullptr) == (vertices != nullptr || triangles != nullptr)) {
    read.fail(value,
              std::string("expected either \"mesh\" or \"vertices\" with \"triangles\", got ") +
                  (mesh != nullptr ? "both" : "neither"));
  }
  if (mesh == nullptr && scale != nullptr) {
    read.fail(*scale, "expected \"scale\" beside \"mesh\" only");
  }
  BodyShape shape;
  if (mesh != nullptr) {
    shape.source = MeshFile{.path = read_mesh_path(*mesh, folders, read),
                            .scale = scale == nullptr ? 1.0 : read.positive(*scale)};
  } else {
    Mesh inline_mesh{.vertices = read_vertices(read.member(value, "vertices"), read),
                     .triangles = {}};
    inline_mesh.triangles =
        read_triangles(read.member(value, "triangles"), inline_mesh.vertices.size(), read);
    shape.source = std::move(inline_mesh);
  }
  if (const JsonValue* radius = find(object, "radius")) {
    shape.radius = read.not_negative(*radius);
  }
  return shape;
}

}  // namespace firstcontact::detail
