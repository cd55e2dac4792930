/// @file
/// The verifier's own convex sets: boxes, triangles and curved bodies, and the gap between two.

#pragma once

#include <functional>
#include <optional>
#include <variant>

#include <Eigen/Core>

#include <firstcontact/geometry/convex_core.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/separation/detail/closest_on_triangles.h>
#include <firstcontact/separation/detail/window_body.h>

namespace firstcontact::detail {

/// A cylinder, a cone or an ellipsoid with its axes along those of the body, as the exact set that
/// its doubles define.
struct RoundSet {
  ConvexKind kind = ConvexKind::ellipsoid;
  Eigen::Vector3d size = Eigen::Vector3d::Ones();    ///< [m]  As ConvexCore::size.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]  From the pivot.

  /// [m]  The greatest m . y over the set, up to 2^-48 of |m| and of the set's reach from the
  /// pivot.
  [[nodiscard]] double support(const Eigen::Vector3d& m) const;

  /// [m]  A point of the set that is farthest along m.
  ///
  /// It is within 2^-48 of the reach of a point that belongs to the set, whatever m is.
  [[nodiscard]] Eigen::Vector3d farthest(const Eigen::Vector3d& m) const;

  /// [m]  The radius of a ball in the set, about inner_centre(); rounded down by a half.
  [[nodiscard]] double inner_radius() const;
  /// [m]  From the pivot.
  [[nodiscard]] Eigen::Vector3d inner_centre() const;

  /// The set scaled by 1 - share about inner_centre().
  ///
  /// It stays inside, with share * inner_radius() around it. Derivation, with a ball B in a convex
  /// set S and both relative to its centre: (1 - e) S + e B is a part of (1 - e) S + e S = S.
  [[nodiscard]] RoundSet shrunk(double share) const;
};

/// The exact core of a curved shape (Shape::is_curved()); none of another.
///
/// @param pivot  [m]  in the frame of the shape
[[nodiscard]] std::optional<RoundSet> round_set_of(const Shape& shape,
                                                   const Eigen::Vector3d& pivot);

/// A convex part of a body in the middle of a window.
struct ConvexPart {
  const WindowBody& body;
  std::variant<const BoxNode*, const TrianglePoints*, const RoundSet*> form;
  double reach = 0.0;  ///< [m]  Bound of the distance of its points from the pivot.

  /// [m]  As RoundSet::support(), in axes of the body.
  [[nodiscard]] double support(const Eigen::Vector3d& m) const;
  [[nodiscard]] Eigen::Vector3d farthest(const Eigen::Vector3d& m) const;
  /// [m]  A point in the middle of the part, in world axes.
  [[nodiscard]] Eigen::Vector3d middle() const;
};

/// The bound of the gap of two parts along n within a window, but for the rounding of places.
///
/// The fall does not cover rounded velocities (WindowBody::drift).
///
/// Derivation: a point at Y = R y from the pivot is at n . (p + Y) + s n . (v + w x Y) after a time
/// s, up to s^2 / 2 of its acceleration. With n . (w x Y) = (n x w) . Y the farthest such point is
/// that along n + s n x w. So the gap at s is n . (p_B - p_A) + s n . (v_B - v_A), less the two
/// supports along those directions. It is concave in s, as supports are convex. Its least value is
/// therefore at one end of the window.
///
/// @param n     [-]  from A to B, unit up to rounding.
/// @param half  [s]  half the length of the window.
[[nodiscard]] GapBound convex_gap_along(const Eigen::Vector3d& n, const ConvexPart& A,
                                        const ConvexPart& B, double half);

/// Close points of two parts, and the direction with the widest gap that was seen.
struct ConvexClosest {
  PointPair points;  ///< Both surely belong to the parts, up to the rounding of places.
  Eigen::Vector3d n = Eigen::Vector3d::Zero();  ///< [-]  Unit up to rounding, or zero.
};

/// Looks for the closest points in the middle of the window. It proves nothing.
///
/// The method is that of E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the
/// distance between complex objects in three-dimensional space" (IEEE J. Robotics and Automation 4,
/// 1988).
///
/// @param taken  [m]  of the distance, by thickness and promise; the rest decides how precise the
///                    direction has to be
[[nodiscard]] ConvexClosest closest_estimate(const ConvexPart& A, const ConvexPart& B,
                                             double taken);

/// Offers directions that stay precise at any small distance, until one is accepted.
///
/// The closest points of two parts that nearly touch differ by few digits, and their direction is
/// as coarse. Normals of the features are precise. The normals of faces are single directions.
/// Those along an edge, a cylinder or a cone make a circle. They are directions n with a fixed
/// n . axis. Two circles meet in two directions. On one circle, and on the sphere of all
/// directions, the widest gap is searched for: the difference of the farthest points is its slope,
/// which is precise, too. No direction proves anything.
///
/// @param n       [-]  a direction; the widest gap is searched for near it
/// @param accept  returns whether a direction is good enough
void offer_normals(const ConvexPart& A, const ConvexPart& B, const Eigen::Vector3d& n,
                   const std::function<bool(const Eigen::Vector3d&)>& accept);

/// Whether two parts are proven to overlap in the middle of the window.
///
/// Method: a curved core that is a little smaller has a ball of known radius around each point.
///
/// @param error      [m]  bound of the errors of places
/// @param thickness  [m]  of both parts together
[[nodiscard]] bool surely_overlap(const ConvexPart& A, const ConvexPart& B, double error,
                                  double thickness);

}  // namespace firstcontact::detail
