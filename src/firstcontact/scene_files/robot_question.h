/// @file
/// "Is this trajectory of my robot free?" as a scene.

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

/// The files that one robot, its motion and its surroundings lie in. Exactly one of `trajectory`,
/// `request` and `goal` says how it moves; without any it rests.
struct RobotQuestion {
  RobotFile robot;
  std::filesystem::path srdf = {};
  Pose base = {};                         ///< Of the root link; a request says its own.
  std::filesystem::path trajectory = {};  ///< As read_trajectory.
  std::filesystem::path request = {};     ///< Straight from its start to its goal.
  /// States, the later ones prevail: see `state`. None beside a trajectory or request.
  std::vector<std::string> start = {};
  std::vector<std::string> goal = {};  ///< Straight from the start to there.
  /// Where joints rest that nothing else speaks of: states of the SRDF, or NAME=POSITION; else the
  /// robot_state of a planning scene.
  std::vector<std::string> state = {};
  /// Of continuous joints and the angles of planar ones. By default the short way to a goal, as
  /// MoveIt goes, and as given along a trajectory.
  std::optional<Turning> turning = {};
  bool unwrap = false;  ///< Takes whole turns out of a trajectory; see `unwrapped`.
  /// Meshes; planning scenes (.yaml); scenes (.json), with the rules for their bodies and options.
  std::vector<std::filesystem::path> environment = {};
  double environment_scale = 1.0;  ///< [-]  Of the meshes among the surroundings; > 0.
  double padding = 0.0;            ///< [m]  Of every link.
  double tracking_error = 0.0;     ///< [rad or m]  Of every joint.
  ReadingOptions reading = {};
};

/// Reads all files but meshes. The scene's id is the name of the trajectory's file; the robot's
/// name is that of its model.
///
/// @throws ParseError, std::invalid_argument
[[nodiscard]] FIRSTCONTACT_API Scene read_robot_question(const RobotQuestion& question);

}  // namespace firstcontact
