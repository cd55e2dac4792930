#include <firstcontact/scene/detail/make_shape.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/read_mesh.h>
#include <firstcontact/geometry/read_points.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact::detail {
namespace {

void scale(std::vector<Eigen::Vector3d>& points, double factor) {
  if (factor != 1.0) {
    for (Eigen::Vector3d& point : points) {
      point *= factor;
    }
  }
}

/// The vertices that triangles use.
std::vector<Eigen::Vector3d> used_vertices(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      used[v] = true;
    }
  }
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) {
      vertices.push_back(mesh.vertices[v]);
    }
  }
  return vertices;
}

Mesh read_scaled(const MeshFile& file) {
  Mesh mesh = read_mesh(file.path);
  scale(mesh.vertices, file.scale);
  return mesh;
}

/// A shape of each kind; the overloads are picked by std::visit.
struct ShapeMaker {
  double radius;
  Filling filling;
  double enclosure_error;

  Shape operator()(const MeshFile& file) const { return Shape(read_scaled(file), radius, filling); }

  Shape operator()(const Mesh& mesh) const { return Shape(mesh, radius, filling, enclosure_error); }

  Shape operator()(const SphereShape& sphere) const { return make_sphere(sphere.radius); }

  Shape operator()(const CapsuleShape& capsule) const {
    return make_capsule(capsule.radius, capsule.length);
  }

  Shape operator()(const BoxShape& box) const { return make_box(box.size); }

  Shape operator()(const CylinderShape& cylinder) const {
    return make_cylinder(cylinder.radius, cylinder.length, cylinder.enclosure_error);
  }

  Shape operator()(const ConeShape& cone) const {
    return make_cone(cone.radius, cone.length, cone.enclosure_error);
  }

  Shape operator()(const ConvexHullShape& hull) const {
    const auto* file = std::get_if<MeshFile>(&hull.of);
    return make_convex_hull(file != nullptr ? used_vertices(read_scaled(*file))
                                            : std::get<std::vector<Eigen::Vector3d>>(hull.of),
                            radius);
  }

  Shape operator()(const PointFile& file) const {
    std::vector<Eigen::Vector3d> points = read_points(file.path);
    scale(points, file.scale);
    return make_point_cloud(std::move(points), radius);
  }

  Shape operator()(const PointCloud& cloud) const { return make_point_cloud(cloud.points, radius); }

  Shape operator()(const HeightFile& file) const {
    return make_height_map(read_heights(file.path, file.cell), radius);
  }

  Shape operator()(const HeightMap& map) const { return make_height_map(map, radius); }

  Shape operator()(const Shape& ready) const { return ready; }
};

}  // namespace

const std::filesystem::path* file_of(const BodyShape& shape) {
  const auto* hull = std::get_if<ConvexHullShape>(&shape.source);
  const MeshFile* mesh =
      hull != nullptr ? std::get_if<MeshFile>(&hull->of) : std::get_if<MeshFile>(&shape.source);
  if (mesh != nullptr) {
    return &mesh->path;
  }
  if (const auto* points = std::get_if<PointFile>(&shape.source)) {
    return &points->path;
  }
  const auto* heights = std::get_if<HeightFile>(&shape.source);
  return heights != nullptr ? &heights->path : nullptr;
}

Shape make_shape(const BodyShape& shape) {
  const std::filesystem::path* file = file_of(shape);
  try {
    return std::visit(ShapeMaker{shape.radius, shape.filling, shape.enclosure_error}, shape.source);
  } catch (const std::invalid_argument& error) {
    if (file == nullptr) {
      throw;
    }
    throw ParseError(file->string(), error.what());
  }
}

}  // namespace firstcontact::detail
