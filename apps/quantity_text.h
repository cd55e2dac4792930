/// @file
/// Quantities for people: a unit of a fitting size, few digits.

#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Core>

namespace firstcontact::app {

/// A unit that suits numbers of some size.
struct Unit {
  const char* name;
  double size;  ///< In SI units.
};

[[nodiscard]] Unit length_unit(double metres);
[[nodiscard]] Unit time_unit(double seconds);

/// A length as text: "0.913 µm".
[[nodiscard]] std::string length_text(double metres);

/// A proven lower bound as text; as length_text(), but never above the length.
[[nodiscard]] std::string lower_bound_text(double metres);

/// A distance as text: "0.913 µm or more, proven"; for an infinite one that there is no pair.
[[nodiscard]] std::string apart_text(double metres);

/// A time as text: "12.5 ms".
[[nodiscard]] std::string time_text(double seconds);

/// An impulse as text: "0.31 N s".
[[nodiscard]] std::string impulse_text(double newton_seconds);

/// A speed as text: "-3.1 mm/s".
[[nodiscard]] std::string speed_text(double metres_per_second);

/// A counted thing as text: "1 edge", "2 edges".
[[nodiscard]] std::string counted(std::size_t count, const char* what);

/// A number as text: "1310", "12.4", "0.0371"; at least three digits, and no power of ten for large
/// numbers.
[[nodiscard]] std::string plain_number(double number);

/// A direction as text: "(0.000, 0.707, -0.707)".
[[nodiscard]] std::string direction_text(const Eigen::Vector3d& direction);

}  // namespace firstcontact::app
