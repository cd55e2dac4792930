#include <firstcontact/haptics/detail/contact_coordinates.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Adds the displacement along an axis of a point of one tool.
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

/// Adds the displacement along an axis of a point of a link, by the joints on which it hangs.
void add_joint_rows(const Vector3d& axis, const Vector3d& point, const ToolFrames& frames,
                    double sign, int link, Coordinates& row) noexcept {
  while (link >= 0) {
    const auto at = static_cast<std::size_t>(link);
    const ToolLinks::Node& node = frames.links->nodes()[at];
    if (node.joint >= 0) {
      const auto joint = static_cast<std::size_t>(node.joint);
      row[frames.links->coordinate_of(joint)] +=
          sign * axis.dot(rate_with_joint(at, point, frames)) / frames.joint_weights[joint];
    }
    link = node.parent;
  }
}

}  // namespace

void weigh_joints(const ToolLinks& links, double stiffness_of_first_tool, ToolFrames& frames) {
  if (links.nodes().empty()) {
    return;
  }
  frames.links = &links;
  for (std::size_t joint = 0; joint < links.joints().size(); ++joint) {
    frames.joint_weights[joint] =
        std::sqrt(links.joints()[joint].stiffness / stiffness_of_first_tool);
  }
}

Vector3d rate_with_joint(std::size_t link, const Vector3d& point,
                         const ToolFrames& frames) noexcept {
  const ToolLinks::Node& node = frames.links->nodes()[link];
  const HapticAxis& axis = frames.axes[link];
  return node.turn * axis.direction.cross(point - axis.point) + node.slide * axis.direction;
}

bool has_limit(const HapticJoint& joint, double side) noexcept {
  return std::isfinite(side > 0.0 ? joint.lower : joint.upper);
}

ConeContact limit_of_joint(std::size_t joint, double side, const ToolFrames& frames) noexcept {
  const HapticJoint& limits = frames.links->joints()[joint];
  const double at = frames.joints[joint];
  ConeContact cone{.way = std::max(0.0, side > 0.0 ? at - limits.lower : limits.upper - at)};
  // In the unit of the joint, so that its `way` needs no weight.
  cone.rows[0][frames.links->coordinate_of(joint)] = side / frames.joint_weights[joint];
  return cone;
}

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

std::array<double, 3> shift_of_surface(const HapticContact& contact, double along_normal,
                                       double along_tangents) noexcept {
  const Vector3d velocity = contact_axes(contact.normal) * contact.surface_velocity;
  return {along_normal * velocity[0], along_tangents * velocity[1], along_tangents * velocity[2]};
}

ConeContact cone_contact(const HapticContact& contact, const ToolFrames& frames) noexcept {
  ConeContact cone{.way = contact.way, .friction = contact.friction};
  const Eigen::Matrix3d axes = contact_axes(contact.normal);
  const auto tool = static_cast<std::size_t>(contact.tool);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d axis = axes.row(static_cast<int>(k));
    if (contact.other != contact.tool) {  // For one tool the two rows cancel.
      add_point_row(axis, contact.point, frames, 1.0, tool, cone.rows[k]);
      if (contact.other >= 0) {
        const auto other = static_cast<std::size_t>(contact.other);
        add_point_row(axis, contact.point, frames, -1.0, other, cone.rows[k]);
      }
    }
    add_joint_rows(axis, contact.point, frames, 1.0, contact.link, cone.rows[k]);
    add_joint_rows(axis, contact.point, frames, -1.0, contact.other_link, cone.rows[k]);
  }
  return cone;
}

}  // namespace firstcontact::detail
