/// @file
/// Random chains of joints of every type, for the library and for the oracle.

#pragma once

#include <cstdint>
#include <vector>

#include <firstcontact/robot/robot_motion.h>

#include "support/exact_chain.h"
#include "support/random.h"

namespace firstcontact::test {

struct ChainOptions {
  int joints = 7;
  bool turning_only = false;  ///< Whether all joints are revolute.
};

/// A robot "base - l0 - l1 - ..." that moves, and the oracle's data about it.
struct ChainCase {
  RobotMotion motion;

  /// Returns the oracle's joints from the world to the tip, for the pieces that contain t.
  ///
  /// With `first` they start at the link that joint `first` leaves.
  [[nodiscard]] std::vector<oracle::ExactJoint> exact(double t, std::size_t first = 0,
                                                      bool from_world = true) const;

  std::vector<oracle::ExactJoint> joints;  ///< Joints without coordinates; joint 0 is the base.
  /// Pieces of each coordinate of each joint; a planar joint's angle is the last.
  std::vector<std::vector<std::vector<oracle::ExactCoordinate>>> coordinates;
  std::vector<std::vector<oracle::MotionPiece>> motions;
};

ChainCase random_chain(std::uint64_t seed, const ChainOptions& options);

/// A random path of a coordinate, with its exact pieces.
struct CoordinateCase {
  CoordinatePath path;
  std::vector<oracle::ExactCoordinate> exact;
};
CoordinateCase random_coordinate(Random& random, double size, bool may_wrap);

inline oracle::Vector3<oracle::Wide> exact_point(const Eigen::Vector3d& v) {
  return oracle::exact(oracle::Vector3<double>{v.x(), v.y(), v.z()});
}

}  // namespace firstcontact::test
