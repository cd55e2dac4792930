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

/// The files that one robot, its motion and its environment lie in.
///
/// At most one of `trajectory`, `request` and `goal` gives its motion; without any it rests.
struct RobotQuestion {
  RobotFile robot;
  std::filesystem::path srdf = {};
  Pose base = {};                         ///< Of the root link; a request has its own.
  std::filesystem::path trajectory = {};  ///< As read_trajectory.
  std::filesystem::path request = {};     ///< Straight from its start to its goal.
  /// The states that give the start, the later ones prevail: see `state`. None beside a trajectory
  /// or request.
  std::vector<std::string> start = {};
  std::vector<std::string> goal = {};  ///< Straight from the start to there.
  /// The positions of joints that nothing else gives: states of the SRDF, or NAME=POSITION.
  ///
  /// Else those of the robot_state of a planning scene.
  std::vector<std::string> state = {};
  /// The way of continuous joints and of the angles of planar ones.
  ///
  /// By default it is the short way to a goal, as MoveIt goes, and as given along a trajectory.
  std::optional<Turning> turning = {};
  bool unwrap = false;  ///< Takes whole turns out of a trajectory; see `unwrapped`.
  /// Files of meshes; planning scenes (.yaml); scenes (.json), with the rules for their bodies and
  /// options.
  std::vector<std::filesystem::path> environment = {};
  double environment_scale = 1.0;  ///< [-]  Of the meshes among the surroundings; > 0.
  double padding = 0.0;            ///< [m]  Of every link.
  double tracking_error = 0.0;     ///< [rad or m]  Of every joint.
  /// The goal of a request may be the pose of a link. It becomes the scene's `plan`, as no straight
  /// motion leads there.
  bool plans = false;
  ReadingOptions reading = {};
};

/// Reads a question as a scene: all of its files but meshes.
///
/// The scene's id is the name of the trajectory's file; the robot's name is that of its model.
///
/// @throws ParseError, std::invalid_argument
[[nodiscard]] FIRSTCONTACT_API Scene read_robot_question(const RobotQuestion& question);

}  // namespace firstcontact
