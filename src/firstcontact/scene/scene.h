/// @file
/// A scene: the bodies and robots that a user describes, how they move, and what is asked of them.

#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/body_shape.h>
#include <firstcontact/scene/haptic_question.h>
#include <firstcontact/scene/plan_question.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// A body of a scene: its shape and its motion.
struct Body {
  std::string name;  ///< Unique in the scene, not empty.
  BodyShape shape;
  BodyMotion motion;
  std::optional<FreeBody> free = {};  ///< Properties of a body that moves freely in a simulation;
                                      ///< without them it follows its motion.
  Surface surface = {};
};

/// The margin of one pair of members.
///
/// A member of the scene is anything that can touch. Members are numbered in this order: its
/// bodies, then the links of its first robot, of its second, and so on. Rules for pairs go by
/// members.
struct PairMargin {
  BodyPair bodies;
  double margin = 0.0;  ///< [m]  In place of the scene's margin; >= 0.
};

struct BodyGroup {
  std::string name;                 ///< Unique in the scene, bodies and robots included; not empty.
  std::vector<std::size_t> bodies;  ///< Members.
};

/// Two groups by their index: every body of one with every body of the other.
///
/// One group twice stands for all pairs inside it.
using GroupPair = std::array<std::size_t, 2>;

struct GroupMargin {
  GroupPair groups;
  double margin = 0.0;  ///< [m]  In place of the scene's margin; >= 0.
};

/// The options of a query about the scene, in the words of FirstContactOptions.
struct SceneOptions {
  double tolerance = 1e-6;  ///< [m]  > 0
  double margin = 0.0;      ///< [m]  >= 0
  ContactState contacts = ContactState::nearest();
  StartContacts start_contacts = StartContacts::report;
  double contact_band = 0.0;       ///< [m]  >= 0
  std::optional<double> deadline;  ///< [s]  Wall clock for the whole scene; > 0.
  bool lenient = false;            ///< ReadingOptions::lenient for the files that the scene names.
};

/// A scene, read and resolved: every pose is a position and a quaternion.
struct Scene {
  std::string id;  ///< May be empty.
  std::vector<Body> bodies;
  std::vector<SceneRobot> robots;
  std::vector<BodyGroup> groups;
  std::vector<BodyPair> ignored_pairs;
  std::vector<PairMargin> pair_margins;  ///< Margins of pairs; they prevail over those of groups.
  std::vector<GroupPair> ignored_groups;
  std::vector<GroupMargin> group_margins;  ///< Margins of groups; if several apply, the greatest
                                           ///< holds.
  /// The ignored pairs that planning scenes allow to touch.
  ///
  /// Only the counts of pairs distinguish them from other ignored pairs.
  std::vector<BodyPair> allowed_pairs = {};
  SceneOptions options;
  std::optional<Simulation> simulation = {};
  std::optional<PlanQuestion> plan = {};  ///< The question to a planner; write_scene() leaves it
                                          ///< out.
  std::optional<HapticQuestion> haptics = {};  ///< The question to a haptic device; write_scene()
                                               ///< leaves it out.
  double duration = 1.0;                       ///< [s]  Duration of the step; t = 1 there.
  /// SHA-256, in hexadecimal, of the text that was read and of the trajectory files that it names;
  /// may be empty.
  ///
  /// write_scene() writes these files out.
  std::string text_digest;
  std::vector<std::string> warnings = {};  ///< Notes for the user about the files that were read.
  /// Files that were read into the fields above, such as trajectories and the meshes of Rigid IPC.
  ///
  /// Paths are as MeshFile::path.
  std::vector<std::filesystem::path> files_read = {};
  std::vector<FileReport> file_reports = {};  ///< The reports on the files of text.
};

/// [s]  The greatest last time of waypoints and trajectories; 0 where there is none.
[[nodiscard]] FIRSTCONTACT_API double last_time(const Scene& scene);

/// Appends a body. Links of robots have greater numbers from then on, in the rules too.
FIRSTCONTACT_API void add_body(Scene& scene, Body body);

/// The members that a name means: a body, a link as "robot/link", all links of a robot, a group.
///
/// @throws std::invalid_argument  with the nearest name, if there is none
[[nodiscard]] FIRSTCONTACT_API std::vector<std::size_t> members_named(const Scene& scene,
                                                                      std::string_view name);

/// The number of the member that is a robot's first link.
[[nodiscard]] FIRSTCONTACT_API std::size_t first_member(const Scene& scene, std::size_t robot);

/// The name of a body, or "robot/link".
[[nodiscard]] FIRSTCONTACT_API std::string member_name(const Scene& scene, std::size_t member);

}  // namespace firstcontact
