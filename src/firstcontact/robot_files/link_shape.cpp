#include <firstcontact/robot_files/link_shape.h>

#include <algorithm>
#include <array>
#include <cstddef>
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

Shape make_point() { return Shape({.vertices = {{0.0, 0.0, 0.0}}, .triangles = {{0, 0, 0}}}); }

/// Makes a segment along z, about the origin.
Shape make_segment(double length) {
  if (length == 0.0) {
    return make_point();
  }
  return Shape(Mesh{.vertices = {{0.0, 0.0, -0.5 * length}, {0.0, 0.0, 0.5 * length}},
                    .triangles = {{0, 1, 1}}});
}

/// Flattens a shape: the chosen coordinates of every vertex become 0.
///
/// The shape is a box of size 1 along them, or a cylinder of length 1.
Shape flattened(const Shape& thick, const std::array<bool, 3>& flat) {
  Mesh mesh = thick.mesh();
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    for (std::size_t axis = 0; axis < flat.size(); ++axis) {
      vertex[static_cast<int>(axis)] = flat[axis] ? 0.0 : vertex[static_cast<int>(axis)];
    }
  }
  return Shape(std::move(mesh), 0.0, Filling::surface, thick.enclosure_error());
}

Shape make_any_box(const Eigen::Vector3d& size) {
  const std::array<bool, 3> flat{size.x() == 0.0, size.y() == 0.0, size.z() == 0.0};
  if (std::none_of(flat.begin(), flat.end(), [](bool is_flat) { return is_flat; })) {
    return make_box(size);
  }
  Eigen::Vector3d thick = size;
  for (std::size_t axis = 0; axis < flat.size(); ++axis) {
    thick[static_cast<int>(axis)] = flat[axis] ? 1.0 : thick[static_cast<int>(axis)];
  }
  return flattened(make_box(thick), flat);
}

Shape make_any_cylinder(double radius, double length) {
  if (radius == 0.0) {
    return make_segment(length);
  }
  return length == 0.0 ? flattened(make_cylinder(radius, 1.0), {false, false, true})
                       : make_cylinder(radius, length);
}

/// A shape of each kind; the overloads are picked by std::visit.
struct ShapeReader {
  const ReadingOptions& options;

  ShapeReading operator()(const MeshGeometry& file) const {
    MeshReading reading = read_scaled(file, options);
    return {Shape(std::move(reading.mesh)), std::move(reading.report)};
  }
  ShapeReading operator()(const BoxGeometry& box) const { return {make_any_box(box.size), {}}; }
  ShapeReading operator()(const SphereGeometry& sphere) const {
    return {sphere.radius == 0.0 ? make_point() : make_sphere(sphere.radius), {}};
  }
  ShapeReading operator()(const CylinderGeometry& cylinder) const {
    return {make_any_cylinder(cylinder.radius, cylinder.length), {}};
  }
  ShapeReading operator()(const CapsuleGeometry& capsule) const {
    return {capsule.radius == 0.0 ? make_segment(capsule.length)
                                  : make_capsule(capsule.radius, capsule.length),
            {}};
  }
};

}  // namespace

Shape make_shape(const GeometrySource& source) { return read_shape(source).shape; }

ShapeReading read_shape(const GeometrySource& source, const ReadingOptions& options) {
  return std::visit(ShapeReader{options}, source);
}

}  // namespace firstcontact
