/// @file
/// What the oracle is asked about robots: the numbers that define their joints, paths and meshes.
/// Plain data, independent of the library's types.

#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "support/moving_soup.h"

namespace firstcontact::oracle {

enum class CoordinateKind {
  linear,      ///< Through positions.
  cubic,       ///< And velocities.
  quintic,     ///< And accelerations.
  polynomial,  ///< Given coefficients, one piece from 0 to 1.
};

/// One coordinate of a joint; it rests before the first time and after the last.
struct CoordinateInput {
  CoordinateKind kind = CoordinateKind::linear;
  bool shortest = false;  ///< Whether positions count up to whole turns.
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

/// Joint k carries link k + 1; link 0 is the root.
struct JointInput {
  JointKind kind = JointKind::fixed;
  std::size_t parent = 0;  ///< A link.
  PoseInput X_PJ;
  Vector3<double> axis{1.0, 0.0, 0.0};  ///< Of any length.
  double pitch = 0.0;
  std::vector<CoordinateInput> coordinates;  ///< One; of a planar joint x, y and angle.
  MotionInput motion;                        ///< Of floating and ball joints.
  std::optional<MimicInput> mimic;           ///< In place of a coordinate.
};

/// A tree of links; a free body is one without joints.
struct RobotInput {
  MotionInput base;
  std::vector<JointInput> joints;
};

/// A mesh fixed in a link; its own motion is of no meaning. Or one whose vertices move on lines in
/// the world (MovingSoup::to): its robot is a free body that rests.
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

/// The joints from one link down to another that hangs on it.
std::vector<std::size_t> joints_between(const RobotInput& robot, std::size_t ancestor,
                                        std::size_t link);

/// The link farthest from the root on which both hang.
std::size_t common_ancestor(const RobotInput& robot, std::size_t link, std::size_t other);

}  // namespace firstcontact::oracle
