/// @file
/// The part of a scene that a user feels through a haptic device: the tools, and how.

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// A joint that a grip of the device moves between two positions.
struct HapticGripJoint {
  std::size_t joint = 0;  ///< Index of the joint in the robot.
  double open = 0.0;      ///< [rad or m]  Position where the device has 0.
  double closed = 0.0;    ///< [rad or m]  Position where the device has 1.
};

/// A value of the device, or a button of it, that moves joints of a robot in the user's hand.
struct HapticGripQuestion {
  std::vector<HapticGripJoint> joints;
  std::optional<double> stiffness = {};  ///< [N m/rad or N/m]  > 0  Stiffness of each joint; else 1
                                         ///< or 1000.
  std::optional<int> button = {};  ///< 0 to 31  Button that closes, in place of a value of the
                                   ///< device.
  double seconds = 0.5;            ///< [s]  > 0  Time from open to closed by the button.
};

/// A joint of a tool, once the robot is made of bodies (prepare_haptics()).
struct HapticToolJoint {
  std::size_t joint = 0;  ///< Index of the joint in the robot.
  std::string name;
  double start = 0.0;           ///< [rad or m]
  std::optional<double> lower;  ///< [rad or m]
  std::optional<double> upper;  ///< [rad or m]
  double stiffness = 1.0;       ///< [N m/rad or N/m]
};

/// A link of a tool, after prepare_haptics(): X_PL = X_PJ, a turn about the axis and a slide along
/// it.
struct HapticToolLink {
  std::optional<std::size_t> body = {};  ///< Index of the body in the scene; none without geometry.
  std::optional<std::size_t> parent = {};  ///< A link before it; else the tool's body.
  Pose X_PJ = {};
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< [-]  Direction in J.
  std::optional<std::size_t> joint = {};            ///< Index of the tool's joint; fixed without.
  double turn = 0.0;                                ///< [-]  Factor of the coordinate for the turn.
  double slide = 0.0;  ///< [-]  Factor of the coordinate for the slide.
};

/// A body or robot of the scene that a device moves, and the spring between the two.
struct HapticToolQuestion {
  std::size_t body = 0;  ///< Index of the body in the scene; it starts at its pose.
  std::optional<std::size_t> robot = {};  ///< Robot in place of the body: rigid but for its grips.
  double stiffness = 1000.0;              ///< [N/m]  > 0
  double angular_stiffness = 1.0;         ///< [N m/rad]  > 0
  double damping = 0.0;                   ///< [N s/m]  >= 0
  std::optional<Eigen::Vector3d> centre = {};  ///< [m]  p_BC; else the middle of its bounds.
  double scale = 1.0;  ///< [-]  > 0  Factor by which the tool goes farther than the device.
  /// Orientation of the device's frame in the world.
  Eigen::Quaterniond device_axes = Eigen::Quaterniond::Identity();
  Pose handle = {};               ///< Pose of the device at which the tool is at its start.
  bool begins_at_handle = false;  ///< Whether the first pose of the device is taken as the handle.
  std::optional<int> clutch_button = {};       ///< Button, 0 to 31.
  std::optional<int> dead_man_button = {};     ///< Button, 0 to 31.
  std::vector<HapticGripQuestion> grips = {};  ///< Grips of a robot; values of the device in order.
  std::vector<HapticToolJoint> joints = {};    ///< Joints that grips move; see prepare_haptics().
  std::vector<HapticToolLink> links = {};      ///< Links of a robot; see prepare_haptics().
};

/// The tools of a scene, and how a user feels them.
struct HapticQuestion {
  std::vector<HapticToolQuestion> tools;        ///< 1 or 2 tools; their bodies or robots differ.
  std::optional<double> contact_distance = {};  ///< [m]  > 0
  double friction = 0.0;         ///< [-]  >= 0  Friction of bodies whose surfaces give none.
  double force_rate = 4000.0;    ///< [Hz]
  double contact_rate = 1000.0;  ///< [Hz]
  double max_force = 10.0;       ///< [N]
  double max_torque = 0.5;       ///< [N m]
  double force_slew = 20'000.0;  ///< [N/s]
  double torque_slew = 1'000.0;  ///< [N m/s]
  double max_grip_effort = 1.0;  ///< [J]  Greatest effort of each grip, by its value.
};

}  // namespace firstcontact
