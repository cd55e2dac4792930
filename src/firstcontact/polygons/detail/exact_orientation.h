/// @file
/// The exact side of a line on which a point of the plane lies.

#pragma once

#include <compare>
#include <span>

namespace firstcontact::detail {

/// A point of the plane.
///
/// For exact decisions its coordinates have to be 0, or of a size from 2^-484 to 2^480, or
/// multiples of 2^-537 below it.
struct PlanePoint {
  double x = 0.0;  ///< [m]
  double y = 0.0;  ///< [m]

  friend bool operator==(const PlanePoint&, const PlanePoint&) = default;
  /// Orders from left to right, and upwards on a vertical line.
  friend auto operator<=>(const PlanePoint&, const PlanePoint&) = default;
};

/// The sign of the area of the triangle a, b, c: 1 counter-clockwise, -1 clockwise, 0 on a line.
///
/// The determinant (a - c) x (b - c) is evaluated in doubles. Where its error bound leaves the sign
/// open, it is evaluated as an exact sum. Source: J. R. Shewchuk, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates", Discrete & Computational
/// Geometry 18 (1997).
[[nodiscard]] int orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c);

/// Twice the signed area of a closed ring [m^2], rounded once: its sign is exact.
[[nodiscard]] double twice_area(std::span<const PlanePoint> ring);

}  // namespace firstcontact::detail
