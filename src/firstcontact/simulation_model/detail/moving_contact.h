/// @file
/// The motion of a contact with its bodies over a plan.

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

/// A body of a contact, at the time of the contact.
struct ContactSide {
  const SimBody* body = nullptr;
  RoundFeature round = {};  ///< Curved feature with the contact, if it is on one.
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();     ///< [m/s]    Velocity of C.
  Eigen::Vector3d w = Eigen::Vector3d::Zero();     ///< [rad/s]
};

/// A contact after both bodies moved.
struct MovedContact {
  /// [m]  Vectors from the moved centres of mass.
  std::array<Eigen::Vector3d, 2> arms = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  ///< Rows: normal, two tangents.
  double opened = 0.0;                                  ///< [m]  Growth of its gap.

  /// [m/s]  The velocity of B's point relative to A's there, in the frame, for the sides'
  /// velocities.
  [[nodiscard]] Eigen::Vector3d velocity(const std::array<ContactSide, 2>& sides) const;
};

/// [1/s]  The rate at which a contact on a rim runs round it; infinite where the rim lies flat and
/// turns.
///
/// @param n  [-]  the normal
[[nodiscard]] double rate_on_rim(const Eigen::Vector3d& n, const std::array<ContactSide, 2>& sides);

/// [s]  The time for which a contact on an ellipsoid nearly keeps its arm, and the way of the
/// ellipsoid's centre is nearly a line.
///
/// It is the least of three instants of a time [s]; infinite on a ball.
///
/// @param n      [-]  the normal
/// @param least  [m]  the contact distance
[[nodiscard]] double span_on_ellipsoid(const Eigen::Vector3d& n,
                                       const std::array<ContactSide, 2>& sides, double time,
                                       double least);

/// Whether a surface is curved at a contact, and the contact stays near its place on it for a time
/// [s].
///
/// On a circle that lies nearly flat it does not.
[[nodiscard]] bool follows_curve(const ContactPoint& contact,
                                 const std::array<ContactSide, 2>& sides, double time);

/// Whether a corner of a turning body touches a face; its way is then known, as that of a curve is.
[[nodiscard]] bool turns_on_corner(const ManifoldPoint& touch,
                                   const std::array<ContactSide, 2>& sides, double time);

/// [m/s]  A bound of the change of a contact's velocity when it moves for a time [s].
[[nodiscard]] double most_change(const ContactPoint& contact,
                                 const std::array<ContactSide, 2>& sides, double time);

/// Whether a contact goes over the face of a side together with the other body, as a ball rolls
/// over points of a turntable.
[[nodiscard]] bool goes_over(const ManifoldPoint& touch, const std::array<ContactSide, 2>& sides,
                             std::size_t side);

/// Moves a contact with the velocities of its bodies.
///
/// A point of a body goes round with it. A round surface (a ball, a capsule, a cylinder, a rim, a
/// hole) keeps its centre or axis, and the normal determines the contact's place on it. So it does
/// on an ellipsoid, which turns. The normal turns with the face that it belongs to, with both of
/// two edges that cross, or with the line between two centres. For an ellipsoid it is the direction
/// that separates most. The result is right to first order in the time.
///
/// A contact goes over a face, along an edge or along a cylinder with the other body's point, and
/// along two lines that cross with the point where they are nearest.
///
/// Between two corners, or a corner and an edge, without radius the normal stays. Otherwise it
/// would turn about a point at the distance of the gap.
///
/// @param contact   contact at the present point
/// @param distance  [m]  between the surfaces
/// @param time      [s]
[[nodiscard]] MovedContact moved_contact(const ManifoldPoint& touch, const ContactPoint& contact,
                                         double distance, const std::array<ContactSide, 2>& sides,
                                         double time);

}  // namespace firstcontact::detail
