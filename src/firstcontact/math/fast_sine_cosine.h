/// @file
/// Sines and cosines of two doubles at a time, fast and with a proven error bound.

#pragma once

#include <array>
#include <bit>
#include <cmath>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/sine_cosine.h>

namespace firstcontact {

/// Computes sine and cosine of two angles, each within 2^-51 of the exact value.
///
/// The code is inline, in the two lanes of one register, without branches that depend on an angle's
/// quadrant.
///
/// Derivation, u = 2^-53. For |angle| <= 10^6 the multiple k of pi/2 is below 2^20. So its product
/// with the first 33 bits of pi/2 is exact, and the rest of pi/2 times k errs by less than 2^-66.
/// The two subtractions err by u |r| each, |r| <= 0.786. The Taylor remainders of degree 19 and 18
/// are below 2^-58. The polynomials in z = r^2 err by less than u, as their terms after the first
/// are below |r|^3 / 6 and 0.31. The last sum errs by half a unit. Beyond 10^6 the double-double
/// reduction takes over.
///
/// @param a, b  [rad]  at most kMaximumAngle in size
inline std::array<SineCosine, 2> fast_sine_cosine(double a, double b) {
  using Lanes [[gnu::vector_size(16)]] = double;
  using Bits [[gnu::vector_size(16)]] = long long;
  if (!(std::abs(a) <= 1e6 && std::abs(b) <= 1e6)) {
    return {sine_cosine(DoubleDouble(a)), sine_cosine(DoubleDouble(b))};
  }
  constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
  constexpr double kHalfPiHead = 0x1.921fb544p+0;  // 33 bits
  constexpr double kHalfPiTail = 0x1.0b4611a626331p-34;
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: an integer stands in the last bits.
  const Lanes angle = {a, b};
  const Lanes shifted = angle * kTwoOverPi + kRound;
  const Lanes k = shifted - kRound;
  const Lanes r = (angle - k * kHalfPiHead) - k * kHalfPiTail;
  const Lanes z = r * r;
  const Lanes z2 = z * z;
  const Lanes z4 = z2 * z2;
  // 1/3!, 1/5!, ... and 1/2!, 1/4!, ... by Estrin's scheme, shorter in latency than Horner's.
  const Lanes s = ((-1.0 / 6.0 + z * (1.0 / 120.0)) + z2 * (-1.0 / 5040.0 + z * (1.0 / 362880.0))) +
                  z4 * ((-1.0 / 39916800.0 + z * (1.0 / 6227020800.0)) +
                        z2 * (-1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0)));
  const Lanes c = ((-1.0 / 2.0 + z * (1.0 / 24.0)) + z2 * (-1.0 / 720.0 + z * (1.0 / 40320.0))) +
                  z4 * ((-1.0 / 3628800.0 + z * (1.0 / 479001600.0)) +
                        z2 * (-1.0 / 87178291200.0 + z * (1.0 / 20922789888000.0)));
  const Bits sine = std::bit_cast<Bits>(r + r * (z * s));
  const Bits cosine = std::bit_cast<Bits>(1.0 + z * c);
  const Bits quadrant = std::bit_cast<Bits>(shifted);
  const Bits swap = -(quadrant & 1);
  const Bits sine_sign = (quadrant & 2) << 62;
  const Bits cosine_sign = ((quadrant + 1) & 2) << 62;
  const Lanes sines = std::bit_cast<Lanes>(((sine & ~swap) | (cosine & swap)) ^ sine_sign);
  const Lanes cosines = std::bit_cast<Lanes>(((cosine & ~swap) | (sine & swap)) ^ cosine_sign);
  return {{{sines[0], cosines[0]}, {sines[1], cosines[1]}}};
}

/// Computes sine and cosine of one angle in double-double, |angle.lo| at most half a unit in the
/// last place of hi.
///
/// Derivation: up to 10^6 the tail is below 2^-33 and its square below 2^-66. The tail enters by
/// the derivative, with another rounding of half a unit. The errors above sum up to 3.1 u.
inline SineCosine fast_sine_cosine(const DoubleDouble& angle) {
  if (!(std::abs(angle.hi) <= 1e6)) {
    return sine_cosine(angle);
  }
  const SineCosine sc = fast_sine_cosine(angle.hi, angle.hi)[0];
  return {sc.sine + angle.lo * sc.cosine, sc.cosine - angle.lo * sc.sine};
}

}  // namespace firstcontact
