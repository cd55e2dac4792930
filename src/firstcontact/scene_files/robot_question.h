/// @file
/// The question "Is this trajectory of my robot free?" as a scene.

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene/scene_robot.h>

namespace firstcontact {

/// The files of one robot, its motion and its environment.
///
/// At most one of `trajectory`, `request` and `goal` gives its motion. Without any of them it
/// rests.
struct RobotQuestion {
  RobotFile robot;
  std::filesystem::path srdf = {};
  Pose base = {};                         ///< Pose of the root link; a request has its own.
  std::filesystem::path trajectory = {};  ///< Trajectory for read_trajectory().
  std::filesystem::path request = {};  ///< Request of MoveIt: straight from its start to its goal.
  /// The states that give the start; later ones prevail (see `state`).
  ///
  /// There are none beside a trajectory or request.
  std::vector<std::string> start = {};
  std::vector<std::string> goal = {};  ///< The states that give the goal of a straight motion from
                                       ///< the start.
  /// The positions of joints that nothing else gives: states of the SRDF, or NAME=POSITION.
  ///
  /// Joints without any have the positions of the robot_state of a planning scene.
  std::vector<std::string> state = {};
  /// The way of continuous joints and of the angles of planar ones.
  ///
  /// By default it is the short way to a goal, as MoveIt takes it. Along a trajectory it is the way
  /// as given.
  std::optional<Turning> turning = {};
  bool unwrap = false;  ///< Removes whole turns from a trajectory; see `unwrapped`.
  /// The environment: files of meshes, planning scenes (.yaml), or scenes (.json).
  ///
  /// A scene brings the rules for its bodies and its options.
  std::vector<std::filesystem::path> environment = {};
  double environment_scale = 1.0;  ///< [-]  Scale of the meshes of the environment; > 0.
  double padding = 0.0;            ///< [m]  Padding of every link.
  double tracking_error = 0.0;     ///< [rad or m]  Tracking error of every joint.
  /// Whether the goals become the scene's `plan`, in place of a straight motion to one of joints.
  bool plans = false;
  ReadingOptions reading = {};
};

/// Reads a question as a scene: all of its files except meshes.
///
/// The scene's id is the name of the trajectory's file; the robot's name is that of its model.
///
/// @throws ParseError, std::invalid_argument
[[nodiscard]] FIRSTCONTACT_API Scene read_robot_question(const RobotQuestion& question);

}  // namespace firstcontact
