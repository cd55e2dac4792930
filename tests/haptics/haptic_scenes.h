/// @file
/// Small haptic scenes for tests.

#pragma once

#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/haptic_scene.h>
#include <firstcontact/motion/motion.h>

namespace firstcontact {

inline HapticBody body_at(std::string name, Shape shape, const Eigen::Vector3d& position,
                          double friction = 0.0) {
  return {.name = std::move(name),
          .shape = std::move(shape),
          .X_WB = {position, Eigen::Quaterniond::Identity()},
          .friction = friction};
}

inline HapticTool tool_at(std::string name, Shape shape, const Eigen::Vector3d& position,
                          double friction = 0.0) {
  return {.name = std::move(name),
          .shape = std::move(shape),
          .X_WB = {position, Eigen::Quaterniond::Identity()},
          .friction = friction};
}

/// Makes a cube of 4 cm above a floor whose top is at z = 0.
inline HapticScene cube_on_floor(double friction = 0.0, double height = 0.03) {
  HapticScene scene;
  scene.tools.push_back(
      tool_at("cube", make_box({0.04, 0.04, 0.04}), {0.0, 0.0, height}, friction));
  scene.bodies.push_back(body_at("floor", make_box({1.0, 1.0, 0.1}), {0.0, 0.0, -0.05}, friction));
  scene.contact_distance = 1e-5;
  return scene;
}

/// Makes a square peg of 2 cm, 4 cm above the mouth of a hole.
///
/// The hole is wider by twice the clearance. Its walls are 6 cm high, z = -0.06 to 0, on a floor.
inline HapticScene peg_over_hole(double clearance, double friction = 0.0) {
  HapticScene scene;
  scene.tools.push_back(tool_at("peg", make_box({0.02, 0.02, 0.05}), {0.0, 0.0, 0.04}, friction));
  const double inner = 0.01 + clearance;
  constexpr double kWall = 0.02;
  const double middle = inner + 0.5 * kWall;
  const double long_side = 2.0 * (inner + kWall);
  scene.bodies.push_back(
      body_at("wall +x", make_box({kWall, long_side, 0.06}), {middle, 0.0, -0.03}, friction));
  scene.bodies.push_back(
      body_at("wall -x", make_box({kWall, long_side, 0.06}), {-middle, 0.0, -0.03}, friction));
  scene.bodies.push_back(
      body_at("wall +y", make_box({2.0 * inner, kWall, 0.06}), {0.0, middle, -0.03}, friction));
  scene.bodies.push_back(
      body_at("wall -y", make_box({2.0 * inner, kWall, 0.06}), {0.0, -middle, -0.03}, friction));
  scene.bodies.push_back(
      body_at("ground", make_box({0.2, 0.2, 0.02}), {0.0, 0.0, -0.0701}, friction));
  scene.contact_distance = 2e-6;
  return scene;
}

/// Makes a cube on a plate that rises to a ceiling in half a second; only the cube has room there.
inline HapticScene cube_in_a_press() {
  HapticScene scene;
  scene.tools.push_back(tool_at("cube", make_box({0.03, 0.03, 0.03}), {0.003, 0.0, 0.045}));
  HapticBody plate = body_at("plate", make_box({0.2, 0.2, 0.02}), {0.0, 0.0, 0.0});
  plate.course = Motion::constant_velocity(plate.X_WB, Eigen::Vector3d(0.0, 0.0, 0.03));
  scene.bodies.push_back(plate);
  scene.bodies.push_back(body_at("ceiling", make_box({0.2, 0.2, 0.02}), {0.0, 0.0, 0.08}));
  scene.duration = 0.5;
  return scene;
}

}  // namespace firstcontact
