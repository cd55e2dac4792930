/// @file
/// The polynomials between two points of a controller, in Bernstein form with intervals.

#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <firstcontact/math/interval.h>

namespace firstcontact {
struct TimedPoint;
}

namespace firstcontact::detail {

/// A polynomial on [0, 1] by its Bernstein coefficients.
///
/// It stays between the least and the greatest of them. Source: G. Farin, "Curves and Surfaces for
/// CAGD", 5th edition, 2002, section 5.1.
struct Bezier {
  std::array<Interval, 6> b = {};
  std::size_t count = 1;

  [[nodiscard]] Interval first() const { return b[0]; }
  [[nodiscard]] Interval last() const { return b[count - 1]; }
  /// A bound of the size of the polynomial.
  [[nodiscard]] double magnitude() const;
  /// The greatest width of a coefficient.
  [[nodiscard]] double greatest_width() const;
  /// Divides it at the middle, by de Casteljau's algorithm.
  [[nodiscard]] std::array<Bezier, 2> halves() const;
};

/// The polynomial of one coordinate between two points, and its derivatives in time.
///
/// It holds for the exact values of the doubles: differences of positions are enclosed, not
/// rounded.
struct SegmentRates {
  Interval seconds;     ///< [s]  Length of the segment.
  Bezier way;           ///< [rad or m]  Position less that of the first point.
  Bezier velocity;      ///< [rad/s or m/s]
  Bezier acceleration;  ///< [rad/s^2 or m/s^2]
  Bezier jerk;          ///< [rad/s^3 or m/s^3]
};

/// The polynomials of one coordinate between two points.
///
/// @param coordinate  index into the numbers of the points
[[nodiscard]] SegmentRates segment_rates(const TimedPoint& from, const TimedPoint& to,
                                         std::size_t coordinate);

/// The greatest size of a polynomial on [0, 1].
struct Peak {
  double attained = 0.0;  ///< A size that the polynomial has, rounded downwards.
  double bound = 0.0;     ///< Upper bound of all sizes.
  double where = 0.0;     ///< [-]  Place of `attained`, in [0, 1].
};

/// Finds the greatest size to a relative 1e-9, or to the width of the coefficients.
///
/// @param known  sizes up to this one need not be distinguished
[[nodiscard]] Peak peak(const Bezier& polynomial, double known = 0.0);

}  // namespace firstcontact::detail
