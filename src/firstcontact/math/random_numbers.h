/// @file
/// Random numbers that are the same for a seed with every standard library.

#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace firstcontact {

/// A generator of random numbers, with distributions of its own.
///
/// The standard fixes the bits of its engines, but not those of its distributions. An expression
/// that draws twice has no fixed order, except between braces.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  /// Draws a number in [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Draws a number from `low` to `high`.
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Draws an integer in [0, count).
  ///
  /// @param count  >= 1
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

  /// Draws a point in the ball of radius 1. Rejection from the cube takes 1.9 tries on average.
  Eigen::Vector3d in_ball() {
    Eigen::Vector3d point;
    do {
      for (double& number : point) {
        number = uniform(-1.0, 1.0);
      }
    } while (!(point.squaredNorm() <= 1.0));
    return point;
  }

  /// Draws a vector of length 1.
  Eigen::Vector3d direction() {
    Eigen::Vector3d point;
    do {
      point = in_ball();
    } while (!(point.squaredNorm() > 1e-6));
    return point.normalized();
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace firstcontact
