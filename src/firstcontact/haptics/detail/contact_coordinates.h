/// @file
/// A contact of tools in the coordinates of their displacement.

#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/cone_projection.h>
#include <firstcontact/haptics/detail/tool_links.h>

namespace firstcontact::detail {

/// The places of the tools, and the weights of their turns.
struct ToolFrames {
  /// [m]  Centres of the tools.
  std::array<Eigen::Vector3d, kMostTools> p_WC = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  /// [m]  A turn by an angle counts as much as a displacement of this length times the angle.
  std::array<double, kMostTools> lengths = {};
  /// [-]  Factor of all coordinates of a tool: the root of its stiffness by that of the first.
  std::array<double, kMostTools> weights = {1.0, 1.0};
  const ToolLinks* links = nullptr;                    ///< Null where no tool has joints.
  std::array<HapticAxis, kMostHapticLinks> axes = {};  ///< Axes of the joints of the links.
  std::array<double, kMostHapticJoints> joints = {};   ///< [rad or m]  Positions of the joints.
  /// [m/rad or -]  Factor of the coordinate of a joint: the root of its stiffness by that of the
  /// first tool.
  std::array<double, kMostHapticJoints> joint_weights = {};

  [[nodiscard]] std::size_t joint_count() const {
    return links == nullptr ? 0 : links->joints().size();
  }
  [[nodiscard]] std::size_t coordinates(std::size_t tools) const {
    return 6 * tools + joint_count();
  }
};

/// Sets the links and the weights of joints; `links` outlives the frames.
void weigh_joints(const ToolLinks& links, double stiffness_of_first_tool, ToolFrames& frames);

/// Computes the rows of a contact. Its normal and two tangents make a rotation.
///
/// The surface is where the contact was found.
[[nodiscard]] ConeContact cone_contact(const HapticContact& contact,
                                       const ToolFrames& frames) noexcept;

/// [m]  Computes the shift of the surface of a contact (ConeContact::shift).
///
/// @param along_normal  [s]  time for which it has moved on along the normal...
/// @param along_tangents  [s]  ...and along the tangents
[[nodiscard]] std::array<double, 3> shift_of_surface(const HapticContact& contact,
                                                     double along_normal,
                                                     double along_tangents) noexcept;

/// Makes the constraint that keeps a joint within a limit.
///
/// @param side  1 for the lower limit, -1 for the upper one
[[nodiscard]] ConeContact limit_of_joint(std::size_t joint, double side,
                                         const ToolFrames& frames) noexcept;

/// Whether a limit of a joint is finite.
[[nodiscard]] bool has_limit(const HapticJoint& joint, double side) noexcept;

/// [m, m/rad ...]  Computes the rate of a point of a link with the joint of that link, or of one on
/// which it hangs.
[[nodiscard]] Eigen::Vector3d rate_with_joint(std::size_t link, const Eigen::Vector3d& point,
                                              const ToolFrames& frames) noexcept;

/// Computes the rows of a contact's normal and two tangents, world axes.
[[nodiscard]] Eigen::Matrix3d contact_axes(const Eigen::Vector3d& normal) noexcept;

}  // namespace firstcontact::detail
