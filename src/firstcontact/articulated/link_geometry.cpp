#include <firstcontact/articulated/link_geometry.h>

#include <utility>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/mesh_files/read_mesh.h>

namespace firstcontact {
namespace {

MeshReading read_scaled(const MeshGeometry& file, const ReadingOptions& options) {
  MeshReading reading = read_mesh_file(file.path, options);
  Mesh& mesh = reading.mesh;
  if (file.scale != Eigen::Vector3d::Ones()) {
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      vertex = vertex.cwiseProduct(file.scale).eval();
    }
  }
  if (file.scale.prod() < 0.0) {
    for (auto& triangle : mesh.triangles) {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return reading;
}

/// A shape of each kind; the overloads are picked by std::visit.
struct ShapeReader {
  const ReadingOptions& options;

  ShapeReading operator()(const MeshGeometry& file) const {
    MeshReading reading = read_scaled(file, options);
    return {Shape(std::move(reading.mesh)), std::move(reading.report)};
  }
  ShapeReading operator()(const BoxGeometry& box) const { return {make_box(box.size), {}}; }
  ShapeReading operator()(const SphereGeometry& sphere) const {
    return {make_sphere(sphere.radius), {}};
  }
  ShapeReading operator()(const CylinderGeometry& cylinder) const {
    return {make_cylinder(cylinder.radius, cylinder.length), {}};
  }
  ShapeReading operator()(const CapsuleGeometry& capsule) const {
    return {make_capsule(capsule.radius, capsule.length), {}};
  }
};

}  // namespace

Shape make_shape(const GeometrySource& source) { return read_shape(source).shape; }

ShapeReading read_shape(const GeometrySource& source, const ReadingOptions& options) {
  return std::visit(ShapeReader{options}, source);
}

}  // namespace firstcontact
