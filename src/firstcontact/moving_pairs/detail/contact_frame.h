/// @file
/// Two bodies at the instant of their contacts.

#pragma once

#include <Eigen/Core>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>

namespace firstcontact::detail {

/// The shapes and the frame relative to which contacts are reported.
struct ContactFrame {
  const Shape& A;
  const Shape& B;
  const MovingPair& pair;
  double t;
  Eigen::Vector3d p_WC;  ///< [m]  Centre of A's hierarchy in the world at t.
  double beside = 0.0;   ///< [m]  As in close_features(); 0 where all features are wanted.
};

}  // namespace firstcontact::detail
