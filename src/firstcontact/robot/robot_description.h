/// @file
/// A robot as plain data: links, joints, and what may be wrong with them.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/link_geometry.h>

namespace firstcontact {

/// The mass and the inertia of a link as its maker states them; no body need have them.
struct LinkInertia {
  double mass = 0.0;                                    ///< [kg]
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();       ///< [m]  Centre of mass.
  Eigen::Matrix3d about_C_L = Eigen::Matrix3d::Zero();  ///< [kg m^2]  About C, in axes of L;
                                                        ///< symmetric.
  /// The defect of the values in their file, with its place; may be empty.
  ///
  /// Motions that are given do not depend on these values; simulations refuse the link.
  std::string defect = {};
};

/// A rigid part of a robot, frame L.
struct Link {
  std::string name = {};
  std::vector<LinkGeometry> visual = {};
  std::vector<LinkGeometry> collision = {};
  std::optional<LinkInertia> inertia = {};
};

/// Two links of a robot whose collision is not checked.
struct DisabledPair {
  std::size_t link = 0;  ///< The smaller index.
  std::size_t other = 0;
  std::string reason;  ///< May be empty.
};

/// The ways in which a child link may move against its parent.
///
/// J is the joint frame, fixed in the parent; at zero coordinates the child's frame is J.
enum class JointType {
  fixed,
  revolute,    ///< Turns about the axis by its coordinate, within limits.
  continuous,  ///< Turns without limits.
  prismatic,   ///< Slides along the axis.
  screw,       ///< Turns, and slides by `pitch` times the angle.
  planar,      ///< Slides along two directions across the axis, turns about it: three coordinates.
  floating,    ///< Any rigid motion: a pose.
  ball,        ///< Turns about its centre: a pose without translation.
};

/// The words of joint types in files and in Python, in this order.
inline constexpr std::array<const char*, 8> kJointTypeWords{
    "fixed", "revolute", "continuous", "prismatic", "screw", "planar", "floating", "ball"};

/// The limits that the maker of a joint allows; none where none is given.
///
/// Units per coordinate: rad, or m for prismatic joints; those of a screw belong to the angle.
struct JointLimits {
  std::optional<double> lower = {};     ///< [rad or m]
  std::optional<double> upper = {};     ///< [rad or m]
  std::optional<double> velocity = {};  ///< [rad/s or m/s]  >= 0.
  std::optional<double> effort = {};    ///< [N m or N]  >= 0.
};

/// A coordinate that follows another joint's: multiplier times that one, plus offset.
struct Mimic {
  std::string joint;
  double multiplier = 1.0;  ///< [-]
  double offset = 0.0;      ///< [rad or m]
};

/// A connection of a child link to its parent. X_PL(q) = X_PJ X_JL(q).
struct Joint {
  std::string name = {};
  JointType type = JointType::fixed;
  std::string parent = {};
  std::string child = {};
  Pose X_PJ = {};
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< [-]  Direction in J, of any length but
                                                    ///< zero.
  double pitch = 0.0;                               ///< [m/rad]  Slide of a screw by its angle.
  JointLimits limits = {};
  std::optional<Mimic> mimic = {};  ///< Only for joints with one coordinate.
  double damping = 0.0;             ///< [N m s/rad or N s/m]  >= 0.
  double friction = 0.0;            ///< [N m or N]  >= 0; Coulomb's friction of the joint itself.
};

/// The number of coordinates of a joint; 0 for floating and ball joints, which take a pose.
FIRSTCONTACT_API std::size_t coordinate_count(JointType type);

/// The word of URDF for a type; `screw` and `ball` for those that URDF does not know.
FIRSTCONTACT_API const char* to_string(JointType type);

/// The plain data of a RobotModel. Order is free: a joint may come before its links.
struct RobotDescription {
  std::string name = {};
  std::vector<Link> links = {};
  std::vector<Joint> joints = {};
};

/// A defect of a description, and its place.
struct RobotDefect {
  std::string message;
  std::optional<std::size_t> joint;  ///< Index into joints.
  std::optional<std::size_t> link;   ///< Index into links.
};

/// Finds the reasons why a description is no sound tree of links; empty if it is sound.
///
/// They are unknown or doubled names, second parents, loops, second roots, and joints whose numbers
/// make no sense. A defect that only follows from other defects is left out.
FIRSTCONTACT_API std::vector<RobotDefect> find_defects(const RobotDescription& description);

/// Finds the first of find_defects(); none if the description is sound.
FIRSTCONTACT_API std::optional<RobotDefect> find_defect(const RobotDescription& description);

}  // namespace firstcontact
