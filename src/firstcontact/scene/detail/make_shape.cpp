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
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/mesh_files/read_points.h>
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

MeshReading read_scaled(const MeshFile& file, const ReadingOptions& options) {
  MeshReading reading = read_mesh_file(file.path, options);
  scale(reading.mesh.vertices, file.scale);
  return reading;
}

/// Makes a shape of each kind; the overloads are picked by std::visit.
struct ShapeMaker {
  double radius;
  Filling filling;
  double enclosure_error;
  const ReadingOptions& options;

  ShapeReading operator()(const MeshFile& file) const {
    MeshReading reading = read_scaled(file, options);
    return {Shape(std::move(reading.mesh), radius, filling), std::move(reading.report)};
  }

  ShapeReading operator()(const Mesh& mesh) const {
    return {Shape(mesh, radius, filling, enclosure_error), {}};
  }

  ShapeReading operator()(const SphereShape& sphere) const {
    return {make_sphere(sphere.radius), {}};
  }

  ShapeReading operator()(const CapsuleShape& capsule) const {
    return {make_capsule(capsule.radius, capsule.length), {}};
  }

  ShapeReading operator()(const BoxShape& box) const { return {make_box(box.size, radius), {}}; }

  ShapeReading operator()(const CylinderShape& cylinder) const {
    return {make_cylinder(cylinder.radius, cylinder.length, cylinder.enclosure_error), {}};
  }

  ShapeReading operator()(const ConeShape& cone) const {
    return {make_cone(cone.radius, cone.length, cone.enclosure_error), {}};
  }

  ShapeReading operator()(const EllipsoidShape& ellipsoid) const {
    return {make_ellipsoid(ellipsoid.radii, ellipsoid.enclosure_error), {}};
  }

  ShapeReading operator()(const ConvexHullShape& hull) const {
    const auto* file = std::get_if<MeshFile>(&hull.of);
    if (file == nullptr) {
      return {make_convex_hull(std::get<std::vector<Eigen::Vector3d>>(hull.of), radius), {}};
    }
    MeshReading reading = read_scaled(*file, options);
    return {make_convex_hull(used_vertices(reading.mesh), radius), std::move(reading.report)};
  }

  ShapeReading operator()(const PointFile& file) const {
    PointReading reading = read_points_file(file.path, options);
    scale(reading.points, file.scale);
    return {make_point_cloud(std::move(reading.points), radius), std::move(reading.report)};
  }

  ShapeReading operator()(const PointCloud& cloud) const {
    return {make_point_cloud(cloud.points, radius), {}};
  }

  ShapeReading operator()(const HeightFile& file) const {
    return {make_height_map(read_heights(file.path, file.cell), radius), {}};
  }

  ShapeReading operator()(const HeightMap& map) const { return {make_height_map(map, radius), {}}; }

  ShapeReading operator()(const Shape& ready) const { return {ready, {}}; }
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

ShapeReading make_shape(const BodyShape& shape, const ReadingOptions& options) {
  const std::filesystem::path* file = file_of(shape);
  try {
    return std::visit(ShapeMaker{shape.radius, shape.filling, shape.enclosure_error, options},
                      shape.source);
  } catch (const std::invalid_argument& error) {
    if (file == nullptr) {
      throw;
    }
    throw ParseError(file->string(), error.what());
  }
}

}  // namespace firstcontact::detail
