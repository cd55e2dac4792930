/// @file
/// Quantities as people read them: a unit of a fitting size, few digits.

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

/// "0.913 µm"
[[nodiscard]] std::string length_text(double metres);

/// As length_text(), but never more than the length: for proven lower bounds.
[[nodiscard]] std::string lower_bound_text(double metres);

/// "0.913 µm or more, proven"; of an infinite distance that there is no pair.
[[nodiscard]] std::string apart_text(double metres);

/// "12.5 ms"
[[nodiscard]] std::string time_text(double seconds);

/// "0.31 N s"
[[nodiscard]] std::string impulse_text(double newton_seconds);

/// "-3.1 mm/s"
[[nodiscard]] std::string speed_text(double metres_per_second);

/// "1 edge", "2 edges"
[[nodiscard]] std::string counted(std::size_t count, const char* what);

/// "1310", "12.4", "0.0371": three digits at least, never a power of ten for what is large.
[[nodiscard]] std::string plain_number(double number);

/// "(0.000, 0.707, -0.707)"
[[nodiscard]] std::string direction_text(const Eigen::Vector3d& direction);

}  // namespace firstcontact::app
