// Random scenes of solids, soups, plates, balls and capsules on floors, in bowls, in free space and
// against scripted bodies, curved shapes as well, and robots with and without motors among them:
// what every step has to keep, and the proof of every run.
//
// FIRSTCONTACT_SIMULATIONS (default 20, 12 curved, 8 with robots) is the number of scenes of each
// kind, from FIRSTCONTACT_FIRST_SIMULATION (default 0) on. A thousand take about two minutes:
//   FIRSTCONTACT_SIMULATIONS=1000 build/ci/tests/simulation/simulation_slow_test
//   --gtest_filter=SimulationCampaign.*

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "robot/random_robot.h"
#include "simulation/simulated_run.h"
#include "support/random.h"

#include <firstcontact/record/run_step.h>

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 60;
constexpr double kStep = 0.01;     // [s]
constexpr double kSpacing = 0.8;   // [m]  Of the places where bodies start; none is larger.
constexpr double kReach = 0.35;    // [m]  From a body's origin, at most.
constexpr std::size_t kMost = 10;  // Free bodies.

/// [-]  Relative to the energy at the start.
///
/// Turning has errors of second order in the step, and bodies that are pushed apart are lifted.
constexpr double kEnergy = 1e-3;
/// [-]  Relative to the sum of all bodies' momenta.
constexpr double kMomentum = 1e-9;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

std::string text(const Vector3d& v) {
  return "[" + text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + "]";
}

struct Surface {
  std::vector<Vector3d> vertices;
  std::vector<std::array<std::size_t, 3>> triangles;
};

std::string text(const Surface& surface) {
  std::string json = R"({"vertices": [)";
  for (std::size_t k = 0; k < surface.vertices.size(); ++k) {
    json += (k > 0 ? ", " : "") + text(surface.vertices[k]);
  }
  json += R"(], "triangles": [)";
  for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
    const auto& [a, b, c] = surface.triangles[k];
    json += (k > 0 ? ", [" : "[") + std::to_string(a) + ", " + std::to_string(b) + ", " +
            std::to_string(c) + "]";
  }
  return json + "]}";
}

/// An L of three cubes, which is extruded.
Surface bracket(double edge, double depth) {
  const std::array<std::array<double, 2>, 6> outline{
      {{-1, -1}, {1, -1}, {1, 0}, {0, 0}, {0, 1}, {-1, 1}}};
  Surface surface;
  for (const double z : {-0.5 * depth, 0.5 * depth}) {
    for (const auto& [x, y] : outline) {
      surface.vertices.emplace_back(edge * x, edge * y, z);
    }
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const std::size_t next = (k + 1) % 6;
    surface.triangles.push_back({k, next, next + 6});
    surface.triangles.push_back({k, next + 6, k + 6});
  }
  // The fan about the inner corner.
  for (const std::size_t k : {std::size_t{4}, std::size_t{5}, std::size_t{0}, std::size_t{1}}) {
    const std::size_t next = (k + 1) % 6;
    surface.triangles.push_back({3, next, k});
    surface.triangles.push_back({9, k + 6, next + 6});
  }
  return surface;
}

/// Tetrahedra anywhere, also through each other.
Surface soup(Random& random) {
  Surface surface;
  const int count = random.chance(0.5) ? 1 : 3;
  for (int t = 0; t < count; ++t) {
    const std::size_t first = surface.vertices.size();
    for (int k = 0; k < 4; ++k) {
      surface.vertices.push_back(random.vector(0.05, kReach));
    }
    for (std::size_t k = 0; k < 4; ++k) {
      surface.triangles.push_back({first + k, first + (k + 1) % 4, first + (k + 2) % 4});
    }
  }
  return surface;
}

/// A funnel that is open at its top and closed at its bottom.
Surface bowl(double rim, double floor, double height) {
  Surface surface;
  for (const double half : {floor, rim}) {
    const double z = half == floor ? 0.0 : height;
    surface.vertices.insert(
        surface.vertices.end(),
        {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}});
  }
  surface.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    surface.triangles.push_back({k, next, next + 4});
    surface.triangles.push_back({k, next + 4, k + 4});
  }
  return surface;
}

struct CampaignScene {
  std::string bodies;
  std::string robots = {};
  std::string simulation;
  std::string urdf = {};   ///< Text of the robot's URDF.
  bool is_driven = false;  ///< A body is moved through the others, or joints have motors.
  bool is_alone = false;   ///< Only free bodies, without gravity.

