/// @file
/// The exact motion that a MotionInput defines.

#pragma once

#include <vector>

#include "support/moving_soup.h"
#include "support/wide.h"

namespace firstcontact::oracle {

/// One piece of a motion: with s = (t - t_begin) / (t_end - t_begin),
///   p_WP = pivot + s travel + Rot(axis, s angle) (lever + R (p_BP - center)).
struct MotionPiece {
  double t_begin = 0.0;
  double t_end = 1.0;
  Vector3<Wide> pivot;
  Vector3<Wide> travel;
  Vector3<Wide> lever;  ///< From the pivot to the center, at t_begin.
  Vector3<Wide> axis;   ///< Unit; zero where the body does not turn.
  Wide angle;           ///< >= 0
  Matrix3<Wide> R;      ///< Orientation at t_begin.
};

/// Splits a motion into its pieces, which cover [0, 1] without gaps.
///
/// @param center  the body point that the levers lead to
std::vector<MotionPiece> motion_pieces(const MotionInput& input, const Vector3<double>& center);

}  // namespace firstcontact::oracle
