/// @file
/// The limits of the rates of joints on a page.

#pragma once

#include <optional>
#include <string>

namespace firstcontact {

/// The limits that the rates of a coordinate of a joint keep. Drawn beside its rates.
struct RateLook {
  std::string robot;
  std::string coordinate;           ///< As trajectories call it.
  double velocity = 0.0;            ///< [rad/s or m/s]
  double acceleration = 0.0;        ///< [rad/s^2 or m/s^2]
  std::optional<double> jerk = {};  ///< [rad/s^3 or m/s^3]
};

}  // namespace firstcontact
