// Promise: contacts give no energy, on curved bodies and where their place moves along crossing
// lines.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <firstcontact/record/run.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/simulation/simulator.h>

#include "simulation/simulated_run.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

/// [-]  Greatest gain in a step, by the kinetic energy.
constexpr double kGain = 2e-3;
/// [-]  Greatest gain in a run, by the greatest kinetic energy.
constexpr double kGainOfRun = 1e-2;

/// Writes a constant force on a body, for its dynamics.
std::string constant_force(const Vector3d& force) {
  return R"(, "forces": [{"from": 0, "force": )" + numbers({force.x(), force.y(), force.z()}) +
         "}]";
}

std::string along_z(double force) { return constant_force(force * Vector3d::UnitZ()); }

/// [J]  The energy after a step, with that in the field of constant forces.
double energy_of(const RunHeader& header, const RunStep& step,
                 const std::vector<Vector3d>& forces) {
  double energy = step.kinetic_energy + step.potential_energy;
  for (std::size_t k = 0; k < forces.size(); ++k) {
    const RunBody& body = step.bodies[k];
    const Vector3d centre =
        body.X_WB.position + body.X_WB.rotation.normalized() * header.centres_of_mass[body.body];
    energy -= forces[k].dot(centre);
  }
  return energy;
}

/// Runs a scene to its end, and holds each step to the bound: nothing but constant forces and
/// gravity drives it. A displacement without velocity may lift a body by a contact distance.
///
/// @param forces  [N]  act at the centres of mass of the first bodies
void expect_no_gain(Simulator& s, std::size_t steps, const std::vector<Vector3d>& forces = {}) {
  const auto& header = s.header();
  double weight = 0.0;  // [N]
  for (const double mass : header.masses) {
    weight += mass * header.scene.simulation->gravity.norm();
  }
  for (const Vector3d& force : forces) {
    weight += force.norm();
  }
  const double lift = weight * *header.scene.simulation->contact_distance;
  double kinetic = 0.0;
  double before = std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  for (const RunStep& step : run(s, steps)) {
    const double energy = energy_of(header, step, forces);
    const double most = std::max(kinetic, step.kinetic_energy);
    greatest = std::max(greatest, most);
    EXPECT_LE(energy - before, kGain * most + lift) << "step " << step.index << " of " << most;
    EXPECT_LE(energy - least, kGainOfRun * greatest + lift) << "until step " << step.index;
    before = energy;
    least = std::min(least, energy);
    kinetic = step.kinetic_energy;
  }
}

void expect_no_gain(const std::string& scene, std::size_t steps) {
  SCOPED_TRACE(scene);
  ShapeCache cache;
  Simulator s(load_scene(
      read_scene(std::string(FIRSTCONTACT_SOURCE_DIR "/tests/data/regressions/") + scene), cache));
  expect_no_gain(s, steps);
}

/// Draws bodies and grounds.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : rng_(seed) {}

  double between(double least, double greatest) {
    return std::uniform_real_distribution<double>(least, greatest)(rng_);
  }

  std::size_t one_of(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(rng_);
  }

  std::string vector(double size) {
    return numbers({between(-size, size), between(-size, size), between(-size, size)});
  }

  std::string shape() {
    static const std::vector<std::string> kShapes{
        R"({"capsule": {"radius": 0.1, "length": 0.2}})",
        R"({"convex_hull": {"vertices": [[0.1, 0.1, 0.1], [-0.1, -0.1, 0.1], [-0.1, 0.1, -0.1],
            [0.1, -0.1, -0.1]]}})",
        R"({"box": {"size": [0.3, 0.2, 0.1]}})", R"({"cone": {"radius": 0.1, "length": 0.3}})"};
    return kShapes[one_of(kShapes.size())];
  }

  /// A body whose top is curved, at height 0.
  std::string ground() {
    static const std::string kLies = R"("quaternion_wxyz": [1, 1, 0, 0])";
    static const std::vector<std::string> kGrounds{
        R"({"cylinder": {"radius": 1, "length": 4}}, "pose": {"position": [0, 0, -1], )" + kLies,
        R"({"capsule": {"radius": 1, "length": 4}}, "pose": {"position": [0, 0, -1], )" + kLies,
        R"({"sphere": {"radius": 1}}, "pose": {"position": [0, 0, -1])",
        R"({"ellipsoid": {"radii": [1, 2, 0.6]}}, "pose": {"position": [0, 0, -0.6])"};
    return R"({"name": "ground", "surface": {"friction": 0}, "shape": )" +
           kGrounds[one_of(kGrounds.size())] + "}}";
  }

  /// A body that falls and turns; `more` belongs to its dynamics, and begins with a comma.
  std::string falling(const std::string& more = "") {
    return R"({"name": "body", "shape": )" + shape() +
           R"(, "pose": {"position": [0, 0, 0.4], "rotation_vector": )" + vector(2.0) +
           R"(}, "dynamics": {"friction": 0, "linear_velocity": )" +
           numbers({between(-1.0, 1.0), between(-1.0, 1.0), -1.0}) + R"(, "angular_velocity": )" +
           vector(9.0) + more + "}}";
  }

 private:
  std::mt19937 rng_;
};

