/// @file
/// Sine and cosine with proven error bounds, in double and in double-double.

#pragma once

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// Angles beyond this are refused, so that the argument reduction keeps its bound.
inline constexpr double kMaximumAngle = 1e8;  // [rad]

struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};

struct DoubleDoubleSineCosine {
  DoubleDouble sine = 0.0;
  DoubleDouble cosine = 1.0;
};

/// Sine and cosine of a double-double angle, each within 2^-51 of the exact value.
///
/// Derivation: the reduced angle r = rh + rl, |r| <= 0.786, is known to 2^-102 (pi/2 is taken to
/// 163 bits); the Taylor remainders of degree 19 and 18 are below 2^-58; rounding stays below
/// 2^-52.
///
/// @param angle  [rad]  at most kMaximumAngle in size
FIRSTCONTACT_API SineCosine sine_cosine(const DoubleDouble& angle);

/// The same in double-double arithmetic, each within 2^-98 of the exact value.
///
/// @param angle  [rad]  at most kMaximumAngle in size
FIRSTCONTACT_API DoubleDoubleSineCosine precise_sine_cosine(const DoubleDouble& angle);

}  // namespace firstcontact
