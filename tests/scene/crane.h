/// @file
/// A robot with joints of several types.

#pragma once

#include <firstcontact/robot/robot_model.h>

namespace firstcontact::test {

/// Makes the robot ground -rail (planar)- cart -turn (revolute)- mast -lift (prismatic)- hook.
///
/// One further joint follows `lift` with factor 0.5 and offset 0.1; another is fixed.
inline RobotModel crane() {
  RobotDescription crane{.name = "crane",
                         .links = {{"ground", {}, {}},
                                   {"cart", {}, {}},
                                   {"mast", {}, {}},
                                   {"hook", {}, {}},
                                   {"weight", {}, {}},
                                   {"plate", {}, {}}},
                         .joints = {}};
  crane.joints.push_back({.name = "turn",
                          .type = JointType::revolute,
                          .parent = "cart",
                          .child = "mast",
                          .axis = Eigen::Vector3d::UnitZ(),
                          .limits = {.lower = -2.0, .upper = 2.0, .velocity = 4.0}});
  crane.joints.push_back({.name = "lift",
                          .type = JointType::prismatic,
                          .parent = "mast",
                          .child = "hook",
                          .limits = {.lower = -1.0, .upper = 1.0}});
  crane.joints.push_back(
      {.name = "rail", .type = JointType::planar, .parent = "ground", .child = "cart"});
  crane.joints.push_back({.name = "follow",
                          .type = JointType::prismatic,
                          .parent = "mast",
                          .child = "weight",
                          .limits = {},
                          .mimic = Mimic{.joint = "lift", .multiplier = 0.5, .offset = 0.1}});
  crane.joints.push_back({.name = "weld", .parent = "mast", .child = "plate"});
  return RobotModel(crane);
}

}  // namespace firstcontact::test
