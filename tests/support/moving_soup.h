/// @file
/// Input of the oracle: triangles and the numbers that define their motion. Plain data, independent
/// of the library's types.

#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "support/vector3.h"

namespace firstcontact::oracle {

/// Quaternion w, x, y, z; it represents itself divided by its length.
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

/// Numbers that define a motion; a kind uses only the fields that name it.
struct MotionInput {
  MotionKind kind = MotionKind::fixed;
  std::vector<PoseInput> poses{PoseInput{}};  ///< The start; or both ends; or all waypoints.
  std::vector<double> times;                  ///< [-]  Times of waypoints.
  Vector3<double> translation;                ///< Displacement of constant_velocity.
  Vector3<double> rotation_vector;            ///< Rotation of constant_velocity.
  Vector3<double> axis_point;                 ///< Point on the axis of a screw.
  Vector3<double> axis_direction;             ///< Axis of a screw; any length but zero.
  double angle = 0.0;                         ///< Angle of a screw.
  double along = 0.0;                         ///< Translation of a screw along its axis.
};

struct MovingSoup {
  std::vector<Vector3<double>> vertices;
  std::vector<std::array<std::size_t, 3>> triangles;
  double radius = 0.0;
  MotionInput motion;
  /// Position of each vertex at t = 1; empty where the soup is rigid.
  ///
  /// A vertex moves on the line to that position, whatever `motion` contains.
  std::vector<Vector3<double>> to;
};

}  // namespace firstcontact::oracle
