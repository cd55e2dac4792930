/// @file
/// Rigid transforms in double-double.

#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/math/double_double.h>
#include <firstcontact/motion/pose.h>

namespace firstcontact {

/// The rigid transform X_AB: p_AP = position + R p_BP; numbers are within 2^-96 of their operands'
/// sizes.
struct PreciseTransform {
  std::array<DoubleDoubleVector3, 3> columns = {DoubleDoubleVector3(1.0, 0.0, 0.0),
                                                DoubleDoubleVector3(0.0, 1.0, 0.0),
                                                DoubleDoubleVector3(0.0, 0.0, 1.0)};
  DoubleDoubleVector3 position = {};

  [[nodiscard]] DoubleDoubleVector3 rotated(const DoubleDoubleVector3& v) const {
    return v.c[0] * columns[0] + v.c[1] * columns[1] + v.c[2] * columns[2];
  }

  friend PreciseTransform operator*(const PreciseTransform& a, const PreciseTransform& b) {
    return {{a.rotated(b.columns[0]), a.rotated(b.columns[1]), a.rotated(b.columns[2])},
            a.position + a.rotated(b.position)};
  }
};

/// The inverse X_BA of X_AB, whose columns are orthogonal to 2^-90.
inline PreciseTransform inverse(const PreciseTransform& X_AB) {
  PreciseTransform X_BA;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      X_BA.columns[j].c[i] = X_AB.columns[i].c[j];
    }
  }
  X_BA.position = DoubleDouble(-1.0) * X_BA.rotated(X_AB.position);
  return X_BA;
}

/// The exact transform of a pose: its quaternion is divided by its length.
inline PreciseTransform precise(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  const DoubleDouble w = q.w();
  const DoubleDoubleVector3 v(Eigen::Vector3d(q.vec()));
  const DoubleDouble scale = DoubleDouble(2.0) / (w * w + dot(v, v));
  PreciseTransform X;
  X.position = DoubleDoubleVector3(pose.position);
  for (DoubleDoubleVector3& column : X.columns) {
    const DoubleDoubleVector3 once = cross(v, column);
    column = column + scale * (w * once + cross(v, once));
  }
  return X;
}

/// The direction of v, whose size is within 1e-60 ... 1e60.
inline DoubleDoubleVector3 precise_direction(const Eigen::Vector3d& v) {
  const DoubleDoubleVector3 exact(v);
  return (DoubleDouble(1.0) / norm(exact)) * exact;
}

}  // namespace firstcontact
