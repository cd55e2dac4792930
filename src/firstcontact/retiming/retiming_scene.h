/// @file
/// The robots that one motion moves, the scene around them, and the names of all their joints.

#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <firstcontact/many_bodies/pair_rules.h>
#include <firstcontact/math/export.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/scene/contact_pair.h>

namespace firstcontact {

/// A pair that is in contact at an end of the path.
///
/// A distance of its own holds it, in place of its margin and paddings.
struct RetimingHold {
  BodyPair members = {};
  double distance = 0.0;  ///< [m]  > 0.
  /// [rad or m]  The waypoint at which the pair has to be open, in the order of the motion's
  /// joints.
  ///
  /// It is empty where the pair is held all the time. A pair that opens after the start is held
  /// until the motion first rests there. A pair that is in contact at the goal is held from the
  /// last such rest on. At that rest and all other times the pair keeps its margin.
  std::vector<double> opens_at = {};
  PathEnd at = PathEnd::start;
};

/// The limits of positions of a joint.
struct PositionLimits {
  std::optional<double> lower = {};  ///< [rad or m]
  std::optional<double> upper = {};  ///< [rad or m]
};

/// The moving robots in their resting environment.
///
/// Several robots are one motion with one clock. The robots' joints that the motion does not name
/// rest where they are in the scene at t = 0. Bodies that a robot holds all the time move with it.
/// Tracking errors of the scene are the controller's tolerance.
struct RetimingScene {
  RobotScene scene;
  std::vector<std::size_t> robots = {0};  ///< Robots of the scene; one or more, each once.
  std::vector<RetimingHold> holds = {};   ///< Each pair once, or where it opens at both ends twice.
  /// Limits of joints beside those of their robots, which hold, too. Joints are named as those of
  /// joined_model().
  std::map<std::string, PositionLimits> positions = {};
};

/// The moving robots as one model, by which limits and files of their joints are read.
///
/// One robot is its own model. With several, joint NAME of robot ROBOT is called ROBOT/NAME, as in
/// path files, and has the limits of that joint. Their links then have no geometry, and hang on a
/// common root.
///
/// @throws std::invalid_argument if there is no such robot, or two joints have one name
[[nodiscard]] FIRSTCONTACT_API RobotModel joined_model(const RetimingScene& where);

/// Splits a motion into those of the robots, whose joints have the robots' own names.
///
/// @returns in the order of `where.robots`, all with the times of the motion. A robot of which the
///         motion names no joint has none there.
/// @throws std::invalid_argument as joined_model(). Also where no robot has a joint; it is named.
[[nodiscard]] FIRSTCONTACT_API std::vector<TimedMotion> split_motion(const TimedMotion& motion,
                                                                     const RetimingScene& where);

}  // namespace firstcontact
