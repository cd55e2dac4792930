/// @file
/// What the oracle is asked about: triangles and the numbers that define their motion. Plain data,
/// independent of the library's types.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "support/vector3.h"

namespace firstcontact::oracle {

/// w, x, y, z; stands for itself divided by its length.
struct Quaternion {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};

struct PoseInput {
  Vector3<double> position;
  Quaternion rotation;
};

enum class MotionKind {
  fixed,
  constant_velocity,
  constant_velocity_between,
  screw,
  screw_between,
  waypoints,
  screw_waypoints,
};

/// The defining numbers of a motion; the fields that a kind does not name are unused.
struct MotionInput {
  MotionKind kind = MotionKind::fixed;
  std::vector<PoseInput> poses{PoseInput{}};  ///< The start; or both ends; or all waypoints.
  std::vector<double> times;                  ///< Of waypoints.
  Vector3<double> translation;                ///< Of constant_velocity.
  Vector3<double> rotation_vector;            ///< Of constant_velocity.
  Vector3<double> axis_point;                 ///< Of screw.
  Vector3<double> axis_direction;             ///< Of screw; any length but zero.
  double angle = 0.0;                         ///< Of screw.
  double along = 0.0;                         ///< Of screw: translation along the axis.
};

struct MovingSoup {
  std::vector<Vector3<double>> vertices;
  std::vector<std::array<std::size_t, 3>> triangles;
  double radius = 0.0;
  MotionInput motion;
  /// Where each vertex is at t = 1; in between it is on the line, whatever `motion` says. Empty
  /// where the soup is rigid.
  std::vector<Vector3<double>> to;
};

}  // namespace firstcontact::oracle
