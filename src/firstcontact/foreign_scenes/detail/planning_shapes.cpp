#include <firstcontact/foreign_scenes/detail/planning_shapes.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/trajectory_files/detail/ros_message.h>

namespace firstcontact::detail {
namespace {

std::vector<double> dimensions(const JsonValue& value, const JsonReader& read,
                               const std::vector<std::string_view>& names) {
  const JsonValue& list = read.member(value, "dimensions");
  std::vector<double> numbers;
  for (const JsonValue& element : read.array(list, "an array of lengths")) {
    numbers.push_back(read.positive(element));
  }
  if (numbers.size() != names.size()) {
    read.fail(list,
              "expected " + listed(names) + ", got " + std::to_string(numbers.size()) + " numbers");
  }
  return numbers;
}

double scale_of(const JsonValue& mesh, const JsonReader& read) {
  const JsonValue* scale = find_filled(mesh, "dimensions");
  if (scale == nullptr) {
    return 1.0;
  }
  const Eigen::Vector3d factors = read_point(*scale, read);
  if (!(factors.x() > 0.0 && factors.x() == factors.y() && factors.x() == factors.z())) {
    read.fail(*scale, "expected three equal factors > 0");
  }
  return factors.x();
}

std::array<std::uint32_t, 3> corners(const JsonValue& triangle, std::size_t count,
                                     const JsonReader& read) {
  const JsonValue* named = find_filled(triangle, "vertex_indices");
  const JsonValue& list = named != nullptr ? *named : triangle;
  const JsonArray& indices = read.array(list, "three vertex indices");
  if (indices.size() != 3) {
    read.fail_expected("three vertex indices", list);
  }
  std::array<std::uint32_t, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = static_cast<std::uint32_t>(
        read.index(indices[k], std::max<std::size_t>(count, 1), "a vertex index"));
  }
  return result;
}

}  // namespace

BodyShape read_primitive(const JsonValue& value, const JsonReader& read) {
  (void)read.object(value, {{"type", "dimensions", "polygon"}});
  const JsonValue& type = read.member(value, "type");
  const bool is_number = std::holds_alternative<double>(type.value);
  const std::size_t kind = is_number ? read.index(type, 5, "a type of primitive")
                                     : 1 + read.word(type, {{"box", "sphere", "cylinder", "cone"}});
  switch (kind) {
    case 1: {
      const std::vector<double> size = dimensions(value, read, {"x", "y", "z"});
      return {.source = BoxShape{{size[0], size[1], size[2]}}};
    }
    case 2:
      return {.source = SphereShape{dimensions(value, read, {"radius"})[0]}};
    case 3: {
      const std::vector<double> size = dimensions(value, read, {"height", "radius"});
      return {.source = CylinderShape{.radius = size[1], .length = size[0], .enclosure_error = {}}};
    }
    case 4: {
      const std::vector<double> size = dimensions(value, read, {"height", "radius"});
      return {.source = ConeShape{.radius = size[1], .length = size[0], .enclosure_error = {}}};
    }
    default:
      read.fail_expected("1 (box), 2 (sphere), 3 (cylinder) or 4 (cone)", type);
  }
}

BodyShape read_message_mesh(const JsonValue& value, const SceneFolders& folders,
                            const JsonReader& read) {
  (void)read.object(value, {{"triangles", "vertices", "resource", "dimensions"}});
  if (const JsonValue* resource = find_filled(value, "resource")) {
    return {.source = MeshFile{read_path(*resource, "a mesh file", folders, read),
                               scale_of(value, read)}};
  }
  Mesh mesh;
  for (const JsonValue& vertex :
       read.array(read.member(value, "vertices"), "an array of vertices")) {
    mesh.vertices.push_back(read_point(vertex, read));
  }
  const JsonValue& triangles = read.member(value, "triangles");
  for (const JsonValue& triangle : read.array(triangles, "an array of triangles")) {
    mesh.triangles.push_back(corners(triangle, mesh.vertices.size(), read));
  }
  if (mesh.triangles.empty()) {
    read.fail(triangles, "expected at least one triangle, got none");
  }
  return {.source = std::move(mesh)};
}

}  // namespace firstcontact::detail
