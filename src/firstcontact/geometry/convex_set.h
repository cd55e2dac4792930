/// @file
/// Convex sets with a support function: the exact form of curved bodies.

#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// A convex core thickened by a radius: all points within the radius of the core.
///
/// The lengths are taken as they are: a set is the exact one that the doubles define. Immutable and
/// cheap to copy. All factories throw std::invalid_argument where a length is not finite or not in
/// its range. primitives.h has the range: from 1e-60 to 1e60 m, or 0 where 0 is allowed.
class FIRSTCONTACT_API ConvexSet {
 public:
  /// Makes a ball about the origin.
  ///
  /// @param radius  [m]  > 0
  [[nodiscard]] static ConvexSet sphere(double radius);

  /// Makes a capsule about the origin: all points within the radius of a segment along z.
  ///
  /// @param radius  [m]  > 0
  /// @param length  [m]  of the segment; >= 0
  [[nodiscard]] static ConvexSet capsule(double radius, double length);

  /// Makes a box along the axes, centred at the origin.
  ///
  /// @param size      [m]  of the whole box along each axis, without the rounding; > 0
  /// @param rounding  [m]  thickens it; >= 0
  [[nodiscard]] static ConvexSet box(const Eigen::Vector3d& size, double rounding = 0.0);

  /// Makes a cylinder about z, centred at the origin.
  ///
  /// @param radius    [m]  > 0
  /// @param length    [m]  along z; >= 0 (0: a disc)
  /// @param rounding  [m]  thickens it; >= 0
  [[nodiscard]] static ConvexSet cylinder(double radius, double length, double rounding = 0.0);

  /// Makes a cone about z: its base at z = -length / 2, its tip at length / 2.
  ///
  /// @param radius    [m]  of the base; > 0
  /// @param length    [m]  along z; > 0
  /// @param rounding  [m]  thickens it; >= 0
  [[nodiscard]] static ConvexSet cone(double radius, double length, double rounding = 0.0);

  /// Makes an ellipsoid along the axes, centred at the origin.
  ///
  /// @param radii  [m]  half of the length along each axis; > 0
  [[nodiscard]] static ConvexSet ellipsoid(const Eigen::Vector3d& radii);

  /// Makes the convex hull of points.
  ///
  /// Queries look at every point: the time grows with their number.
  ///
  /// @param points    [m]  at least one, finite, no coordinate beyond 1e60
  /// @param rounding  [m]  thickens it; >= 0
  [[nodiscard]] static ConvexSet hull(std::vector<Eigen::Vector3d> points, double rounding = 0.0);

  /// The core, which refers to the points of this set.
  [[nodiscard]] const ConvexCore& core() const { return core_; }

  /// [m]  The radius that thickens the core.
  [[nodiscard]] double rounding() const { return rounding_; }

  /// The core in a frame with the axes of the set and the origin at p. Exact.
  ///
  /// @param p  [m]  from the origin of the set
  [[nodiscard]] ConvexCore core_from(const Eigen::Vector3d& p) const;

  /// [m]  An upper bound of max n . x over the set, rounding included, for the doubles n as they
  /// are. ConvexCore::support_bound states how tight it is.
  [[nodiscard]] double support_bound(const Eigen::Vector3d& n) const;

  /// Compares by content: negative, zero or positive, a total order.
  [[nodiscard]] int compare(const ConvexSet& other) const;

 private:
  ConvexSet(ConvexKind kind, const Eigen::Vector3d& size, double rounding,
            std::vector<Eigen::Vector3d> points = {});

  std::shared_ptr<const std::vector<Eigen::Vector3d>> points_;
  ConvexCore core_;
  double rounding_ = 0.0;
};

}  // namespace firstcontact
