/// @file
/// A scene for haptic devices: the tools in a user's hands and the bodies around them.

#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The spring by which a device holds its god-object.
struct HapticCoupling {
  double stiffness = 1000.0;       ///< [N/m]  > 0, at most 1e17
  double angular_stiffness = 1.0;  ///< [N m/rad]  About the tool's centre; > 0, at most 1e17.
  double damping = 0.0;            ///< [N s/m]  >= 0. It costs stability; see docs/haptics.md.
};

/// A joint of a tool. A spring pulls it to the position that the device wants.
struct HapticJoint {
  std::string name;
  double start = 0.0;                                       ///< [rad or m]  Within its limits.
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad or m]  Lower limit.
  double upper = std::numeric_limits<double>::infinity();   ///< [rad or m]  Upper limit; >= lower.
  double stiffness = 1.0;  ///< [N m/rad or N/m]  Stiffness of its spring; > 0.
};

/// A link of a tool.
///
/// X_PL(q) = X_PJ, then a turn about an axis and a slide along it. P is the parent, J the frame of
/// the joint in it, q the coordinate of the joint.
struct HapticLink {
  std::string name;
  std::optional<Shape> shape = {};  ///< None where it touches nothing.
  /// A link before it in the list; none for the tool's body.
  std::optional<std::size_t> parent = {};
  Pose X_PJ = {};
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< [-]  In J; not 0.
  /// Index of the joint of the tool; a link without one is fixed to P.
  std::optional<std::size_t> joint = {};
  double turn = 0.0;      ///< [-]  Angle by coordinate; [rad/m] for a slider.
  double slide = 0.0;     ///< [-]  Displacement by coordinate; [m/rad] for a turning joint.
  double friction = 0.0;  ///< [-]  >= 0
};

/// A body in a user's hand. Its god-object stays where contacts permit.
///
/// A tool with joints is a hand or a gripper, and the device moves its fingers as well. Links that
/// one joint connects may overlap. So may links that no joint moves against each other.
struct HapticTool {
  std::string name;
  Shape shape;
  Pose X_WB = {};                                  ///< Pose at which the god-object begins; free.
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  ///< [m]  Centre about which it turns.
  double friction = 0.0;                           ///< [-]  >= 0
  HapticCoupling coupling = {};
  std::vector<HapticJoint> joints = {};
  std::vector<HapticLink> links = {};
};

/// A body around the tools. Contacts do not move it.
struct HapticBody {
  std::string name;
  Shape shape;
  Pose X_WB = {};                     ///< Pose of a body without a course.
  std::optional<Motion> course = {};  ///< X_WB(t), t = time / HapticScene::duration.
  double friction = 0.0;              ///< [-]  >= 0
};

/// Tools and their environment. The friction of a pair is the geometric mean of the two.
struct HapticScene {
  std::vector<HapticTool> tools;  ///< The tools; 1 or 2.
  std::vector<HapticBody> bodies;
  double duration = 1.0;  ///< [s]  Duration of the courses; bodies rest afterwards.
  /// [m]  Distance that tools keep from everything, to a few roundings; > 0. They rest at up to one
  /// and a half of it. Default: 1e-4 of the reach of the smallest tool.
  std::optional<double> contact_distance = {};
  /// Pairs that may pass through each other, by their numbers among the members: the tools, then
  /// the bodies, then the links that have a shape.
  std::vector<std::array<std::size_t, 2>> ignored_pairs = {};
};

}  // namespace firstcontact
