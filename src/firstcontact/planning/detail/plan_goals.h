/// @file
/// The goals of a plan of a robot, and the pairs that its path leaves out.

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/motion/pose.h>
#include <firstcontact/robot/robot_model.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/plan_question.h>

namespace firstcontact::detail {

/// The link that a goal names.
///
/// @param name  of the link, without that of its robot
/// @throws std::invalid_argument if the robot has no such link
[[nodiscard]] std::size_t link_of_goal(const RobotModel& model, const LinkGoal& goal,
                                       const std::string& name);

/// The joints that the question or a goal names, for each robot of the question.
///
/// They have the names of the robot. Joints that mimic others are left out.
[[nodiscard]] std::vector<std::vector<std::string>> planned_joints(const Scene& scene,
                                                                   const PlanQuestion& question);

/// The pose of the body that moves beside robots: numbers that are not named are those of `from`.
///
/// @throws std::invalid_argument  names a number that no pose has
[[nodiscard]] Pose pose_of_body(const Scene& scene, const PlanQuestion& question,
                                const JointPositions& positions, const Pose& from);

/// The configuration of a goal: coordinates that it does not name keep their start.
///
/// @throws std::invalid_argument  names a joint that is not planned, or that mimics another one and
///         contradicts it
[[nodiscard]] Configuration goal_of(const Scene& scene, const PlanQuestion& question,
                                    const ConfigurationSpace& space,
                                    const JointPositions& positions, const Configuration& start);

/// Ignores the pairs that no edge moves, in the scene that the path file has.
void ignore_what_rests(const PlanScene& plan, Scene& scene);

}  // namespace firstcontact::detail
