/// @file
/// Robot with a continuous joint, and joints that follow it.

#pragma once

#include <numbers>
#include <optional>
#include <string>

#include <firstcontact/robot/robot_model.h>

namespace firstcontact::test {

/// How a joint follows `turn`.
struct Follower {
  JointType type = JointType::continuous;
  double multiplier = 1.0;
};

/// base -turn (continuous, 1 rad/s)- bar, base -wrist (revolute, two turns each way)- hand, base
/// -reach (revolute, half a turn each way)- rod; and where one is wanted, base -follow- gear.
inline RobotModel spinner(const std::optional<Follower>& follower = {}) {
  RobotDescription robot{
      .name = "spinner",
      .links = {{"base", {}, {}}, {"bar", {}, {}}, {"hand", {}, {}}, {"rod", {}, {}}},
      .joints = {}};
  const auto add = [&](const std::string& name, JointType type, const std::string& child,
                       JointLimits limits) {
    robot.joints.push_back({.name = name,
                            .type = type,
                            .parent = "base",
                            .child = child,
                            .axis = Eigen::Vector3d::UnitZ(),
                            .limits = limits});
  };
  constexpr double kTurn = 2.0 * std::numbers::pi;
  add("turn", JointType::continuous, "bar", {.velocity = 1.0});
  add("wrist", JointType::revolute, "hand", {.lower = -2.0 * kTurn, .upper = 2.0 * kTurn});
  add("reach", JointType::revolute, "rod", {.lower = -0.5 * kTurn, .upper = 0.5 * kTurn});
  if (follower) {
    robot.links.push_back({"gear", {}, {}});
    add("follow", follower->type, "gear", {});
    robot.joints.back().mimic =
        Mimic{.joint = "turn", .multiplier = follower->multiplier, .offset = 0.0};
  }
  return RobotModel(robot);
}

}  // namespace firstcontact::test
