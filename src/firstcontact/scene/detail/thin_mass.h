/// @file
/// Mass without volume: spread over triangles, edges or points.

#pragma once

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>

namespace firstcontact::detail {

/// Mass and inertia of a thin body of density 1.
///
/// Each triangle has the mass of its area. Where no triangle has three corners, each edge has the
/// mass of its length. Where there is no edge, each point has the mass 1.
struct ThinMass {
  double mass = 0.0;                                  ///< [m^2, m or 1]
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();     ///< [m]  Centre of mass.
  Eigen::Matrix3d about_C = Eigen::Matrix3d::Zero();  ///< Mass times m^2, body axes.
};

/// Computes the mass of a mesh without volume.
///
/// @param mesh  at least one triangle
[[nodiscard]] ThinMass thin_mass(const Mesh& mesh);

}  // namespace firstcontact::detail
