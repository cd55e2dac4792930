// A noisy hand puts a peg into its hole, once for each seed. The program prints the depth that the
// peg reaches, and the swing of the force while the hand holds still.
//
//     haptics_peg SCENE.json [SEEDS [STIFFNESS_OF_HAND]]
//
// The hand misses the axis of the hole by a different error for each seed: 0.2 mm and 1 degree. The
// hand has no tremor, so any swing comes from the loop. The swing is the root mean square of the
// force between 50 and 1000 Hz, divided by the mean force.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptics/haptic_session.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

namespace firstcontact {
namespace {

constexpr double kEnd = 4.0;      // [s]
constexpr double kStill = 0.5;    // [s]  Length of the last part, in which the hand holds still.
constexpr double kRate = 4000.0;  // [Hz]

/// Computes the pose of the handle that brings a tool from its start to a pose.
Pose handle_for(const Pose& start, const Pose& wanted) {
  return {wanted.position - start.position,
          (wanted.rotation * start.rotation.conjugate()).normalized()};
}

std::vector<ViaPoint> path_of(const Pose& start, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  const auto wanted = [&](double height) {
    const Eigen::Vector3d off = 2e-4 * Eigen::Vector3d(normal(rng), normal(rng), 0.0);
    const Eigen::Vector3d tilt = 0.0175 * Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
    const double angle = tilt.norm();
    return Pose{Eigen::Vector3d(0.0, 0.0, height) + off,
                Eigen::Quaterniond(Eigen::AngleAxisd(angle, tilt / angle))};
  };
  std::vector<ViaPoint> path(1);
  const auto add = [&](double time, double height) {
    ViaPoint point;
    point.time = time;
    point.X_DH = handle_for(start, wanted(height));
    path.push_back(point);
  };
  add(0.8, 0.010);
  add(1.6, 0.004);
  add(2.4, 0.001);
  add(3.2, -0.002);
  return path;
}

struct Insertion {
  double height = 0.0;     // [m]  Height of the tool at the end.
  double swing = 0.0;      // [-]
  double greatest = 0.0;   // [N]
  double clearance = 1e9;  // [m]
};

/// [N]  Computes the root mean square of the forces between 50 and 1000 Hz.
double swing_of(const std::vector<double>& forces) {
  double mean = 0.0;
  for (const double force : forces) {
    mean += force / static_cast<double>(forces.size());
  }
  const auto n = static_cast<double>(forces.size());
  const auto first = static_cast<int>(50.0 * n / kRate);
  const auto last = static_cast<int>(1000.0 * n / kRate);
  double power = 0.0;
  for (int k = first; k <= last; ++k) {
    std::complex<double> sum;
    const std::complex<double> step = std::polar(1.0, -2.0 * std::numbers::pi * k / n);
    std::complex<double> turn = 1.0;
    for (const double force : forces) {
      sum += (force - mean) * turn;
      turn *= step;
    }
    power += 2.0 * std::norm(sum) / (n * n);
  }
  return std::sqrt(power);
}

Insertion insert(const HapticSetup& setup, std::uint64_t seed, double stiffness) {
  HapticSession session(setup.scene, setup.options);
  SimulatedOperatorOptions options;
  options.path = path_of(setup.scene.tools[0].X_WB, seed);
  options.seed = seed;
  options.hand.stiffness = stiffness;
  options.hand.tremor = 0.0;
  options.hand.angular_tremor = 0.0;
  SimulatedOperator handle(options);
  Insertion found;
  std::vector<double> still;
  const auto count = static_cast<std::int64_t>(kEnd * kRate);
  double mean = 0.0;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t now = session.time_ns();
    const std::array states{handle.read(now)};
    const ForceTick& tick = session.step(states);
    handle.command(tick.tools[0].command, now);
    const double force = tick.tools[0].command.force_D.norm();
    found.greatest = std::max(found.greatest, force);
    if (session.cycle() != nullptr) {
      found.clearance = std::min(found.clearance, session.cycle()->clearance);
    }
    if (static_cast<double>(k) >= (kEnd - kStill) * kRate) {
      still.push_back(force);
      mean += force;
    }
  }
  mean /= static_cast<double>(still.size());
  found.swing = swing_of(still) / std::max(0.05, mean);
  found.height = session.contacts().pose(0).position.z();
  return found;
}

int run(const std::string& file, int seeds, double stiffness) {
  Scene scene = read_scene(file);
  ShapeCache cache;
  prepare_haptics(scene, cache, kEnd);
  const HapticSetup setup = haptic_setup(load_scene(std::move(scene), cache));
  int inserted = 0;
  int still = 0;
  double worst = 0.0;
  double clearance = 1e9;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Insertion found = insert(setup, static_cast<std::uint64_t>(seed), stiffness);
    std::printf("%4d: end %.3f mm, swing %.3g %%, force %.3g N at most, apart %.3g um\n", seed,
                1e3 * found.height, 100.0 * found.swing, found.greatest, 1e6 * found.clearance);
    std::fflush(stdout);
    inserted += found.height < 0.006 ? 1 : 0;
    still += found.swing < 0.01 ? 1 : 0;
    worst = std::max(worst, found.swing);
    clearance = std::min(clearance, found.clearance);
  }
  std::printf(
      "%d of %d are 3 mm or more in the hole; the force swings by less than 1 %% in %d, "
      "%.3g %% at most; apart by %.3g um, proven\n",
      inserted, seeds, still, 100.0 * worst, 1e6 * clearance);
  return 0;
}

}  // namespace
}  // namespace firstcontact

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "haptics_peg SCENE.json [SEEDS [STIFFNESS_OF_HAND]]\n");
    return 2;
  }
  return firstcontact::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 100,
                           argc > 3 ? std::atof(argv[3]) : 400.0);
}
