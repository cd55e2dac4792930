/// @file
/// Random numbers that are the same with every standard library, unlike <random>'s distributions.

#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  double logarithmic(double low, double high) {
    return low * std::pow(high / low, uniform(0.0, 1.0));
  }

  Eigen::Vector3d direction() {
    const double z = uniform(-1.0, 1.0);
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

  /// Draws a vector of a length between low and high.
  ///
  /// The direction is drawn first: in a product of two draws the compiler would choose the order.
  Eigen::Vector3d vector(double low, double high) {
    const Eigen::Vector3d along = direction();
    return uniform(low, high) * along;
  }

  Eigen::Quaterniond rotation() {
    const Eigen::Vector3d axis = direction();
    return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(0.0, std::numbers::pi), axis));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace firstcontact::test
