/// @file
/// The scenes of laws.py, and the runs that it reads, for engines without readers of either.

#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace firstcontact::benchmarks {

struct LawShape {
  enum class Kind { box, sphere, cylinder, capsule, ellipsoid, hull };
  Kind kind = Kind::box;
  Eigen::Vector3d half =
      Eigen::Vector3d::Zero();                ///< [m]  The radius is in x, half the length in z.
  std::vector<Eigen::Vector3d> corners = {};  ///< [m]  Corners of a convex hull.
  Eigen::Vector3d p_BS = Eigen::Vector3d::Zero();  ///< [m]  Place in the frame of the body.
};

/// What moves: its mass, and its pose and velocities at the centre of mass.
struct LawState {
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();  ///< [kg m^2]  Moments of inertia about the
                                                      ///< axes of the body.
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();     ///< [m]
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< [rad/s]  World axes.
};

enum class LawMotion {
  rests,
  spins,
  free,
  plane  ///< Free in x and z, and to turn about y.
};

/// Body whose frame has its origin at the centre of mass.
struct LawBody {
  std::string name = {};
  std::vector<LawShape> shapes = {};
  LawMotion motion = LawMotion::rests;
  LawState start = {};
  double restitution = 0.0;
};

/// A value at each time [s], with lines between them.
using LawRows = std::vector<std::pair<double, double>>;

double value_at(const LawRows& rows, double time);
/// Integrates the rows from 0 to a time.
double integral_to(const LawRows& rows, double time);

struct LawMotor {
  enum class Kind { none, spring, position, velocity };
  Kind kind = Kind::none;
  double stiffness = 0.0;  ///< [N/m or N m/rad]
  double damping = 0.0;    ///< [N s/m or N m s/rad]
  LawRows target = {};     ///< Position or velocity.
};

struct LawLink {
  std::string name = {};
  int parent = -1;         ///< Number of the link that the joint moves it on, or -1: the root link.
  std::string joint = {};  ///< Empty for the root link.
  bool is_slide = false;   ///< Whether the joint is prismatic; otherwise it is a hinge.
  Eigen::Vector3d p_PJ = Eigen::Vector3d::Zero();     ///< [m]  Joint in the parent's frame.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();    ///< Axis of the joint.
  double damping = 0.0;                               ///< [N s/m or N m s/rad]
  double mass = 0.0;                                  ///< [kg]
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();     ///< [m]  Centre of mass.
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();  ///< [kg m^2]  Moments of inertia about the
                                                      ///< centre of mass.
  std::vector<LawShape> shapes = {};
  double position = 0.0;  ///< Coordinate and velocity of the joint at the start.
  double velocity = 0.0;
  LawMotor motor = {};
};

/// Robot whose links are parallel to the root link where all coordinates are 0.
struct LawRobot {
  std::string name = {};
  std::vector<LawLink> links = {};                 ///< Parents first.
  bool is_free = false;                            ///< Whether the root link is free.
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();  ///< [m]  Root link at the start.
  Eigen::Quaterniond q_WL = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v = Eigen::Vector3d::Zero();  ///< [m/s]  Velocities of a free root link.
  Eigen::Vector3d w = Eigen::Vector3d::Zero();  ///< [rad/s]  World axes.
};

/// A spring along a line, or a pin, between points of two bodies or links.
struct LawTie {
  enum class Kind { spring, pin };
  struct End {
    int robot = -1;   ///< Number of the robot, or -1: a body.
    int member = -1;  ///< Number of the body or link, or -1: the world.
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< [m]  In the frame of the body or link.
  };
  Kind kind = Kind::spring;
  std::array<End, 2> ends = {};
  double stiffness = 0.0;  ///< [N/m]
  double length = 0.0;     ///< [m]
};

struct LawScene {
  double step = 0.0;      ///< [s]
  double duration = 0.0;  ///< [s]
  double gravity = 0.0;   ///< [m/s^2]  Along -z.
  double friction = 0.0;
  std::vector<LawBody> bodies = {};
  std::vector<LawRobot> robots = {};
  std::vector<LawTie> ties = {};
  std::string integrator = {};  ///< Which of the integrators of the engine; empty: its default.
};

/// Simulation of a scene in one engine.
class LawEngine {
 public:
  virtual ~LawEngine() = default;
  virtual void step() = 0;
  /// Returns the present state of a body.
  [[nodiscard]] virtual LawState body(std::size_t k) = 0;
  /// Returns the present state of a link of a robot.
  [[nodiscard]] virtual LawState link(std::size_t robot, std::size_t k) = 0;
  /// Returns the present coordinate of the joint of a link.
  [[nodiscard]] virtual double position(std::size_t robot, std::size_t k) = 0;
};

/// Thrown where a scene has something that this comparison of engines leaves out.
class NotForPeer : public std::runtime_error {
 public:
  NotForPeer() : std::runtime_error("not for this engine") {}
};

/// Reads a scene, lets an engine simulate it, and writes the run: `laws_ENGINE SCENE RUN
/// [INTEGRATOR]`.
///
/// @returns the exit status; 3 where the scene is not for this engine
int simulate_law(int argc, char** argv,
                 const std::function<std::unique_ptr<LawEngine>(const LawScene&)>& load);

}  // namespace firstcontact::benchmarks
