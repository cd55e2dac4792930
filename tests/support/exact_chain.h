/// @file
/// Where the exact chain of joints puts a link: the oracle of articulated motion.

#pragma once

#include <vector>

#include "support/exact_motion.h"
#include "support/vector3.h"
#include "support/wide.h"

namespace firstcontact::oracle {

/// A coordinate on one piece of time, as the numbers given say it; or a constant one.
struct ExactCoordinate {
  double t_begin = 0.0;
  double t_end = 1.0;
  std::vector<double> begin;         ///< Position, velocity, acceleration: as many as there are.
  std::vector<double> end;           ///< The same at t_end; empty for a given polynomial.
  std::vector<double> coefficients;  ///< Of (t - t_begin)^j, for a given polynomial.
  int turns_before = 0;              ///< Whole turns less than the position at the begin says.
  int turns = 0;                     ///< Further ones less than the position at the end says.
  double multiplier = 1.0;           ///< What a mimicking joint makes of it.
  double offset = 0.0;

  [[nodiscard]] Wide value(const Wide& t) const;
};

/// One joint: a fixed pose, then a slide by each coordinate along a direction, then a turn about
struct ExactJoint {
  Vector3<double> position;             ///< Of X_PJ.
  double w = 1.0, x = 0, y = 0, z = 0;  ///< Its quaternion, of any length.
  std::vector<Vector3<Wide>> directions;
  std::vector<ExactCoordinate> slides;
  Vector3<double> axis{0, 0, 1};       ///< Of any length.
  std::vector<ExactCoordinate> angle;  ///< None or one.
  double pitch = 0.0;                  ///< Slides along the axis by this much an angle.
  std::vector<MotionPiece> motion;     ///< None or one: a given motion about the origin, first.
};

/// p_FP(t) of point P of the last link.
Vector3<Wide> exact_place(const std::vector<ExactJoint>& chain, const Wide& t,
                          const Vector3<Wide>& p_LP);

/// Its velocity: the exact difference quotient over 2^-70, within 2^-70 of accelerations.
Vector3<Wide> nearly_exact_velocity(const std::vector<ExactJoint>& chain, double t,
                                    const Vector3<Wide>& p_LP);

}  // namespace firstcontact::oracle
