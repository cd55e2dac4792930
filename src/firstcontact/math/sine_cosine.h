/// @file
/// Sine and cosine with proven error bounds, in double and in double-double.

#pragma once

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// The greatest angle in size, so that the argument reduction keeps its bound.
inline constexpr double kMaximumAngle = 1e8;  // [rad]

/// A sine and a cosine.
struct SineCosine {
  double sine = 0.0;
  double cosine = 1.0;
};

/// A sine and a cosine in double-double.
struct DoubleDoubleSineCosine {
  DoubleDouble sine = 0.0;
  DoubleDouble cosine = 1.0;
};

/// Computes sine and cosine of a double-double angle, each within 2^-51 of the exact value.
///
/// Derivation: the reduced angle r = rh + rl, |r| <= 0.786, is known to 2^-102, as pi/2 is taken to
/// 163 bits. The Taylor remainders of degree 19 and 18 are below 2^-58. Rounding stays below 2^-52.
///
/// @param angle  [rad]  at most kMaximumAngle in size
FIRSTCONTACT_API SineCosine sine_cosine(const DoubleDouble& angle);

/// Computes sine and cosine in double-double arithmetic, each within 2^-98 of the exact value.
///
/// @param angle  [rad]  at most kMaximumAngle in size
FIRSTCONTACT_API DoubleDoubleSineCosine precise_sine_cosine(const DoubleDouble& angle);

}  // namespace firstcontact
