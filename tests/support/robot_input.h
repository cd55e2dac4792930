/// @file
/// Input of the oracle for robots: the numbers that define their joints, paths and meshes. Plain
/// data, independent of the library's types.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "support/moving_soup.h"

namespace firstcontact::oracle {

enum class CoordinateKind {
  linear,      ///< Piecewise linear through positions.
  cubic,       ///< With positions and velocities.
  quintic,     ///< With positions, velocities and accelerations.
  polynomial,  ///< Given coefficients, one piece from 0 to 1.
};

/// One coordinate of a joint; it rests before the first time and after the last.
struct CoordinateInput {
  CoordinateKind kind = CoordinateKind::linear;
  bool shortest = false;  ///< Whether positions count modulo whole turns.
  std::vector<double> times;
  std::vector<double> positions;
  std::vector<double> velocities;
  std::vector<double> accelerations;
  std::vector<double> coefficients;
};

enum class JointKind {
  fixed,
  revolute,
  continuous,
  prismatic,
  screw,
  planar,
  floating,
  ball,
};

struct MimicInput {
  std::size_t joint = 0;
  double multiplier = 1.0;
  double offset = 0.0;
};

/// Joint of a robot; joint k carries link k + 1, and link 0 is the root.
struct JointInput {
  JointKind kind = JointKind::fixed;
  std::size_t parent = 0;  ///< Index of the parent link.
  PoseInput X_PJ;
  Vector3<double> axis{1.0, 0.0, 0.0};  ///< Axis, of any length.
  double pitch = 0.0;
  std::vector<CoordinateInput> coordinates;  ///< One coordinate; for a planar joint x, y and angle.
  MotionInput motion;                        ///< Motion of floating and ball joints.
  std::optional<MimicInput> mimic;           ///< Replaces a coordinate.
};

/// Tree of links; a free body is a tree without joints.
struct RobotInput {
  MotionInput base;
  std::vector<JointInput> joints;
};

/// Mesh that is fixed in a link, or one whose vertices move on lines in the world.
///
/// The motion of a fixed mesh itself has no meaning. A mesh with moving vertices (MovingSoup::to)
/// has a robot that is a free body at rest.
struct LinkInput {
  std::size_t robot = 0;
  std::size_t link = 0;
  MovingSoup soup;
};

struct RobotCase {
  std::vector<RobotInput> robots;
  LinkInput A;
  LinkInput B;
  double margin = 0.0;     ///< [m]
  double tolerance = 0.0;  ///< [m]
};

/// Returns the joints from one link down to one of its descendants.
std::vector<std::size_t> joints_between(const RobotInput& robot, std::size_t ancestor,
                                        std::size_t link);

/// Returns the last common ancestor of two links: the one farthest from the root.
std::size_t common_ancestor(const RobotInput& robot, std::size_t link, std::size_t other);

}  // namespace firstcontact::oracle
