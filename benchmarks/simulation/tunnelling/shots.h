/// @file
/// Boxes of 1 cm shot at a plate of 0.1 mm, the same for every engine, and their outcomes.

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace firstcontact::benchmarks {

constexpr double kStep = 1.0 / 60.0;      // [s]
constexpr double kBoxHalf = 0.005;        // [m]
constexpr double kPlateHalf = 0.5;        // [m]  Along y and z.
constexpr double kPlateHalfThick = 5e-5;  // [m]  Along x; the plate rests at the origin.
constexpr double kBoxMass = 2.7e-3;       // [kg]  A box of aluminium.

/// Box that flies at the plate along x and turns, without gravity.
///
/// There is no friction and no restitution, so that no box gets around the plate.
struct Shot {
  double speed = 0.0;                              ///< [m/s]
  Eigen::Isometry3d X_WB;                          ///< Initial pose of the box, before the plate.
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();  ///< [rad/s]  World axes.
};

/// Simulation of a shot in one engine.
class Flight {
 public:
  virtual ~Flight() = default;
  virtual void step() = 0;                                  ///< Advances the time by kStep.
  [[nodiscard]] virtual Eigen::Isometry3d box() const = 0;  ///< X_WB
  [[nodiscard]] virtual bool proven() const {
    return false;
  }  ///< Whether it is proven that no
     ///< bodies met inside.
};

/// An engine with one of its settings.
struct Contender {
  std::string name;
  std::function<std::unique_ptr<Flight>(const Shot&)> load;
};

/// Corners and triangles of a box at the origin; the normals of the triangles point outwards.
struct BoxMesh {
  std::vector<Eigen::Vector3d> corners;  ///< [m]
  std::vector<Eigen::Vector3i> triangles;
};
[[nodiscard]] BoxMesh plate_mesh();

/// Shoots all boxes with every contender, and writes the outcomes: the main function of `program
/// [--quick] OUTPUT.json`.
int shoot(int argc, char** argv, const std::vector<Contender>& contenders);

}  // namespace firstcontact::benchmarks
