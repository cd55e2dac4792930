/// @file
/// The path of one joint coordinate over the step: polynomials in time.

#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <firstcontact/math/double_double.h>
#include <firstcontact/math/export.h>

namespace firstcontact {

/// One polynomial piece of a coordinate,
///   q(t) = sum over j of a_j s^j,   s = (t - t_begin) / (t_end - t_begin).
/// The exact coefficients are within `error` of the stored ones, summed over j.
struct FIRSTCONTACT_API CoordinateSegment {
  static constexpr std::size_t kCoefficients = 8;

  double t_begin = 0.0;
  double t_end = 1.0;
  std::array<DoubleDouble, kCoefficients> a = {};  ///< [rad or m]
  std::size_t count = 1;  ///< Number of coefficients in use; the others are 0.
  double error = 0.0;  ///< [rad or m]  Bound of the distance of the exact coefficients, summed over
                       ///< j.

  /// Value and derivatives at a time of the piece.
  struct State {
    DoubleDouble value;         ///< [rad or m]
    double rate = 0.0;          ///< [per step]
    double acceleration = 0.0;  ///< [per step^2]
    double value_error = 0.0;   ///< [rad or m]  Bound of the distance from the exact value.
    double rate_error = 0.0;
    double acceleration_error = 0.0;
  };
  /// The value and the derivatives at a time of the piece.
  [[nodiscard]] State state(double t) const;

  /// Upper bounds of the sizes of the derivatives over a window of time.
  struct Bounds {
    double rate = 0.0;          ///< [per step]
    double acceleration = 0.0;  ///< [per step^2]
    double jerk = 0.0;          ///< [per step^3]
  };
  /// Bounds the derivatives over a window of the piece.
  ///
  /// Derivation: b_j are the coefficients about the window's middle, and r is its half width. Then
  /// the k-th derivative is at most the sum over j >= k of j! / (j - k)! |b_j| r^(j - k). This
  /// exceeds its greatest size by terms of r only.
  [[nodiscard]] Bounds bounds(double t_from, double t_to) const;

  /// [rad or m]  A bound of the size of every value of the piece.
  [[nodiscard]] double size_bound() const;

  /// The coordinate of a joint that mimics this one: multiplier q + offset.
  [[nodiscard]] CoordinateSegment mimicked(double multiplier, double offset) const;

 private:
  [[nodiscard]] State quick_state(double t) const;
  [[nodiscard]] State precise_state(double t) const;
};

/// The way in which a continuous joint turns from one position to the next.
enum class Turning {
  as_given,  ///< Through all angles between the two numbers.
  /// The way of at most half a turn.
  ///
  /// Positions count up to whole turns. The path drops these turns from there on, so that it does
  /// not jump. Half a turn, as doubles have it, goes as given.
  shortest,
};

/// The words of Turning in files and in Python, in this order.
inline constexpr std::array<const char*, 2> kTurningWords{"long", "short"};

/// [rad]  The way of Turning::shortest from one position to another, to the nearest double.
[[nodiscard]] FIRSTCONTACT_API double shortest_way(double from, double to);

/// One coordinate over the step, t in [0, 1]. It rests before the first time and after the last.
///
/// The exact path is the real-number function that the doubles below define.
///
/// All factories throw std::invalid_argument on NaN, infinities, sizes beyond 1e8, wrong counts,
/// and times outside [0, 1] or not strictly increasing.
class FIRSTCONTACT_API CoordinatePath {
 public:
  /// Rests at a position.
  ///
  /// @param position  [rad or m]
  static CoordinatePath constant(double position);

  /// Runs at constant rates between the positions.
  static CoordinatePath linear(std::span<const double> times, std::span<const double> positions,
                               Turning turning = Turning::as_given);

  /// Runs on cubics that have the given velocities too.
  ///
  /// @param velocities  [rad or m per step]
  static CoordinatePath cubic(std::span<const double> times, std::span<const double> positions,
                              std::span<const double> velocities,
                              Turning turning = Turning::as_given);

  /// Runs on quintics that have the given velocities and accelerations too.
  ///
  /// @param accelerations  [rad or m per step^2]
  static CoordinatePath quintic(std::span<const double> times, std::span<const double> positions,
                                std::span<const double> velocities,
                                std::span<const double> accelerations,
                                Turning turning = Turning::as_given);

  /// Runs on given polynomials of degree 7 at most: piece k from times[k] to times[k + 1].
  ///
  ///   q(t) = sum over j of coefficients[k][j] (t - times[k])^j
  /// Neighbouring pieces have to meet within 1e-6, or the coordinate would jump.
  ///
  /// @param coefficients  [rad or m per step^j]
  static CoordinatePath polynomials(std::span<const double> times,
                                    std::span<const std::vector<double>> coefficients);

  /// The pieces in order, without gaps, from 0 to 1.
  [[nodiscard]] std::span<const CoordinateSegment> segments() const { return segments_; }
  [[nodiscard]] Turning turning() const { return turning_; }

 private:
  CoordinatePath(std::vector<CoordinateSegment> segments, Turning turning);

  std::vector<CoordinateSegment> segments_;
  Turning turning_;
};

}  // namespace firstcontact
