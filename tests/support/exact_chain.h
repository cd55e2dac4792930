/// @file
/// Exact pose of a link on a chain of joints: the oracle of articulated motion.

#pragma once

#include <vector>

#include "support/exact_motion.h"
#include "support/vector3.h"
#include "support/wide.h"

namespace firstcontact::oracle {

/// Coordinate on one piece of time, as the given numbers define it; or a constant one.
struct ExactCoordinate {
  double t_begin = 0.0;
  double t_end = 1.0;
  std::vector<double> begin;         ///< Position, velocity, acceleration: as many as are given.
  std::vector<double> end;           ///< The same at t_end; empty for a given polynomial.
  std::vector<double> coefficients;  ///< Coefficients of (t - t_begin)^j, for a given polynomial.
  int turns_before = 0;     ///< Whole turns to subtract from the given position at the begin.
  int turns = 0;            ///< Further whole turns to subtract from the given position at the end.
  double multiplier = 1.0;  ///< Factor of a mimicking joint.
  double offset = 0.0;

  [[nodiscard]] Wide value(const Wide& t) const;
};

/// One joint: a fixed pose, then a slide by each coordinate along a direction, then a turn about
struct ExactJoint {
  Vector3<double> position;             ///< Position of X_PJ.
  double w = 1.0, x = 0, y = 0, z = 0;  ///< Quaternion of X_PJ, of any length.
  std::vector<Vector3<Wide>> directions;
  std::vector<ExactCoordinate> slides;
  Vector3<double> axis{0, 0, 1};       ///< Axis, of any length.
  std::vector<ExactCoordinate> angle;  ///< Rotation about the axis: none or one coordinate.
  double pitch = 0.0;                  ///< Translation along the axis per unit of angle.
  std::vector<MotionPiece> motion;     ///< None or one: a given motion about the origin, applied
                                       ///< first.
};

/// Computes p_FP(t) of point P of the last link.
Vector3<Wide> exact_place(const std::vector<ExactJoint>& chain, const Wide& t,
                          const Vector3<Wide>& p_LP);

/// Computes the velocity of P as the exact difference quotient over 2^-70.
///
/// The error is at most 2^-70 times the acceleration.
Vector3<Wide> nearly_exact_velocity(const std::vector<ExactJoint>& chain, double t,
                                    const Vector3<Wide>& p_LP);

}  // namespace firstcontact::oracle