  [[nodiscard]] std::string text() const {
    return R"({"firstcontact": 1, "bodies": [)" + bodies + R"(], "robots": [)" + robots +
           R"(], "simulation": {)" + simulation + "}}";
  }
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  /// A scene in which most shapes are cylinders, cones, ellipsoids and rounded boxes.
  CampaignScene curved_scene() {
    most_are_curved_ = true;
    return scene();
  }

  CampaignScene scene() {
    CampaignScene scene;
    const double around = random_.uniform(0.0, 1.0);
    scene.is_alone = around < 0.2;
    scene.is_driven = around > 0.75;
    if (!scene.is_alone) {
      const bool has_bowl = random_.chance(0.3);
      add(scene, body("ground", has_bowl ? text(bowl(2.0, 0.3, 1.0)) : box("[20, 20, 0.1]"),
                      has_bowl ? "[0, 0, 0]" : "[0, 0, -0.05]"));
    }
    if (scene.is_driven) {
      add(scene, R"({"name": "pusher", "shape": )" + ball(text(random_.uniform(0.05, 0.3))) +
                     R"(, "motion": {"type": "waypoints", "times": [0, 1], "poses": [)"
                     R"({"position": [-3, 0.1, 0.6]}, {"position": [3, -0.1, 0.6]}]}})");
    }
    const auto count = static_cast<std::size_t>(random_.uniform(2.0, kMost + 1.0));
    for (std::size_t k = 0; k < count; ++k) {
      add(scene, free_body(k, scene.is_alone));
    }
    const Vector3d gravity =
        scene.is_alone ? Vector3d::Zero() : Vector3d(0, 0, random_.chance(0.8) ? -9.81 : -1.0);
    scene.simulation = R"("step": )" + text(kStep) + R"(, "gravity": )" + text(gravity);
    return scene;
  }

  /// The same with a robot beside the bodies, whose URDF is put into a file.
  CampaignScene scene_with_robot(const std::filesystem::path& urdf) {
    CampaignScene scene = this->scene();
    const bool has_motors = random_.chance(0.5);
    const RandomRobot robot(random_, has_motors);
    scene.urdf = robot.urdf();
    std::ofstream(urdf) << scene.urdf;
    // Beyond the free bodies and the rim of the bowl; towards them if it is free.
    scene.robots =
        robot.text(urdf.string(), {0.0, 1.1, 1.8}, {0.0, random_.uniform(-3.0, 0.0), 0.0});
    scene.is_driven = scene.is_driven || has_motors;
    scene.is_alone = false;
    return scene;
  }

 private:
  static void add(CampaignScene& scene, const std::string& body) {
    scene.bodies += (scene.bodies.empty() ? "" : ", ") + body;
  }

  std::string free_body(std::size_t k, bool is_alone) {
    // Two by two, layer upon layer; towards each other where nothing else brings them together.
    const Vector3d place(kSpacing * (static_cast<double>(k % 2) - 0.5),
                         kSpacing * (static_cast<double>(k / 2 % 2) - 0.5),
                         0.7 + kSpacing * static_cast<double>(k / 4));
    Vector3d velocity = random_.vector(0.0, 2.0);
    if (is_alone) {
      velocity -= 3.0 * (place - Vector3d(0, 0, 1));
    }
    const double most_spin = random_.chance(0.3) ? 30.0 : 3.0;
    const Vector3d spin = random_.vector(0.0, most_spin);
    std::string dynamics = R"(, "dynamics": {"linear_velocity": )" + text(velocity) +
                           R"(, "angular_velocity": )" + text(spin) + R"(, "friction": )" +
                           text(pick({0.0, 0.3, 1.0})) + R"(, "restitution": )" +
                           text(pick({0.0, 0.5, 1.0}));
    const std::string shape = draw_shape(dynamics);
    const Eigen::Quaterniond q = random_.rotation();
    return R"({"name": "b)" + std::to_string(k) + R"(", "shape": )" + shape +
           R"(, "pose": {"position": )" + text(place) + R"(, "quaternion_wxyz": [)" + text(q.w()) +
           ", " + text(q.x()) + ", " + text(q.y()) + ", " + text(q.z()) + "]}" + dynamics + "}}";
  }

  std::string draw_curved() {
    const auto sizes = [&](double least, double greatest) {
      const double x = random_.uniform(least, greatest);
      const double y = random_.uniform(least, greatest);
      return text(Vector3d(x, y, random_.uniform(least, greatest)));
    };
    const int kind = static_cast<int>(random_.uniform(0.0, 4.0));
    if (kind == 0) {
      return R"({"ellipsoid": {"radii": )" + sizes(0.03, 0.3) + "}}";
    }
    if (kind == 1) {
      const std::string size = sizes(0.05, 0.25);
      return R"({"box": {"size": )" + size + R"(}, "radius": )" +
             text(random_.uniform(0.01, 0.05)) + "}";
    }
    const double radius = random_.uniform(0.02, 0.2);
    return std::string(kind == 2 ? R"({"cylinder")" : R"({"cone")") + R"(: {"radius": )" +
           text(radius) + R"(, "length": )" + text(random_.uniform(0.02, 0.4)) + "}}";
  }

