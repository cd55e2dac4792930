/// @file
/// Random numbers that are the same with every standard library.

#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Core>

namespace firstcontact::detail {

/// Random numbers from one seed. The distributions of the standard are not fixed, so these are own.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  double uniform(double from, double to) { return from + (to - from) * uniform(); }

  /// In the ball of radius 1. Rejection from the cube takes 1.9 tries on average.
  Eigen::Vector3d in_ball() {
    Eigen::Vector3d point;
    do {
      for (double& number : point) {
        number = uniform(-1.0, 1.0);
      }
    } while (!(point.squaredNorm() <= 1.0));
    return point;
  }

  /// Of length 1.
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

}  // namespace firstcontact::detail
