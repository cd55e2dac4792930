/// @file
/// Paths and limits that tests of retiming share.

#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/retiming/executed_proof.h>
#include <firstcontact/retiming/timed_motion.h>
#include <firstcontact/retiming/waypoint_path.h>
#include <firstcontact/robot_check/robot_scene.h>

#include "robot/planar_arm.h"

namespace firstcontact::test {

inline std::vector<std::string> arm_joints(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < count; ++k) {
    names.push_back("j" + std::to_string(k));
  }
  return names;
}

/// Makes a path of random edges of up to `size` in each joint.
inline WaypointPath random_path(std::mt19937& rng, std::size_t joints, std::size_t waypoints,
                                double size) {
  std::uniform_real_distribution<double> step(-size, size);
  WaypointPath path{arm_joints(joints), {std::vector<double>(joints, 0.0)}};
  for (std::size_t k = 1; k < waypoints; ++k) {
    std::vector<double> next = path.waypoints.back();
    for (double& q : next) {
      q += step(rng);
    }
    path.waypoints.push_back(next);
  }
  return path;
}

inline std::vector<RateLimits> random_limits(std::mt19937& rng, std::size_t joints, bool has_jerk) {
  std::uniform_real_distribution<double> factor(0.5, 2.0);
  std::vector<RateLimits> limits(joints);
  for (RateLimits& limit : limits) {
    limit.velocity = 2.0 * factor(rng);
    limit.acceleration = 10.0 * factor(rng);
    if (has_jerk) {
      limit.jerk = 500.0 * factor(rng);
    }
  }
  return limits;
}

/// Interpolation of a controller at a time, written from the documentation of ros2_controllers.
///
/// It is linear, cubic or quintic through both points, and independent of the library's own.
struct ControllerState {
  double position = 0.0;
  double velocity = 0.0;
  double acceleration = 0.0;
};

inline ControllerState controller_state(const TimedMotion& motion, std::size_t joint,
                                        double seconds) {
  std::size_t k = 0;
  while (k + 2 < motion.points.size() &&
         static_cast<double>(motion.points[k + 1].time) * 1e-9 < seconds) {
    ++k;
  }
  const TimedPoint& a = motion.points[k];
  const TimedPoint& b = motion.points[k + 1];
  const double T = static_cast<double>(b.time - a.time) * 1e-9;
  const double t = std::min(T, std::max(0.0, seconds - static_cast<double>(a.time) * 1e-9));
  const double p0 = a.positions[joint];
  const double p1 = b.positions[joint];
  double c[6] = {p0, 0, 0, 0, 0, 0};
  if (!motion.has_velocities()) {
    c[1] = (p1 - p0) / T;
  } else if (!motion.has_accelerations()) {
    const double v0 = a.velocities[joint];
    const double v1 = b.velocities[joint];
    c[1] = v0;
    c[2] = (3.0 * (p1 - p0) - (2.0 * v0 + v1) * T) / (T * T);
    c[3] = (-2.0 * (p1 - p0) + (v0 + v1) * T) / (T * T * T);
  } else {
    const double v0 = a.velocities[joint];
    const double v1 = b.velocities[joint];
    const double a0 = a.accelerations[joint];
    const double a1 = b.accelerations[joint];
    c[1] = v0;
    c[2] = 0.5 * a0;
    c[3] = (20.0 * (p1 - p0) - (8.0 * v1 + 12.0 * v0) * T - (3.0 * a0 - a1) * T * T) /
           (2.0 * T * T * T);
    c[4] = (30.0 * (p0 - p1) + (14.0 * v1 + 16.0 * v0) * T + (3.0 * a0 - 2.0 * a1) * T * T) /
           (2.0 * T * T * T * T);
    c[5] = (12.0 * (p1 - p0) - 6.0 * (v1 + v0) * T + (a1 - a0) * T * T) / (2.0 * T * T * T * T * T);
  }
  ControllerState state;
  for (int j = 5; j >= 0; --j) {
    state.acceleration = state.acceleration * t + 2.0 * state.velocity;
    state.velocity = state.velocity * t + state.position;
    state.position = state.position * t + c[j];
  }
  return state;
}

/// Makes the planar arm beside a plate that blocks an angle of its first joint.
///
/// The plate is a thin box from radius 0.5 on, along the direction at `angle` [rad].
inline RetimingScene arm_beside_plate(std::size_t bars, double angle) {
  RetimingScene where;
  std::vector<CoordinatePath> rest(bars, CoordinatePath::constant(0.0));
  where.scene.add_robot("arm", planar_motion(rest));
  const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitZ());
  Pose pose;
  pose.position = turn * Eigen::Vector3d(1.0, 0.0, 0.0);
  pose.rotation = Eigen::Quaterniond(turn);
  where.scene.add_body("plate", make_box({1.0, 0.002, 0.5}), Motion::fixed(pose));
  return where;
}

/// Makes a ball of radius 0.05 that two slides move; its position (x, y) shows the path.
inline RobotModel gantry() {
  RobotDescription robot{.name = "gantry", .links = {}, .joints = {}};
  for (const char* name : {"frame", "bridge", "ball"}) {
    robot.links.push_back({name, {}, {}});
  }
  robot.links.back().collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = make_sphere(0.05)});
  Joint x{.name = "x", .type = JointType::prismatic, .parent = "frame", .child = "bridge"};
  Joint y{.name = "y", .type = JointType::prismatic, .parent = "bridge", .child = "ball"};
  y.axis = Eigen::Vector3d::UnitY();
  robot.joints = {x, y};
  return RobotModel(robot);
}

/// Post of the gantry: a ball at a position in its plane.
struct Post {
  Eigen::Vector2d place;
  double radius = 0.0;
};
inline RetimingScene gantry_among(const std::vector<Post>& posts) {
  RetimingScene where;
  where.scene.add_robot("gantry", RobotMotion(gantry(), {{"x", ramp(0, 0)}, {"y", ramp(0, 0)}}));
  for (std::size_t k = 0; k < posts.size(); ++k) {
    where.scene.add_body("post" + std::to_string(k), make_sphere(posts[k].radius),
                         Motion::fixed({{posts[k].place.x(), posts[k].place.y(), 0.0},
                                        Eigen::Quaterniond::Identity()}));
  }
  return where;
}

}  // namespace firstcontact::test
