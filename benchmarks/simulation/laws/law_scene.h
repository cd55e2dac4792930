/// @file
/// The scenes of laws.py, and the runs that it reads, for engines that know neither.

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
  enum class Kind { box, sphere, cylinder };
  Kind kind = Kind::box;
  Eigen::Vector3d half =
      Eigen::Vector3d::Zero();  ///< [m]  A radius stands in x, half a length in z.
};

enum class LawMotion { rests, spins, free };

struct LawBody {
  LawShape shape;
  LawMotion motion = LawMotion::rests;
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();        ///< [m/s]
  Eigen::Vector3d w = Eigen::Vector3d::Zero();        ///< [rad/s]  World axes.
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();  ///< [kg m^2]  About the axes of the body.
  double restitution = 0.0;
};

/// A robot with a fixed base.
struct LawRobot {
  std::filesystem::path urdf;
  std::vector<double> positions = {};    ///< In the order of the file.
  std::vector<double> stiffnesses = {};  ///< [N/m or N m/rad]  Of springs whose rest is at 0.
};

struct LawScene {
  double step = 0.0;      ///< [s]
  double duration = 0.0;  ///< [s]
  double gravity = 0.0;   ///< [m/s^2]  Along -z.
  double friction = 0.0;
  std::vector<LawBody> bodies = {};
  std::vector<LawRobot> robots = {};
};

/// What an engine does with a scene.
class LawEngine {
 public:
  virtual ~LawEngine() = default;
  virtual void step() = 0;
  [[nodiscard]] virtual LawBody body(
      std::size_t k) const = 0;  ///< With pose and velocities of now.
  [[nodiscard]] virtual std::vector<double> positions(std::size_t robot) const = 0;
};

/// Reads a scene, lets an engine simulate it, and writes the run: `laws_ENGINE SCENE RUN`.
///
/// @returns the exit status: 3 where the engine has no robots and the scene has
int simulate_law(int argc, char** argv, bool has_robots,
                 const std::function<std::unique_ptr<LawEngine>(const LawScene&)>& load);

}  // namespace firstcontact::benchmarks
