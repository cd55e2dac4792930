/// @file
/// The part of a scene that a user feels through a haptic device: the tools, and how.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A body or robot of the scene that a device moves, and the spring between the two.
struct HapticToolQuestion {
  std::size_t body = 0;                        ///< Of the scene; it starts at its pose.
  std::optional<std::size_t> robot = {};       ///< In place of the body: in one posture, rigid.
  double stiffness = 1000.0;                   ///< [N/m]  > 0
  double angular_stiffness = 1.0;              ///< [N m/rad]  > 0
  double damping = 0.0;                        ///< [N s/m]  >= 0
  std::optional<Eigen::Vector3d> centre = {};  ///< [m]  p_BC; else the middle of its bounds.
  double scale = 1.0;  ///< [-]  > 0  The tool goes so much farther than the device.
  /// Orientation of the device's frame in the world.
  Eigen::Quaterniond device_axes = Eigen::Quaterniond::Identity();
  Pose handle = {};                       ///< Pose of the device at which the tool is at its start.
  bool begins_at_handle = false;          ///< The first pose of the device is that one.
  std::optional<int> clutch_button = {};  ///< 0 to 31
  std::optional<int> dead_man_button = {};  ///< 0 to 31
};

/// The tools of a scene, and how a user feels them.
struct HapticQuestion {
  std::vector<HapticToolQuestion> tools;        ///< 1 or 2, of different bodies or robots.
  std::optional<double> contact_distance = {};  ///< [m]  > 0
  double friction = 0.0;                        ///< [-]  >= 0  Of bodies whose surfaces give none.
  double force_rate = 4000.0;                   ///< [Hz]
  double contact_rate = 1000.0;                 ///< [Hz]
  double max_force = 10.0;                      ///< [N]
  double max_torque = 0.5;                      ///< [N m]
  double force_slew = 20'000.0;                 ///< [N/s]
  double torque_slew = 1'000.0;                 ///< [N m/s]
};

}  // namespace firstcontact
