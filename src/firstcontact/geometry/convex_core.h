/// @file
/// The core of a convex set: its support function, certified, and its support points.

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact {

/// The forms of a convex core.
enum class ConvexKind : std::uint8_t { point, segment, box, cylinder, cone, ellipsoid, hull };

/// A closed convex set in a frame, ready for fast evaluation; refers to the points of a hull.
///
/// Its own frame has the axes of the frame and its origin at `origin`. There the set is, by `size`:
/// - point: the origin;
/// - segment: from -z to z along the third axis;
/// - box: |x_k| <= size_k;
/// - cylinder: within x of the third axis, |x_2| <= z (a disc where z = 0);
/// - cone: the hull of the disc of radius x at -z and of the tip at z;
/// - ellipsoid: sum (x_k / size_k)^2 <= 1;
/// - hull: the convex hull of `points`.
struct ConvexCore {
  ConvexKind kind = ConvexKind::point;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();    ///< [m]  >= 0; those of an ellipsoid are > 0.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m]  In the frame.
  std::span<const Eigen::Vector3d> points = {};      ///< [m]  The points of a hull; at least one.
  /// [m]  Bound of the distance of any point of the set from the origin of the frame, and from its
  /// own origin.
  double reach = 0.0;

  /// [m]  A point of the set that is almost the farthest along n.
  ///
  /// It is within 2^-49 of the reach from the exact set, whatever n is. How far along n it lies
  /// affects the speed of a search, not its proofs.
  [[nodiscard]] Eigen::Vector3d support_point(const Eigen::Vector3d& n) const;

  /// [m]  An upper bound of h(n) = max n . x over the set, for the doubles n as they are.
  ///
  /// Holds for components of n and sizes that are 0 or between 1e-100 and 1e100 in size; n may be
  /// 0.
  ///
  /// But for underflow, it is at most 2^-46 |n| reach above h(n).
  ///
  /// Derivation, u = 2^-53, |n|_1 the sum of the components' sizes. Each formula below is a sum of
  /// products of components of n and of lengths up to the reach. Some add the square root of a sum
  /// of squares of such products. Roots and sums of positive terms err by at most 5 u of
  /// themselves. The value that is rounded is at most 2 |n|_1 reach in size, with the shift by the
  /// origin 3 |n|_1 reach. So all errors together are below 18 u |n|_1 reach; 32 u are added. A
  /// square that underflows loses at most 2^-1075, its root 2^-537. This loss and the rounding of
  /// other subnormal numbers are below the 2^-530 of the sizes and the 2^-1060 that are added.
  [[nodiscard]] double support_bound(const Eigen::Vector3d& n) const;

  /// [m]  An upper bound of the distance of any point of the set from the line through the frame's
  /// origin along u.
  ///
  /// For bodies of revolution it is tight where u is their axis.
  ///
  /// @param u  [-]  unit up to rounding
  [[nodiscard]] double reach_across(const Eigen::Vector3d& u) const;

 private:
  [[nodiscard]] Eigen::Vector3d own_point(const Eigen::Vector3d& n) const;
  [[nodiscard]] double own_support(const Eigen::Vector3d& n) const;
  [[nodiscard]] Eigen::Vector3d hull_point(const Eigen::Vector3d& n) const;
};

inline Eigen::Vector3d ConvexCore::hull_point(const Eigen::Vector3d& n) const {
  std::size_t best = 0;
  double most = n.dot(points[0]);
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double along = n.dot(points[k]);
    best = along > most ? k : best;
    most = std::max(most, along);
  }
  return points[best];
}

inline Eigen::Vector3d ConvexCore::own_point(const Eigen::Vector3d& n) const {
  // Below this the square of a length is too coarse to divide by; the middle serves as well.
  constexpr double kLeastSquare = 1e-280;
  const auto on_circle = [&](double z) {
    const double across2 = n.x() * n.x() + n.y() * n.y();
    const double scale = across2 > kLeastSquare ? size.x() / std::sqrt(across2) : 0.0;
    return Eigen::Vector3d(scale * n.x(), scale * n.y(), z);
  };
  switch (kind) {
    case ConvexKind::point:
      break;
    case ConvexKind::segment:
      return {0.0, 0.0, std::copysign(size.z(), n.z())};
    case ConvexKind::box:
      return {std::copysign(size.x(), n.x()), std::copysign(size.y(), n.y()),
              std::copysign(size.z(), n.z())};
    case ConvexKind::cylinder:
      return on_circle(std::copysign(size.z(), n.z()));
    case ConvexKind::cone: {
      const double across = std::sqrt(n.x() * n.x() + n.y() * n.y());
      return n.z() * size.z() > size.x() * across - n.z() * size.z()
                 ? Eigen::Vector3d(0.0, 0.0, size.z())
                 : on_circle(-size.z());
    }
    case ConvexKind::ellipsoid: {
      const Eigen::Vector3d stretched = size.cwiseProduct(n);
      const double length2 = stretched.squaredNorm();
      // A unit vector stretched by the sizes lies on the ellipsoid whatever its direction.
      return length2 > kLeastSquare
                 ? Eigen::Vector3d(size.cwiseProduct(stretched / std::sqrt(length2)))
                 : Eigen::Vector3d::Zero();
    }
    case ConvexKind::hull:
      return hull_point(n);
  }
  return Eigen::Vector3d::Zero();
}

inline double ConvexCore::own_support(const Eigen::Vector3d& n) const {
  switch (kind) {
    case ConvexKind::point:
      break;
    case ConvexKind::segment:
      return std::abs(n.z()) * size.z();
    case ConvexKind::box:
      return std::abs(n.x()) * size.x() + std::abs(n.y()) * size.y() + std::abs(n.z()) * size.z();
    case ConvexKind::cylinder:
      return std::abs(n.z()) * size.z() + size.x() * std::sqrt(n.x() * n.x() + n.y() * n.y());
    case ConvexKind::cone:
      return std::max(n.z() * size.z(),
                      size.x() * std::sqrt(n.x() * n.x() + n.y() * n.y()) - n.z() * size.z());
    case ConvexKind::ellipsoid:
      return size.cwiseProduct(n).norm();
    case ConvexKind::hull:
      return n.dot(hull_point(n));
  }
  return 0.0;
}

inline Eigen::Vector3d ConvexCore::support_point(const Eigen::Vector3d& n) const {
  return origin + own_point(n);
}

inline double ConvexCore::support_bound(const Eigen::Vector3d& n) const {
  const double length = std::abs(n.x()) + std::abs(n.y()) + std::abs(n.z());
  return (n.dot(origin) + own_support(n)) + (0x1p-48 * length + 0x1p-530) * reach + 0x1p-1060;
}

inline double ConvexCore::reach_across(const Eigen::Vector3d& u) const {
  constexpr double kUp = 1.0 + 0x1p-46;
  if (kind == ConvexKind::box || kind == ConvexKind::ellipsoid || kind == ConvexKind::hull) {
    return reach * kUp;
  }
  // A point at (x, y, z) from the origin: |(x, y, 0) x u| <= |(x, y)|, and z times |e_z x u|.
  const double tilt = std::sqrt(u.x() * u.x() + u.y() * u.y());
  const double across = origin.cross(u).norm() + size.x() + size.z() * tilt;
  return std::min(reach, across + 0x1p-50 * reach) * kUp;
}

}  // namespace firstcontact
