#include <firstcontact/articulated/link_geometry.h>

#include <utility>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/read_mesh.h>

namespace firstcontact {
namespace {

Mesh read_scaled(const MeshGeometry& file) {
  Mesh mesh = read_mesh(file.path);
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
  return mesh;
}

/// A shape of each kind; the overloads are picked by std::visit.
struct ShapeMaker {
  Shape operator()(const MeshGeometry& file) const { return Shape(read_scaled(file)); }
  Shape operator()(const BoxGeometry& box) const { return make_box(box.size); }
  Shape operator()(const SphereGeometry& sphere) const { return make_sphere(sphere.radius); }
  Shape operator()(const CylinderGeometry& cylinder) const {
    return make_cylinder(cylinder.radius, cylinder.length);
  }
  Shape operator()(const CapsuleGeometry& capsule) const {
    return make_capsule(capsule.radius, capsule.length);
  }
};

}  // namespace

Shape make_shape(const GeometrySource& source) { return std::visit(ShapeMaker{}, source); }

}  // namespace firstcontact
