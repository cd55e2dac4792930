/// @file
/// The verifier's own arithmetic for the coordinates of joints: polynomials in time.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <firstcontact/math/interval.h>
#include <firstcontact/robot/coordinate_path.h>

namespace firstcontact::detail {

/// A coordinate in a window of time. Bounds of sizes hold for the whole window.
struct CoordinateWindow {
  Interval value{0.0};  ///< [rad or m]  Value in its middle.
  Interval rate{0.0};   ///< Rate in its middle, per unit of time.
  double size = 0.0;    ///< [rad or m]  Bound of the size.
  double rate_size = 0.0;
  double acceleration_size = 0.0;
};

/// The polynomial q(t) = sum over j of a_j s^j, s = (t - from) / (to - from).
struct CoordinatePolynomial {
  static constexpr std::size_t kMost = 6;

  double from = 0.0;
  double to = 1.0;
  std::array<Interval, kMost> a = {Interval(0.0), Interval(0.0), Interval(0.0),
                                   Interval(0.0), Interval(0.0), Interval(0.0)};
  std::size_t count = 1;  ///< Number of coefficients in use.

  /// The values in a window.
  ///
  /// @param time  the middle of the window, between from and to
  /// @param half  half the length of the window
  [[nodiscard]] CoordinateWindow around(double time, double half) const;
};

/// A coordinate over the scene, t from 0 to 1, piece by piece.
class CoordinateCourse {
 public:
  /// Makes a coordinate that rests.
  explicit CoordinateCourse(double position);

  /// Makes a coordinate through positions at times; with velocities and accelerations where they
  /// are given.
  ///
  /// It rests before the first time and after the last.
  CoordinateCourse(std::span<const double> times, std::span<const double> positions,
                   std::span<const double> velocities, std::span<const double> accelerations,
                   Turning turning);

  /// The coordinate multiplier q + offset.
  [[nodiscard]] CoordinateCourse scaled(double multiplier, double offset) const;

  [[nodiscard]] std::span<const CoordinatePolynomial> pieces() const { return pieces_; }

  /// The piece that holds t, the earlier one where two do.
  [[nodiscard]] const CoordinatePolynomial& at(double t) const;

 private:
  std::vector<CoordinatePolynomial> pieces_;
};

}  // namespace firstcontact::detail
