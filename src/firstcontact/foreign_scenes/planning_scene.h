/// @file
/// Reads the environment and the question of a motion planner: MoveIt's planning scenes and
/// requests, as YAML or JSON.

#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/scene/plan_question.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/trajectory.h>

namespace firstcontact {

/// The pairs of names that may touch: moveit_msgs/AllowedCollisionMatrix.
struct AllowedCollisions {
  /// Names of links and objects, first < second, and whether the matrix allows them to touch.
  std::map<std::array<std::string, 2>, bool> entries;
  /// The default of a name, against all names without an entry.
  std::map<std::string, bool> defaults;

  [[nodiscard]] FIRSTCONTACT_API bool allows(const std::string& name,
                                             const std::string& other) const;
};

/// An object that a link of the robot holds: moveit_msgs/AttachedCollisionObject.
struct AttachedObject {
  std::string id;
  std::string link;
  std::vector<std::string> touch_links;
  std::vector<Body> parts;  ///< Bodies at rest in the link's frame; named as the bodies of a scene.
};

/// The objects of moveit_msgs/PlanningScene around a robot, in its planning frame.
struct PlanningScene {
  /// The bodies, all at rest: "id" for an object of one body, "id/0", "id/1" for one of several.
  std::vector<Body> bodies;
  std::vector<std::string> object_ids;  ///< For each body the object to which it belongs.
  AllowedCollisions allowed;
  std::vector<AttachedObject> attached;
  std::map<std::string, double> padding;  ///< [m]  Padding of each link; > 0.
  JointPositions state = {};  ///< Positions of robot_state, by names that the robot may not have.
  bool moves_world = false;   ///< Whether the frame "world" is not the planning frame.
  std::vector<std::string> warnings = {};  ///< Notes for the user about the file.
};

/// One goal of a request: positions of joints, or the pose of a link.
struct RequestGoal {
  JointPositions positions = {};      ///< Joints that they do not name keep their start.
  std::optional<LinkGoal> link = {};  ///< In place of positions.
};

/// The start and the goals of a moveit_msgs/MotionPlanRequest.
struct PlanningRequest {
  JointPositions start;
  std::vector<RequestGoal> goals = {};  ///< At least one; any of them will do.
  /// The coordinates of `group_name`; for links those that move them. Empty where there is no
  /// group.
  std::vector<std::string> joints = {};
  /// [m]  Bounds of the positions that planar and floating joints of the goals or of the group
  /// have, by coordinate: `workspace_parameters`.
  std::map<std::string, std::array<double, 2>> bounds = {};
  double velocity_scaling = 1.0;      ///< [-]  Factor of the velocity limits; in (0, 1].
  double acceleration_scaling = 1.0;  ///< [-]  Factor of the acceleration limits; in (0, 1].
  double cartesian_speed = 0.0;       ///< [m/s]  Most of a link's speed; 0: unlimited.
  /// [s]  Most time of a planner, `allowed_planning_time`; > 0. None where it is not set.
  std::optional<double> planning_time = {};
  Pose base;                               ///< Pose of the robot, where the start has it.
  std::vector<std::string> warnings = {};  ///< Notes for the user about the file.
};

/// Reads a planning scene.
///
/// Boxes, spheres, cylinders, cones and meshes become bodies. The pose of an object times that of
/// its shape is multiplied in double precision. Frames are the planning frame ("", "world",
/// `frame`) or those of fixed_frame_transforms. Lists [x, y, z] and maps {x: , y: , z: } mean the
/// same. A quaternion is x, y, z, w; one of zeros is the identity, with a warning. Attached objects
/// are in the frame of their link. Padding thickens a link by a ball.
///
/// Errors are planes, octomaps, scales of links, objects in other frames, a robot whose base is
/// moved, and unknown keys. They would be left out without notice.
///
/// @param frame  the name of the robot's root link: it is in the planning frame
/// @throws ParseError
[[nodiscard]] FIRSTCONTACT_API PlanningScene read_planning_scene(const std::filesystem::path& path,
                                                                 std::string_view frame);

/// Parses the text of a planning scene, as read_planning_scene() reads it.
///
/// @param source  names the text in errors; meshes are relative to its folder
[[nodiscard]] FIRSTCONTACT_API PlanningScene parse_planning_scene(
    std::string_view text, const std::filesystem::path& source, std::string_view frame);

/// Reads a request. Each of its goals has positions of joints, or the pose of a link.
///
/// Positions of fixed joints are left out with a warning. A quaternion of zeros is the identity,
/// with a warning, too. A scaling factor of 0 counts as 1, as in MoveIt. A planning time of 0
/// counts as one that is not set.
///
/// @param groups  of the robot's SRDF, for `group_name`. A goal of joints may do without them, and
///                names joints of the group alone
/// @throws ParseError
[[nodiscard]] FIRSTCONTACT_API PlanningRequest
read_planning_request(const std::filesystem::path& path, const RobotModel& robot,
                      const std::vector<RobotGroup>& groups = {});

/// Parses the text of a request, as read_planning_request() reads it.
///
/// @param source  names the text in errors
[[nodiscard]] FIRSTCONTACT_API PlanningRequest
parse_planning_request(std::string_view text, const std::filesystem::path& source,
                       const RobotModel& robot, const std::vector<RobotGroup>& groups = {});

/// Makes the motion from the start to the goal at constant rates, as fast as the velocity limits
/// allow.
///
/// Where there are no limits it takes 1 s.
///
/// @param turning  for continuous joints and the angles of planar ones; MoveIt turns the short way
/// @param velocity_scaling  [-]  factor of the velocity limits; in (0, 1]
[[nodiscard]] FIRSTCONTACT_API Trajectory straight_motion(const RobotModel& robot,
                                                          const JointPositions& start,
                                                          const JointPositions& goal,
                                                          Turning turning = Turning::shortest,
                                                          double velocity_scaling = 1.0);

}  // namespace firstcontact
