/// @file
/// Random motions of two bodies of radius 1 that start apart.

#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/motion.h>

namespace firstcontact::benchmarks {

/// Motion of constant velocity as plain numbers, from which every peer makes its own motion.
struct PlainMotion {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]  Position at t = 0.
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]  Displacement over the step.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]  Rotation over the step.

  [[nodiscard]] Motion motion() const;
  [[nodiscard]] Eigen::Isometry3d pose(double t) const;
};

struct PlainMotionPair {
  PlainMotion A;
  PlainMotion B;
};

/// Makes motions that start at a gap of 0.003 m to 0.5 m, the same for a seed on every run.
///
/// Each body turns by 0 to 90 degrees about its own axis; one in five does not turn. The bodies
/// move 0.1 m to 3 m relative to each other, and each does a random part of it. Three in five pairs
/// move roughly towards each other.
///
/// @param A, B  of bounding radius 1 m about the origin
[[nodiscard]] std::vector<PlainMotionPair> random_motions(const Shape& A, const Shape& B, int count,
                                                          std::uint64_t seed);

}  // namespace firstcontact::benchmarks
