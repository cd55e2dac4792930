/// @file
/// Grippers for tests of haptics.

#pragma once

#include <string>
#include <utility>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/haptics/haptic_scene.h>

namespace firstcontact {

/// Makes a box whose centre is at a given point of its frame.
inline Shape box_off(const Eigen::Vector3d& size, const Eigen::Vector3d& centre) {
  Mesh mesh = make_box(size).mesh();
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex += centre;
  }
  return Shape(std::move(mesh), 0.0, Filling::solid);
}

inline constexpr double kGripStiffness = 2.0;  // [N m/rad]

/// Makes a palm with two fingers of 6 cm below it that turn about y, 8 cm from each other.
///
/// At 0 they hang down; joint 0 is the one at x > 0. Both close with the same sign.
inline HapticTool gripper(double friction = 0.0, double z = 0.0) {
  HapticTool tool{.name = "hand",
                  .shape = make_box({0.1, 0.02, 0.02}),
                  .X_WB = {{0.0, 0.0, z}, Eigen::Quaterniond::Identity()},
                  .friction = friction};
  for (const double side : {1.0, -1.0}) {
    tool.joints.push_back({.name = side > 0.0 ? "right" : "left",
                           .lower = -0.2,
                           .upper = 1.2,
                           .stiffness = kGripStiffness});
    tool.links.push_back({.name = side > 0.0 ? "hand/right" : "hand/left",
                          .shape = box_off({0.01, 0.01, 0.06}, {0.0, 0.0, -0.03}),
                          .X_PJ = {{0.04 * side, 0.0, -0.012}, Eigen::Quaterniond::Identity()},
                          .axis = side * Eigen::Vector3d::UnitY(),
                          .joint = tool.joints.size() - 1,
                          .turn = 1.0,
                          .friction = friction});
  }
  return tool;
}

inline constexpr double kJawStiffness = 1000.0;  // [N/m]
inline constexpr double kJawWay = 0.034;         // [m]

/// Makes the same palm with jaws that slide towards each other, by 34 mm each.
inline HapticTool jaws(double friction = 0.0) {
  HapticTool tool = gripper(friction);
  for (std::size_t k = 0; k < 2; ++k) {
    tool.joints[k].lower = 0.0;
    tool.joints[k].upper = kJawWay;
    tool.joints[k].stiffness = kJawStiffness;
    tool.links[k].axis = (k == 0 ? -1.0 : 1.0) * Eigen::Vector3d::UnitX();
    tool.links[k].turn = 0.0;
    tool.links[k].slide = 1.0;
  }
  return tool;
}

/// Makes one grip that turns both fingers from 0 to 0.9 rad, or slides both jaws.
inline DeviceMapping one_grip(double closed = 0.9) {
  DeviceMapping mapping;
  mapping.grips.push_back({.joints = {{.joint = 0, .open = 0.0, .closed = closed},
                                      {.joint = 1, .open = 0.0, .closed = closed}}});
  return mapping;
}

}  // namespace firstcontact
