/// @file
/// A scene: the bodies that a user describes, how they move, and what is asked of them.

#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/pair_rules.h>
#include <firstcontact/scene/body_shape.h>

namespace firstcontact {

struct FixedMotion {
  Pose pose;
};

/// Over the whole duration of the scene.
struct ConstantVelocityMotion {
  Pose from;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]    world frame
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]  world frame
};

/// Over the whole duration of the scene.
struct ScrewMotion {
  Pose from;
  Eigen::Vector3d axis_point = Eigen::Vector3d::Zero();       ///< [m]  world frame
  Eigen::Vector3d axis_direction = Eigen::Vector3d::UnitZ();  ///< [-]  world frame, not zero
  double angle = 0.0;                                         ///< [rad]
  double translation = 0.0;                                   ///< [m]  along the axis
};

/// From one pose to another over the whole duration of the scene, by the shortest rotation.
struct TwoPoseMotion {
  Pose from;
  Pose to;
  Between between = Between::constant_velocity;
};

/// At rest before the first and after the last time.
struct WaypointMotion {
  std::vector<double> times;  ///< [s]  >= 0, strictly increasing, as many as poses
  std::vector<Pose> poses;
  Between between = Between::constant_velocity;
};

/// Every vertex of a mesh moves on a line over the whole duration of the scene, from its
/// coordinates.
struct VertexMotion {
  std::vector<Eigen::Vector3d> to;  ///< [m]  World frame; as many as the mesh has vertices.
};

using BodyMotion = std::variant<FixedMotion, ConstantVelocityMotion, ScrewMotion, TwoPoseMotion,
                                WaypointMotion, VertexMotion>;

/// The certified motion of a body's frame over the scene, t = time / duration in [0, 1]. Where
/// vertices move it stays: the frame is the world's.
/// Waypoint times are divided by the duration in double precision; the certificate holds for the
/// rounded quotients.
///
/// @param duration  [s]  > 0, at least the last waypoint's time
/// @throws std::invalid_argument as the factories of Motion do
[[nodiscard]] FIRSTCONTACT_API Motion normalised_motion(const BodyMotion& motion, double duration);

struct Body {
  std::string name;  ///< Unique in the scene, not empty.
  BodyShape shape;
  BodyMotion motion;
};

struct PairMargin {
  BodyPair bodies;
  double margin = 0.0;  ///< [m]  In place of the scene's margin; >= 0.
};

struct BodyGroup {
  std::string name;  ///< Unique in the scene, bodies included; not empty.
  std::vector<std::size_t> bodies;
};

/// Two groups by their index: every body of one with every body of the other; one group twice: all
/// pairs inside it.
using GroupPair = std::array<std::size_t, 2>;

struct GroupMargin {
  GroupPair groups;
  double margin = 0.0;  ///< [m]  In place of the scene's margin; >= 0.
};

/// What is asked; the same words as in FirstContactOptions.
struct SceneOptions {
  double tolerance = 1e-6;  ///< [m]  > 0
  double margin = 0.0;      ///< [m]  >= 0
  ContactState contacts = ContactState::all;
  StartContacts start_contacts = StartContacts::report;
  double contact_band = 0.0;       ///< [m]  >= 0
  std::optional<double> deadline;  ///< [s]  Wall clock for the whole scene; > 0.
};

/// A scene, read and resolved: every pose is a position and a quaternion.
struct Scene {
  std::string id;  ///< May be empty.
  std::vector<Body> bodies;
  std::vector<BodyGroup> groups;
  std::vector<BodyPair> ignored_pairs;
  std::vector<PairMargin> pair_margins;  ///< Prevail over those of groups.
  std::vector<GroupPair> ignored_groups;
  std::vector<GroupMargin> group_margins;  ///< Of several the greatest holds.
  SceneOptions options;
  double duration = 1.0;    ///< [s]  Of the step; t = 1 there.
  std::string text_digest;  ///< SHA-256 of the text that was read, in hexadecimal; may be empty.
};

}  // namespace firstcontact
