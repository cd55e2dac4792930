/// @file
/// Random numbers and vectors of the same bits with every compiler: + - * / and square roots only.
///
/// No expression may draw twice, except in braces, whose order of evaluation is fixed.

#pragma once

#include <cmath>
#include <cstdint>

#include "support/moving_soup.h"
#include "support/vector3.h"

namespace firstcontact::oracle {

/// SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
class PortableRandom {
 public:
  explicit PortableRandom(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  int integer(int low, int high) {
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }
  /// Draws a power of ten with a whole exponent, times 1 to 10 where it is `smooth`.
  double power_of_ten(int low, int high, bool smooth = true) {
    double value = smooth ? uniform(1.0, 10.0) : 1.0;
    for (int e = integer(low, high); e != 0; e += e < 0 ? 1 : -1) {
      value = e < 0 ? value / 10.0 : value * 10.0;
    }
    return value;
  }
  Vector3<double> in_box(double half) {
    const double x = uniform(-half, half);
    const double y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  Vector3<double> unit() {
    for (;;) {
      const Vector3<double> v = in_box(1.0);
      const double l2 = dot(v, v);
      if (l2 > 0.01 && l2 <= 1.0) {
        return (1.0 / std::sqrt(l2)) * v;
      }
    }
  }
  /// Draws a vector of a length between low and high.
  Vector3<double> vector(double low, double high) {
    const double length = uniform(low, high);
    return length * unit();
  }
  Quaternion rotation() {
    const Vector3<double> v = in_box(1.0);
    return {uniform(-1.0, 1.0) + 0x1p-20, v.x, v.y, v.z};
  }

 private:
  std::uint64_t state_;
};

}  // namespace firstcontact::oracle
