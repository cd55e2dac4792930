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
  bool turning_only = false;  ///< Revolute joints alone.
};

/// A robot "base - l0 - l1 - ..." that moves, and what the oracle knows of it.
struct ChainCase {
  RobotMotion motion;

  /// The oracle's joints from the world to the tip, or from the link that joint `first` leaves, for
  /// the pieces that contain t.
  [[nodiscard]] std::vector<oracle::ExactJoint> exact(double t, std::size_t first = 0,
                                                      bool from_world = true) const;

  std::vector<oracle::ExactJoint> joints;  ///< Joint 0 is the base; without coordinates.
  /// Of each joint, of each coordinate, its pieces; a planar joint's angle is the last.
  std::vector<std::vector<std::vector<oracle::ExactCoordinate>>> coordinates;
  std::vector<std::vector<oracle::MotionPiece>> motions;
};

ChainCase random_chain(std::uint64_t seed, const ChainOptions& options);

/// A random path of a coordinate and its exact pieces.
struct CoordinateCase {
  CoordinatePath path;
  std::vector<oracle::ExactCoordinate> exact;
};
CoordinateCase random_coordinate(Random& random, double size, bool may_wrap);

inline oracle::Vector3<oracle::Wide> exact_point(const Eigen::Vector3d& v) {
  return oracle::exact(oracle::Vector3<double>{v.x(), v.y(), v.z()});
}

}  // namespace firstcontact::test
