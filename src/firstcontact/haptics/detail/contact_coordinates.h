/// @file
/// A contact of tools in the coordinates of their displacement.

#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/haptics/contact_set.h>
#include <firstcontact/haptics/detail/cone_projection.h>

namespace firstcontact::detail {

/// Where the tools are, and how much turning them counts.
struct ToolFrames {
  std::array<Eigen::Vector3d, kMostTools> p_WC = {};  ///< [m]  Centres.
  /// [m]  A turn by an angle counts as much as a way of this length times the angle.
  std::array<double, kMostTools> lengths = {};
  /// [-]  All coordinates of a tool are so many times larger: the root of its stiffness by that of
  /// the first.
  std::array<double, kMostTools> weights = {1.0, 1.0};
};

/// The rows of a contact. Its normal and two tangents make a rotation.
///
/// @param seconds  since the contact was found: so far the surroundings have gone on
[[nodiscard]] ConeContact cone_contact(const HapticContact& contact, const ToolFrames& frames,
                                       double seconds) noexcept;

/// The rows of a contact's normal and two tangents, world axes.
[[nodiscard]] Eigen::Matrix3d contact_axes(const Eigen::Vector3d& normal) noexcept;

}  // namespace firstcontact::detail
