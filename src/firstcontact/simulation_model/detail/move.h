/// @file
/// The motion of a body over a part of a step.

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/motion/motion.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact::detail {

struct SimBody;

/// A displacement of a body over some time, from a pose.
struct Move {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();      ///< [m]  Displacement of C.
  Eigen::Vector3d rotation_vector = Eigen::Vector3d::Zero();  ///< [rad]

  [[nodiscard]] bool is_none() const { return !translation.any() && !rotation_vector.any(); }
  [[nodiscard]] Move part(double share) const {
    return {share * translation, share * rotation_vector};
  }
};

/// The motion over t in [0, 1] of a move.
[[nodiscard]] Motion motion_of(const SimBody& body, const Pose& X_WB, const Move& move);

/// A box around the thickened surface over the whole move.
[[nodiscard]] Eigen::AlignedBox3d swept_box(const SimBody& body, const Pose& X_WB,
                                            const Move& move);

}  // namespace firstcontact::detail
