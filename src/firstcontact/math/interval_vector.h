/// @file
/// Vectors, matrices and rigid transforms of intervals.
///
/// Every result contains each exact result of members of the operands. Components are independent:
/// the dependence between the columns of a rotation is lost. So enclosures grow with each product.

#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/interval.h>

namespace firstcontact {

/// A box with its faces along the axes.
struct IntervalVector3 {
  std::array<Interval, 3> c = {Interval(0.0), Interval(0.0), Interval(0.0)};

  [[nodiscard]] bool contains(const Eigen::Vector3d& v) const {
    return c[0].contains(v.x()) && c[1].contains(v.y()) && c[2].contains(v.z());
  }
};

inline IntervalVector3 enclose(const Eigen::Vector3d& v) {
  return {{Interval(v.x()), Interval(v.y()), Interval(v.z())}};
}

inline IntervalVector3 enclose(const DoubleDoubleVector3& v) {
  return {{enclose(v.c[0]), enclose(v.c[1]), enclose(v.c[2])}};
}

inline IntervalVector3 operator+(const IntervalVector3& a, const IntervalVector3& b) {
  return {{a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]}};
}

inline IntervalVector3 operator-(const IntervalVector3& a, const IntervalVector3& b) {
  return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}

inline IntervalVector3 operator*(const Interval& s, const IntervalVector3& a) {
  return {{s * a.c[0], s * a.c[1], s * a.c[2]}};
}

inline Interval dot(const IntervalVector3& a, const IntervalVector3& b) {
  return a.c[0] * b.c[0] + a.c[1] * b.c[1] + a.c[2] * b.c[2];
}

inline IntervalVector3 cross(const IntervalVector3& a, const IntervalVector3& b) {
  return {{a.c[1] * b.c[2] - a.c[2] * b.c[1], a.c[2] * b.c[0] - a.c[0] * b.c[2],
           a.c[0] * b.c[1] - a.c[1] * b.c[0]}};
}

inline Interval norm(const IntervalVector3& a) {
  return sqrt(sqr(a.c[0]) + sqr(a.c[1]) + sqr(a.c[2]));
}

/// The smallest box that contains both.
inline IntervalVector3 hull(const IntervalVector3& a, const IntervalVector3& b) {
  return {{hull(a.c[0], b.c[0]), hull(a.c[1], b.c[1]), hull(a.c[2], b.c[2])}};
}

/// All points within `distance` >= 0 of the box along each axis.
inline IntervalVector3 inflated(const IntervalVector3& a, double distance) {
  const Interval margin(-distance, distance);
  return {{a.c[0] + margin, a.c[1] + margin, a.c[2] + margin}};
}

/// A matrix of intervals, by its columns.
struct IntervalMatrix3 {
  std::array<IntervalVector3, 3> columns;

  [[nodiscard]] bool contains(const Eigen::Matrix3d& m) const {
    return columns[0].contains(m.col(0)) && columns[1].contains(m.col(1)) &&
           columns[2].contains(m.col(2));
  }
};

inline IntervalMatrix3 enclose(const Eigen::Matrix3d& m) {
  return {{enclose(Eigen::Vector3d(m.col(0))), enclose(Eigen::Vector3d(m.col(1))),
           enclose(Eigen::Vector3d(m.col(2)))}};
}

inline IntervalVector3 operator*(const IntervalMatrix3& m, const IntervalVector3& v) {
  return v.c[0] * m.columns[0] + v.c[1] * m.columns[1] + v.c[2] * m.columns[2];
}

inline IntervalMatrix3 operator*(const IntervalMatrix3& a, const IntervalMatrix3& b) {
  return {{a * b.columns[0], a * b.columns[1], a * b.columns[2]}};
}

inline IntervalMatrix3 transpose(const IntervalMatrix3& m) {
  IntervalMatrix3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result.columns[i].c[j] = m.columns[j].c[i];
    }
  }
  return result;
}

inline IntervalMatrix3 hull(const IntervalMatrix3& a, const IntervalMatrix3& b) {
  return {{hull(a.columns[0], b.columns[0]), hull(a.columns[1], b.columns[1]),
           hull(a.columns[2], b.columns[2])}};
}

/// Encloses the rotations of v by the angles about the axes.
///
/// By 1 + sin [u] + (1 - cos) [u]^2 applied to v, with 1 - cos = 2 sin^2(angle / 2).
///
/// @param axis   [-]    unit vectors
/// @param angle  [rad]
inline IntervalVector3 rotated(const IntervalVector3& axis, const Interval& angle,
                               const IntervalVector3& v) {
  const IntervalVector3 once = cross(axis, v);
  const Interval versine = Interval(2.0) * sqr(sin(Interval(0.5) * angle));
  return v + sin(angle) * once + versine * cross(axis, once);
}

/// A set of rigid transforms X_WB.
struct IntervalTransform {
  IntervalMatrix3 rotation;  ///< [-]  R_WB
  IntervalVector3 position;  ///< [m]  p_WB

  /// The position p_WP of body point P.
  friend IntervalVector3 operator*(const IntervalTransform& X_WB, const IntervalVector3& p_BP) {
    return X_WB.position + X_WB.rotation * p_BP;
  }
  /// The pose X_WC = X_WB X_BC.
  friend IntervalTransform operator*(const IntervalTransform& X_WB, const IntervalTransform& X_BC) {
    return {X_WB.rotation * X_BC.rotation, X_WB * X_BC.position};
  }
};

inline IntervalTransform inverse(const IntervalTransform& X) {
  const IntervalMatrix3 R = transpose(X.rotation);
  return {R, R * (Interval(-1.0) * X.position)};
}

inline IntervalTransform hull(const IntervalTransform& a, const IntervalTransform& b) {
  return {hull(a.rotation, b.rotation), hull(a.position, b.position)};
}

}  // namespace firstcontact
