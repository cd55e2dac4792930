/// @file
/// Scenes for planning, whose clearances are known by construction.

#pragma once

#include <string>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/planning/plan_path.h>
#include <firstcontact/robot/detail/given_motions.h>
#include <firstcontact/robot_check/robot_scene.h>
#include <firstcontact/robot_check/touching_links.h>

namespace firstcontact::test {

inline Motion resting_at(const Eigen::Vector3d& place) {
  return Motion::fixed({place, Eigen::Quaterniond::Identity()});
}

/// Makes a cube of side 0.2 m on three slides, "x", "y" and "z", within 2 m of the origin.
inline RobotModel gantry() {
  RobotDescription robot{
      .name = "gantry", .links = {{"base"}, {"lx"}, {"ly"}, {"tool"}}, .joints = {}};
  robot.links[3].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = make_box({0.2, 0.2, 0.2})});
  const char* names[] = {"x", "y", "z"};
  const char* parents[] = {"base", "lx", "ly", "tool"};
  for (int k = 0; k < 3; ++k) {
    Joint joint{.name = names[k],
                .type = JointType::prismatic,
                .parent = parents[k],
                .child = parents[k + 1],
                .axis = Eigen::Vector3d::Unit(k)};
    joint.limits = {.lower = -2.0, .upper = 2.0};
    robot.joints.push_back(joint);
  }
  return RobotModel(robot);
}

/// Adds the gantry to a scene of bodies.
inline PlanScene with_gantry(RobotScene scene) {
  const RobotMotion rest = at_rest(gantry());
  const std::vector<std::string> names = {"x", "y", "z"};
  const std::size_t robot = scene.add_robot("gantry", rest);
  return {.scene = std::move(scene),
          .robots = {robot},
          .space = ConfigurationSpace::of_joints(rest.model(), names, detail::given_motions(rest))};
}

/// Makes a wall in the plane x = 0, 10 um thick, from -2.2 to 2.2 m.
///
/// The wall has a square window around the origin.
///
/// @param half  [m]  from the middle of the window to its sides; 0 for none
inline RobotScene thin_wall(double half) {
  RobotScene scene;
  const double thick = 1e-5;
  const double edge = 2.2;
  if (half == 0.0) {
    scene.add_body("wall", make_box({thick, 2 * edge, 2 * edge}));
    return scene;
  }
  const double side = edge - half;
  const double middle = 0.5 * (edge + half);
  scene.add_body("left", make_box({thick, side, 2 * edge}), resting_at({0.0, -middle, 0.0}));
  scene.add_body("right", make_box({thick, side, 2 * edge}), resting_at({0.0, middle, 0.0}));
  scene.add_body("under", make_box({thick, 2 * half, side}), resting_at({0.0, 0.0, -middle}));
  scene.add_body("over", make_box({thick, 2 * half, side}), resting_at({0.0, 0.0, middle}));
  return scene;
}

/// Makes a bar of the given sizes that moves freely among the bodies of a scene, within 1.5 m.
inline PlanScene with_bar(RobotScene scene, const Eigen::Vector3d& sizes) {
  ConfigurationSpace space = ConfigurationSpace::of_body(
      "bar", make_box(sizes), Eigen::Vector3d::Constant(-1.5), Eigen::Vector3d::Constant(1.5));
  const Configuration origin = {0, 0, 0, 1, 0, 0, 0};
  const std::size_t robot = scene.add_robot("bar", space.motion(origin, origin));
  return {.scene = std::move(scene), .robots = {robot}, .space = std::move(space)};
}

}  // namespace firstcontact::test