void expect_no_gain_of_falling(std::uint32_t seed, double step, const std::string& more = "",
                               const Vector3d& force = Vector3d::Zero()) {
  SCOPED_TRACE(seed);
  Draw draw(seed);
  const std::string body = draw.falling(more);
  Simulator s =
      simulator(body + ", " + draw.ground(), R"("duration": 0.6, "step": )" + number_text(step));
  expect_no_gain(s, static_cast<std::size_t>(std::lround(0.6 / step)), {force});
}

TEST(ContactEnergy, BodiesOnCurvedOnesGainNone) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    expect_no_gain_of_falling(seed, 0.01);
    expect_no_gain_of_falling(seed, 0.005);
  }
}

// Forces, even those of 0 N, once switched the bound off.
TEST(ContactEnergy, BodiesUnderForcesGainTheirWork) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    expect_no_gain_of_falling(seed, 0.01, constant_force(Vector3d::Zero()));
    const Vector3d force(20.0, -10.0, 5.0 - seed);
    expect_no_gain_of_falling(seed, 0.01, constant_force(force), force);
  }
}

// A belt and a script far away once switched it off, too.
TEST(ContactEnergy, BeltsAndScriptsElsewhereGiveNone) {
  const std::string elsewhere =
      R"(, {"name": "belt", "shape": {"box": {"size": [1, 1, 1]}}, "pose": {"position": [20, 0, 0]},
          "surface": {"velocity": [1, 0, 0]}},
         {"name": "script", "shape": {"sphere": {"radius": 0.1}},
          "motion": {"type": "constant_velocity", "from": {"position": [20, 9, 0]},
                     "translation": [0, 0, 1]}})";
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const std::string body = draw.falling();
    Simulator s =
        simulator(body + ", " + draw.ground() + elsewhere, R"("duration": 0.6, "step": 0.01)");
    expect_no_gain(s, 60);
  }
}

// A small body falls on a large one that is free as well. Opposite forces hold them together.
TEST(ContactEnergy, FreeBodiesThatMeetGainNone) {
  const std::vector<std::string> large{R"({"capsule": {"radius": 0.5, "length": 1.5}})",
                                       R"({"cylinder": {"radius": 0.5, "length": 1.5}})",
                                       ball("0.5")};
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const double pull = draw.one_of(2) == 0 ? 20.0 : 100.0;  // [N]
    const std::string below = R"({"name": "large", "shape": )" + large[draw.one_of(large.size())] +
                              R"(, "pose": {"position": [0, 0, -0.4], "rotation_vector":
            [1.6, 0, 0]}, "dynamics": {"friction": 0)" +
                              along_z(pull) + "}}";
    Simulator s = simulator(draw.falling(along_z(-pull)) + ", " + below,
                            R"("duration": 0.6, "step": 0.01, "gravity": [0, 0, 0])");
    expect_no_gain(s, 60, {Vector3d(0.0, 0.0, -pull), Vector3d(0.0, 0.0, pull)});
  }
}

TEST(ContactEnergy, ChainsOnCurvedBodiesGainNone) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const std::string shape = draw.shape();
    const std::string velocity = numbers({draw.between(-0.3, 0.3), draw.between(-0.3, 0.3), -1.0});
    std::string bodies;
    for (int k = 0; k < 3; ++k) {
      bodies += R"({"name": "b)" + std::to_string(k) + R"(", "shape": )" + shape +
                R"(, "pose": {"position": )" + numbers({0.45 * (k - 1), 0.0, 0.4}) +
                R"(}, "dynamics": {"friction": 0, "linear_velocity": )" + velocity + "}}, ";
    }
    const std::string pin = R"({"type": "pin", "points": [[0.225, 0, 0], null], "bodies": )";
    Simulator s =
        simulator(bodies + draw.ground(), R"("duration": 0.6, "step": 0.01, "ties": [)" + pin +
                                              R"(["b0", "b1"]}, )" + pin + R"(["b1", "b2"]}])");
    expect_no_gain(s, 60);
  }
}

// A capsule crossed a thicker one at 0.116 rad. The crossing ran along it within a plan, and the
// contact gave 48 J to 13 J.
TEST(ContactEnergy, ACrossingThatRunsAlongACapsuleGivesNone) {
  expect_no_gain("capsule_gains_on_capsule.json", 140);
  expect_no_gain("capsule_gains_on_cylinder.json", 168);
}

TEST(ContactEnergy, EdgesAndCornersThatSlideOnCurvedBodiesGainNone) {
  expect_no_gain("tetrahedron_gains_on_cylinder.json", 140);
  expect_no_gain("rough_tetrahedron_gains_on_cylinder.json", 168);
  expect_no_gain("hull_gains_on_capsule.json", 120);
  expect_no_gain("cone_gains_on_ellipsoid.json", 120);
}

TEST(ContactEnergy, AForceOfNothingChangesNothing) {
  expect_no_gain("capsule_gains_under_no_force.json", 60);
}

}  // namespace
}  // namespace firstcontact::test
