#include <firstcontact/geometry/deforming_body.h>

#include <cstdint>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact {
namespace {

/// Estimates how far the middle of the box around the used vertices moves. Any vector is right: the
/// vertices move by the difference.
Eigen::Vector3d shared_translation(const Shape& shape, std::span<const Eigen::Vector3d> to) {
  Eigen::AlignedBox3d box;
  for (const std::uint32_t v : shape.hierarchy().vertex_index) {
    if (v < to.size()) {  // Shape::deforming refuses the rest.
      box.extend(to[v]);
    }
  }
  const Eigen::Vector3d translation = box.center() - shape.hierarchy().centre;
  return box.isEmpty() || !translation.allFinite() ? Eigen::Vector3d(0, 0, 0) : translation;
}

}  // namespace

DeformingBody move_vertices(const Shape& shape, std::span<const Eigen::Vector3d> to) {
  const Eigen::Vector3d translation = shared_translation(shape, to);
  return {shape.deforming(to, translation), Motion::constant_velocity(Pose{}, translation)};
}

}  // namespace firstcontact
