/// @file
/// A robot of a scene, with its files, its motion and what it carries.

#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot/tracking_error.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/scene/body_motion.h>
#include <firstcontact/scene/simulation.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// A robot that lies in a file of its own.
struct RobotFile {
  std::filesystem::path urdf;  ///< As MeshFile::path.
  std::vector<std::filesystem::path> package_roots = {};
  RobotSurface surface = RobotSurface::collision;
};

/// A body that a link carries for a while; see Attachment.
struct SceneAttachment {
  std::size_t body = 0;                       ///< Index of the body in the scene.
  std::size_t link = 0;                       ///< Index of the link in the robot.
  double from_time = 0.0;                     ///< [s]
  std::optional<double> to_time = {};         ///< [s]  Without it, the end of the scene.
  std::vector<std::size_t> touch_links = {};  ///< Links of the robot that may touch the body
                                              ///< meanwhile.
  /// The body's pose in the link from the start on, with from_time 0.
  ///
  /// Without it the body keeps its place at from_time.
  std::optional<Pose> pose = {};
};

/// A robot, read and resolved. A value that is not given for a link or joint is 0.
struct SceneRobot {
  std::string name;  ///< Unique in the scene, bodies and groups included; not empty.
  RobotFile file;
  std::filesystem::path srdf = {};  ///< As MeshFile::path; may be empty.
  RobotModel model;                 ///< The model of the file, without shapes.
  RobotSemantics semantics = {};    ///< The contents of the SRDF.
  BodyMotion base = {};             ///< The motion of the root link; any but VertexMotion.
  Trajectory trajectory = {};  ///< The motion of the joints; without joint names the robot rests.
  JointPositions state = {};   ///< Positions of coordinates that the trajectory does not name; they
                               ///< rest there.
  std::vector<SceneAttachment> attached = {};
  std::map<std::size_t, double> padding = {};                ///< [m]  By link; >= 0.
  std::map<std::size_t, TrackingError> tracking_error = {};  ///< By joint.
  /// The dynamics of the robot in a simulation; without them it follows its trajectory.
  std::optional<RobotDynamics> dynamics = {};
  std::string srdf_digest = {};  ///< SHA-256 of the SRDF; may be empty.
};

/// The model of the geometry that can touch, without shapes: it has names and limits.
///
/// @throws ParseError as read_urdf
[[nodiscard]] FIRSTCONTACT_API RobotModel read_robot_model(const RobotFile& file,
                                                           const ReadingOptions& reading = {});

/// The coordinates of a named state of the SRDF.
///
/// @param name  STATE, or GROUP/STATE
/// @throws std::invalid_argument if there is none, or more than one of this name
[[nodiscard]] FIRSTCONTACT_API JointPositions group_state(const RobotModel& model,
                                                          const RobotSemantics& semantics,
                                                          std::string_view name);

/// The error of a joint in the unit of its coordinate; with several coordinates in both units.
///
/// @param error  [rad or m]
[[nodiscard]] FIRSTCONTACT_API TrackingError joint_error(const Joint& joint, double error);

/// The errors of all joints that move by themselves, each as joint_error() gives it.
[[nodiscard]] FIRSTCONTACT_API std::map<std::size_t, TrackingError> joint_errors(
    const RobotModel& model, double error);

}  // namespace firstcontact
