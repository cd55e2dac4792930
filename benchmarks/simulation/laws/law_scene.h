/// @file
/// The scenes of laws.py, and the runs that it reads, for engines without readers of either.

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace firstcontact::benchmarks {

struct LawShape {
  enum class Kind { box, sphere, cylinder, capsule, ellipsoid };
  Kind kind = Kind::box;
  Eigen::Vector3d half =
      Eigen::Vector3d::Zero();  ///< [m]  The radius is in x, half the length in z.
};

enum class LawMotion { rests, spins, free };

struct LawBody {
  LawShape shape;
  LawMotion motion = LawMotion::rests;
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  ///< [m]  Position of the centre of mass.
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();        ///< [m/s]
  Eigen::Vector3d w = Eigen::Vector3d::Zero();        ///< [rad/s]  World axes.
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();  ///< [kg m^2]  Moments of inertia about the
                                                      ///< axes of the body.
  double restitution = 0.0;
  Eigen::Vector3d p_CS = Eigen::Vector3d::Zero();  ///< [m]  Shape's origin from the centre of mass.
};

/// Robot of a scene; the URDF of one with a free base has the same robot as MJCF beside it.
struct LawRobot {
  std::filesystem::path urdf;
  std::vector<double> positions = {};    ///< Coordinates of joints in the order of the file.
  std::vector<double> stiffnesses = {};  ///< [N/m or N m/rad]  Stiffnesses of springs at rest at 0.
  std::vector<double> velocities = {};   ///< Velocities of joints.
  bool is_free = false;                  ///< Whether the base is free; it starts at the origin.
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< [m/s]    Velocity of a free base.
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< [rad/s]
};

/// Momenta and kinetic energy of all free bodies and robots.
struct LawTotals {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();          ///< [kg m/s]
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< [kg m^2/s]  About the origin.
  double kinetic_energy = 0.0;                                 ///< [J]
};

struct LawScene {
  double step = 0.0;      ///< [s]
  double duration = 0.0;  ///< [s]
  double gravity = 0.0;   ///< [m/s^2]  Along -z.
  double friction = 0.0;
  std::vector<LawBody> bodies = {};
  std::vector<LawRobot> robots = {};
};

/// Simulation of a scene in one engine.
class LawEngine {
 public:
  virtual ~LawEngine() = default;
  virtual void step() = 0;
  [[nodiscard]] virtual LawBody body(
      std::size_t k) const = 0;  ///< Has the present pose and velocities.
  [[nodiscard]] virtual std::vector<double> positions(std::size_t robot) const = 0;
  /// Returns the momenta and the kinetic energy of the robots.
  [[nodiscard]] virtual LawTotals robots() { return {}; }
};

/// Reads a scene, lets an engine simulate it, and writes the run: `laws_ENGINE SCENE RUN`.
///
/// @returns the exit status; 3 where the scene is not for this engine: it has a mesh, ties, or
///         robots that the engine does not support
int simulate_law(int argc, char** argv, bool has_robots,
                 const std::function<std::unique_ptr<LawEngine>(const LawScene&)>& load);

}  // namespace firstcontact::benchmarks