  /// Adds the mass of what encloses nothing.
  std::string draw_shape(std::string& dynamics) {
    if (most_are_curved_ && random_.chance(0.7)) {
      return draw_curved();
    }
    switch (static_cast<int>(random_.uniform(0.0, 6.0))) {
      case 0: {
        const double x = random_.uniform(0.05, 0.35);
        const double y = random_.uniform(0.05, 0.35);
        const double z = random_.uniform(0.05, 0.35);
        return box(text(Vector3d(x, y, z)));
      }
      case 1:
        return box("[0.4, 0.4, " + text(random_.logarithmic(1e-3, 1e-2)) + "]");
      case 2: {
        const double edge = random_.uniform(0.05, 0.2);
        return text(bracket(edge, random_.uniform(0.05, 0.3)));
      }
      case 3: {
        const double mass = random_.logarithmic(0.1, 10.0);
        dynamics += R"(, "mass": )" + text(mass) +
                    R"(, "centre_of_mass": [0, 0, 0.05], "inertia": [[)" + text(0.02 * mass) +
                    ", 0, 0], [0, " + text(0.015 * mass) + ", 0], [0, 0, " + text(0.01 * mass) +
                    "]]";
        return text(soup(random_));
      }
      case 4:
        return ball(text(random_.uniform(0.03, 0.3)));
      default: {
        const double radius = random_.uniform(0.03, 0.1);
        return R"({"capsule": {"radius": )" + text(radius) + R"(, "length": )" +
               text(random_.uniform(0.05, 0.4)) + "}}";
      }
    }
  }

  double pick(std::initializer_list<double> values) {
    return values.begin()[static_cast<std::size_t>(
        random_.uniform(0.0, static_cast<double>(values.size())))];
  }

  Random random_;
  bool most_are_curved_ = false;
};

bool is_finite(const RunStep& step) {
  bool finite = std::isfinite(step.kinetic_energy) && std::isfinite(step.potential_energy) &&
                std::isfinite(step.residual);
  for (const RunBody& body : step.bodies) {
    finite = finite && body.X_WB.position.allFinite() && body.X_WB.rotation.coeffs().allFinite() &&
             body.linear_velocity.allFinite() && body.angular_velocity.allFinite();
  }
  for (const RunRobot& robot : step.robots) {
    for (const auto* row : {&robot.positions, &robot.velocities, &robot.efforts}) {
      finite = finite && std::ranges::all_of(*row, [](double x) { return std::isfinite(x); });
    }
  }
  return finite;
}

/// Holds one run to what its scene allows, and counts.
class Campaign {
 public:
  void check(std::uint64_t seed, const CampaignScene& scene) {
    SCOPED_TRACE("scene " + std::to_string(seed) + ": " + scene.text() + "\n" + scene.urdf);
    ShapeCache cache;
    Simulator s(load_scene(parse_scene(scene.text(), "campaign.json"), cache));
    const std::vector<RunStep> steps = run(s, kSteps);
    double lost = 0.0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      ASSERT_TRUE(is_finite(steps[k])) << "step " << k + 1;
      events_ += steps[k].events;
      lost += steps[k].time_lost;
      if (k > 0 && !scene.is_driven) {
        hold_energy(steps[k - 1], steps[k], total(steps[0]));
      }
      if (scene.is_alone) {
        hold_momentum(s.header(), steps[0], steps[k]);
      }
    }
    if (!scene.is_driven) {
      EXPECT_LE(lost, 0.0) << "with nothing that could crush a body";
    }
    lost_time_ += lost;
    const RunVerification proof = verify(s.header(), steps);
    EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  }

  void print(std::uint64_t scenes) const {
    std::printf("%llu scenes, %zu impacts, %g s lost, energy grew by %g at most, momentum by %g\n",
                static_cast<unsigned long long>(scenes), events_, lost_time_, greatest_gain_,
                greatest_drift_);
  }

 private:
  /// The ground is at height 0: neither energy is much below 0.
  static double total(const RunStep& step) { return step.kinetic_energy + step.potential_energy; }

  void hold_energy(const RunStep& before, const RunStep& after, double scale) {
    const double gain = (total(after) - total(before)) / scale;
    greatest_gain_ = std::max(greatest_gain_, gain);
    EXPECT_LE(gain, kEnergy) << "step " << after.index;
  }

  void hold_momentum(const RunHeader& header, const RunStep& first, const RunStep& step) {
    double scale = 0.0;
    for (const RunBody& body : first.bodies) {
      scale += header.masses[body.body] * body.linear_velocity.norm();
    }
    const double drift = (step.linear_momentum - first.linear_momentum).norm() / scale;
    greatest_drift_ = std::max(greatest_drift_, drift);
    EXPECT_LE(drift, kMomentum) << "step " << step.index;
  }

  std::size_t events_ = 0;
  double lost_time_ = 0.0;       // [s]
  double greatest_gain_ = 0.0;   // [-]
  double greatest_drift_ = 0.0;  // [-]
};

