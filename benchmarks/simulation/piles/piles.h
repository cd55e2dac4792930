/// @file
/// Boxes that fall, rest and pile up on a floor, the same for every engine, and the time of a step.

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact::benchmarks {

constexpr double kStep = 0.01;        // [s]
constexpr double kBoxHalf = 0.1;      // [m]  Cubes.
constexpr double kBoxMass = 8.0;      // [kg]
constexpr double kFriction = 0.5;     // [-]
constexpr double kFloorHalf = 500.0;  // [m]  Half the side of the floor, whose top is at height 0.
constexpr double kFloorThick = 1.0;   // [m]

/// Initial poses of boxes, at rest except for a spin.
struct Pile {
  std::string name;
  std::vector<Eigen::Isometry3d> boxes;  ///< X_WB
  std::vector<Eigen::Vector3d> spins;    ///< [rad/s]
  int steps = 0;                         ///< Number of steps to simulate.
};

/// Simulation of a pile in one engine.
class PileWorld {
 public:
  virtual ~PileWorld() = default;
  virtual void step() = 0;  ///< Advances the time by kStep.
  /// Returns further results of an engine at the end, by name.
  [[nodiscard]] virtual std::vector<std::pair<std::string, double>> remarks() const { return {}; }
};

using LoadPile = std::function<std::unique_ptr<PileWorld>(const Pile&)>;

/// Measures all piles, or those whose names contain NAME: the main function of
/// `program [--quick] OUTPUT.json [NAME]`.
int measure_piles(int argc, char** argv, const std::string& engine, const LoadPile& load);

}  // namespace firstcontact::benchmarks
