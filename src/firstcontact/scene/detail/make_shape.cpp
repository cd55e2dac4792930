#include <firstcontact/scene/detail/make_shape.h>

#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include <firstcontact/geometry/parse_error.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/read_mesh.h>

namespace firstcontact::detail {
namespace {

void scale(std::vector<Eigen::Vector3d>& points, double factor) {
  if (factor != 1.0) {
    for (Eigen::Vector3d& point : points) {
      point *= factor;
    }
  }
}

/// A shape of each kind; the overloads are picked by std::visit.
struct ShapeMaker {
  double radius;
  Filling filling;

  Shape operator()(const MeshFile& file) const {
    Mesh mesh = read_mesh(file.path);
    scale(mesh.vertices, file.scale);
    return Shape(std::move(mesh), radius, filling);
  }

  Shape operator()(const Mesh& mesh) const { return Shape(mesh, radius, filling); }

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
};

}  // namespace

const std::filesystem::path* file_of(const BodyShape& shape) {
  const auto* mesh = std::get_if<MeshFile>(&shape.source);
  return mesh != nullptr ? &mesh->path : nullptr;
}

Shape make_shape(const BodyShape& shape) {
  const std::filesystem::path* file = file_of(shape);
  try {
    return std::visit(ShapeMaker{shape.radius, shape.filling}, shape.source);
  } catch (const std::invalid_argument& error) {
    if (file == nullptr) {
      throw;
    }
    throw ParseError(file->string(), error.what());
  }
}

}  // namespace firstcontact::detail
