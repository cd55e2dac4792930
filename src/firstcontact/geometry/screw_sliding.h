/// @file
/// The screw along which most of a surface slides in itself, such as the thread of a bolt.

#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A screw along which a surface slides in itself, but for its ends and its facets.
///
/// The motion turns by an angle about the axis and moves along it by pitch times the angle. A
/// surface of revolution has pitch 0.
///
/// The coordinates r (distance from the axis) and h = z - pitch angle of a point stay constant as
/// it moves along the screw. In them the surface is a curve, its profile.
struct ScrewSliding {
  static constexpr std::size_t kDirections = 7;
  static constexpr std::size_t kRadius = 0;
  static constexpr std::size_t kHeight = 1;

  Eigen::Matrix3d R_SB = Eigen::Matrix3d::Identity();  ///< Its last row is the axis.
  /// [m]  A point of the axis, from Hierarchy::centre.
  Eigen::Vector3d p_BS = Eigen::Vector3d::Zero();
  double pitch = 0.0;  ///< [m/rad]
  /// [m]  Half of the least distance from the axis at which bounds hold.
  double least_radius = 0.0;
  /// [-]  Unit vectors in the plane of r and h, across the straight parts of the profile.
  ///
  /// The first one is along r. The second one is along z, not h: these two locate surfaces that do
  /// not slide in themselves.
  std::array<Eigen::Vector2d, kDirections> directions;
};

/// Finds the screw of a shape that does not deform, if exactly one exists.
///
/// Source: N. Gelfand, L. J. Guibas, "Shape segmentation using local slippage analysis", SGP 2004.
/// A motion is slippable if it moves points across their normals, which is the eigenvector of a 6 x
/// 6 matrix. Here weights follow the residuals, as a head and the ends do not slip. Any answer is
/// safe for its users, as they prove what they derive from it.
[[nodiscard]] FIRSTCONTACT_API std::optional<ScrewSliding> find_screw_sliding(
    const Hierarchy& hierarchy);

}  // namespace firstcontact
