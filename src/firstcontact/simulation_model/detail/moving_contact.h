/// @file
/// How a contact moves with its bodies over a plan.

#pragma once

#include <array>

#include <Eigen/Core>

#include <firstcontact/contact_solver/contact_problem.h>
#include <firstcontact/simulation_model/detail/manifold.h>

namespace firstcontact {
struct Pose;
}

namespace firstcontact::detail {

struct SimBody;

/// A body of a contact as the contact finds it.
struct ContactSide {
  const SimBody* body = nullptr;
  RoundFeature round = {};  ///< Where the contact is on one.
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();     ///< [m/s]    Of C.
  Eigen::Vector3d w = Eigen::Vector3d::Zero();     ///< [rad/s]
};

/// Where a contact is after both bodies moved.
struct MovedContact {
  std::array<Eigen::Vector3d, 2> arms = {};             ///< [m]  From the centres of mass there.
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< Rows: normal, two tangents.
  double opened = 0.0;                                  ///< [m]  Its gap became so much larger.

  /// [m/s]  The velocity of B's point relative to A's there, in the frame, with these velocities.
  [[nodiscard]] Eigen::Vector3d velocity(const std::array<ContactSide, 2>& sides) const;
};

/// [1/s]  How fast a contact on a rim runs round it: infinite where the rim lies flat and turns.
///
/// @param n  [-]  the normal
[[nodiscard]] double rate_on_rim(const Eigen::Vector3d& n, const std::array<ContactSide, 2>& sides);

/// [s]  How long a contact on an ellipsoid has nearly the arm that it has, and the way of the
/// ellipsoid's centre is nearly a line: the least of three instants of a time [s]. Infinite on a
/// ball.
///
/// @param n      [-]  the normal
/// @param least  [m]  the contact distance
[[nodiscard]] double span_on_ellipsoid(const Eigen::Vector3d& n,
                                       const std::array<ContactSide, 2>& sides, double time,
                                       double least);

/// Whether a surface is curved at a contact, and the contact stays near its place on it for a time
/// [s]: on a circle that lies nearly flat it does not.
[[nodiscard]] bool follows_curve(const ContactPoint& contact,
                                 const std::array<ContactSide, 2>& sides, double time);

/// Whether a corner of a body that turns touches a face: its way is known, as that of a curve is.
[[nodiscard]] bool turns_on_corner(const ManifoldPoint& touch,
                                   const std::array<ContactSide, 2>& sides, double time);

/// [m/s]  A bound of how much moving a contact for a time [s] changes the velocity at it.
[[nodiscard]] double most_change(const ContactPoint& contact,
                                 const std::array<ContactSide, 2>& sides, double time);

/// Whether a contact goes over the face of a side, with what it meets there: as a ball rolls over
/// points of a turntable.
[[nodiscard]] bool goes_over(const ManifoldPoint& touch, const std::array<ContactSide, 2>& sides,
                             std::size_t side);

/// Moves a contact with the velocities of its bodies.
///
/// A point of a body goes round with it. A round surface (a ball, a capsule, a cylinder, a rim, a
/// hole) keeps its centre or axis, and the contact stays where the normal leaves it. So does that
/// on an ellipsoid, which turns. The normal turns with the face that it belongs to, with both of
/// two edges that cross, with the line between two centres, or it separates an ellipsoid most. So
/// the result is right to first order in the time.
///
/// Between two corners, or a corner and an edge, without radius the normal stays: it would turn
/// about a point at the distance of the gap.
///
/// @param contact   at the touch now
/// @param distance  [m]  between the surfaces
/// @param time      [s]
[[nodiscard]] MovedContact moved_contact(const ManifoldPoint& touch, const ContactPoint& contact,
                                         double distance, const std::array<ContactSide, 2>& sides,
                                         double time);

}  // namespace firstcontact::detail
