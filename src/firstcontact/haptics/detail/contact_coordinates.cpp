#include <firstcontact/haptics/detail/contact_coordinates.h>

#include <cmath>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Adds the displacement along an axis of the point of one tool.
void add_point_row(const Vector3d& axis, const Vector3d& point, const ToolFrames& frames,
                   double sign, std::size_t tool, Coordinates& row) noexcept {
  const Vector3d turn = (point - frames.p_WC[tool]).cross(axis) / frames.lengths[tool];
  const double factor = sign / frames.weights[tool];
  for (int k = 0; k < 3; ++k) {
    const auto at = 6 * tool + static_cast<std::size_t>(k);
    row[at] = factor * axis[k];
    row[at + 3] = factor * turn[k];
  }
}

}  // namespace

Eigen::Matrix3d contact_axes(const Vector3d& normal) noexcept {
  int least = 0;
  normal.cwiseAbs().minCoeff(&least);
  const Vector3d first = normal.cross(Vector3d::Unit(least)).normalized();
  Eigen::Matrix3d axes;
  axes.row(0) = normal;
  axes.row(1) = first;
  axes.row(2) = normal.cross(first);
  return axes;
}

ConeContact cone_contact(const HapticContact& contact, const ToolFrames& frames,
                         double seconds) noexcept {
  ConeContact cone{.way = contact.way, .friction = contact.friction};
  const Eigen::Matrix3d axes = contact_axes(contact.normal);
  const auto tool = static_cast<std::size_t>(contact.tool);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d axis = axes.row(static_cast<int>(k));
    add_point_row(axis, contact.point, frames, 1.0, tool, cone.rows[k]);
    if (contact.other >= 0) {
      const auto other = static_cast<std::size_t>(contact.other);
      add_point_row(axis, contact.point, frames, -1.0, other, cone.rows[k]);
    }
    cone.shift[k] = seconds * axis.dot(contact.surface_velocity);
  }
  return cone;
}

}  // namespace firstcontact::detail
