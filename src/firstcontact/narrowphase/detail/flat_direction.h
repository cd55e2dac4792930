/// @file
/// Normals of flat faces and straight lines of a convex core.

#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/geometry/convex_core.h>

namespace firstcontact::detail {

/// The normal near n of a face or a straight line of a core, in the core's axes; zero where there
/// is none near.
///
/// It is a guess: any direction serves a search.
///
/// @param n  [-]  unit
inline Eigen::Vector3d flat_direction(const ConvexCore& core, const Eigen::Vector3d& n) {
  constexpr double kNear = 0.99;   // [-]  Cosine to the normal of a face.
  constexpr double kAside = 0.14;  // [-]  Component of n along a straight line.
  const Eigen::Vector3d z(0.0, 0.0, std::copysign(1.0, n.z()));
  const auto across_z = [&] { return Eigen::Vector3d(n.x(), n.y(), 0.0).normalized(); };
  switch (core.kind) {
    case ConvexKind::segment:
      return std::abs(n.z()) < kAside ? across_z() : Eigen::Vector3d::Zero();
    case ConvexKind::box: {
      Eigen::Index k = 0;
      return n.cwiseAbs().maxCoeff(&k) > kNear
                 ? Eigen::Vector3d(std::copysign(1.0, n[k]) * Eigen::Vector3d::Unit(k))
                 : Eigen::Vector3d::Zero();
    }
    case ConvexKind::cylinder:
      if (std::abs(n.z()) > kNear) {
        return z;
      }
      return std::abs(n.z()) < kAside ? across_z() : Eigen::Vector3d::Zero();
    case ConvexKind::cone: {
      if (n.z() < -kNear) {
        return z;
      }
      const double across = std::hypot(n.x(), n.y());
      if (!(across > 0.0)) {
        break;
      }
      const double height = 2.0 * core.size.z() / across;
      const Eigen::Vector3d side =
          Eigen::Vector3d(height * n.x(), height * n.y(), core.size.x()).normalized();
      return side.dot(n) > kNear ? side : Eigen::Vector3d::Zero();
    }
    case ConvexKind::hull: {
      if (core.points.size() != 3) {
        break;
      }
      const Eigen::Vector3d normal =
          (core.points[1] - core.points[0]).cross(core.points[2] - core.points[0]).normalized();
      const double along = normal.dot(n);
      return std::abs(along) > kNear ? Eigen::Vector3d(std::copysign(1.0, along) * normal)
                                     : Eigen::Vector3d::Zero();
    }
    default:
      break;
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace firstcontact::detail