std::uint64_t number_from(const char* variable, std::uint64_t by_default) {
  const char* number = std::getenv(variable);
  return number == nullptr ? by_default : std::strtoull(number, nullptr, 10);
}

/// Seeds of scenes.
struct Seeds {
  explicit Seeds(std::uint64_t count_by_default)
      : first(number_from("FIRSTCONTACT_FIRST_SIMULATION", 0)),
        count(number_from("FIRSTCONTACT_SIMULATIONS", count_by_default)) {}

  std::uint64_t first;
  std::uint64_t count;
};

/// Checks the scenes of seeds.
///
/// @param scene_of  makes a CampaignScene of a Draw
template <class SceneOf>
void check_all(const Seeds& seeds, const SceneOf& scene_of) {
  Campaign campaign;
  for (std::uint64_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed) {
    campaign.check(seed, scene_of(Draw(seed)));
  }
  campaign.print(seeds.count);
}

TEST(SimulationCampaign, EveryRunKeepsTheLawsAndIsProven) {
  check_all(Seeds(20), [](Draw draw) { return draw.scene(); });
}

TEST(SimulationCampaign, SoDoesEveryRunOfCurvedShapes) {
  check_all(Seeds(12), [](Draw draw) { return draw.curved_scene(); });
}

/// Where the robot of a scene is written; removed in the end.
class RobotFile {
 public:
  RobotFile() = default;
  ~RobotFile() { std::filesystem::remove(path_); }
  RobotFile(const RobotFile&) = delete;
  RobotFile& operator=(const RobotFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                ("firstcontact_campaign_" + std::to_string(getpid()) + ".urdf");
};

TEST(SimulationCampaign, SoDoesEveryRunWithARobot) {
  const RobotFile urdf;
  check_all(Seeds(8), [&](Draw draw) { return draw.scene_with_robot(urdf.path()); });
}

// This scene once exceeded the bound of the energy.
TEST(SimulationCampaign, ASceneThatBrokeItsBoundKeepsIt) {
  Campaign campaign;
  const RobotFile urdf;
  campaign.check(300282, Draw(300282).scene());
  campaign.check(300282, Draw(300282).scene_with_robot(urdf.path()));
}

// A box turned by half a radian in a plan, and a contact gave it 0.9 % of all energy.
TEST(SimulationCampaign, AContactOfAFastBodyAddsNoEnergy) {
  Campaign campaign;
  campaign.check(5063, Draw(5063).scene());
}

// A light root that turns fast carries heavy links far out by joints of six coordinates: the same
// numbers mean another motion after a tenth of a radian. One gained 18 % of its energy in a step.
TEST(SimulationCampaign, LinksThatFloatOnATurningOneGainNothing) {
  Campaign campaign;
  const RobotFile urdf;
  for (const std::uint64_t seed : {272, 714}) {
    campaign.check(seed, Draw(seed).scene_with_robot(urdf.path()));
  }
}

// Damped joints were placed where their rule leads, and that pushed a joint beyond its limit: each
// plan ended there before it had begun.
TEST(SimulationCampaign, PlacedJointsLeadNoOtherBeyondItsLimits) {
  Campaign campaign;
  const RobotFile urdf;
  campaign.check(5052, Draw(5052).scene_with_robot(urdf.path()));
}

// What led a link back to its distance from the ground took a joint beyond its limit, and each plan
// ended there before it had begun.
TEST(SimulationCampaign, PushesApartStopAtJointLimits) {
  Campaign campaign;
  const std::filesystem::path urdf = std::filesystem::temp_directory_path() /
                                     ("firstcontact_limits_" + std::to_string(getpid()) + ".urdf");
  campaign.check(600004, Draw(600004).scene_with_robot(urdf));
  std::filesystem::remove(urdf);
}

}  // namespace
}  // namespace firstcontact::test
