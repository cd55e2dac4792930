/// @file
/// Sine and cosine of a double, fast and with a proven error bound.

#pragma once

#include <cmath>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {

/// Sine and cosine of a double angle, each within 2^-51 of the exact value; inline, without
/// branches that depend on the angle's quadrant.
///
/// Derivation, u = 2^-53: for |angle| <= 10^6 the multiple k of pi/2 is below 2^20, so that its
/// product with the first 33 bits of pi/2 is exact, and the rest of pi/2 times k errs by less than
/// 2^-66; the two subtractions err by u |r| each, |r| <= 0.786. The Taylor remainders of degree 19
/// and 18 are below 2^-58; the polynomials in z = r^2 err by less than u (their terms after the
/// first are below |r|^3 / 6 and 0.31), and the last sum by half a unit. Beyond 10^6 the
/// double-double reduction takes over.
///
/// @param angle  [rad]  at most kMaximumAngle in size
inline SineCosine fast_sine_cosine(double angle) {
  if (!(std::abs(angle) <= 1e6)) {
    return sine_cosine(DoubleDouble(angle));
  }
  constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
  constexpr double kHalfPiHead = 0x1.921fb544p+0;  // 33 bits
  constexpr double kHalfPiTail = 0x1.0b4611a626331p-34;
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: rounds to an integer
  const double k = (angle * kTwoOverPi + kRound) - kRound;
  const double r = (angle - k * kHalfPiHead) - k * kHalfPiTail;
  const double z = r * r;
  const double z2 = z * z;
  const double z4 = z2 * z2;
  // 1/3!, 1/5!, ... and 1/2!, 1/4!, ... by Estrin's scheme, shorter in latency than Horner's.
  const double s =
      ((-1.0 / 6.0 + z * (1.0 / 120.0)) + z2 * (-1.0 / 5040.0 + z * (1.0 / 362880.0))) +
      z4 * ((-1.0 / 39916800.0 + z * (1.0 / 6227020800.0)) +
            z2 * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0)));
  const double c = ((-1.0 / 2.0 + z * (1.0 / 24.0)) + z2 * (-1.0 / 720.0 + z * (1.0 / 40320.0))) +
                   z4 * ((-1.0 / 3628800.0 + z * (1.0 / 479001600.0)) +
                         z2 * (-1.0 / 87178291200.0 + z * (1.0 / 20922789888000.0)));
  const double sine = r + r * (z * s);
  const double cosine = 1.0 + z * c;
  const auto quadrant = static_cast<long long>(k);
  const bool swap = (quadrant & 1) != 0;
  const double a = swap ? cosine : sine;
  const double b = swap ? sine : cosine;
  return {(quadrant & 2) != 0 ? -a : a, ((quadrant + 1) & 2) != 0 ? -b : b};
}

}  // namespace firstcontact
