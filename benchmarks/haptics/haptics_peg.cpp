// A noisy hand puts a peg into its hole, once for each seed, by the god-object and by a penalty
// method. The program prints a row for each method: seeds inserted, swing of the force while the
// hand holds still, greatest change of the force in a millisecond, depth of penetration.
//
//     haptics_peg SCENE.json [SEEDS [STIFFNESS_OF_HAND [SEEDS_OF_GRID [FRICTION]]]]
//
// The hand misses the axis of the hole by a different error for each seed: 0.2 mm and 1 degree. The
// hand has no tremor, so any swing comes from the loop. The swing is the root mean square of the
// force between 50 and 1000 Hz, divided by the mean force.
//
// The penalty method (penalty_method.h) runs with each gain of a grid on SEEDS_OF_GRID seeds. The
// best gains of each of its two kinds, with and without a coupling, then run on all seeds. They are
// those with most seeds inserted and still, then with most inserted. Among equals they are those of
// the least penetration, or of the least swing where no seed is inserted and still. With
// SEEDS_OF_GRID 0, the default, only the god-object runs.
//
// FRICTION [N] is Coulomb's of the mechanism, 0 by default. Its angular friction is 5 mm times it,
// as the steps of the encoders of 10 um and 5e-5 rad are to each other by the springs.

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
#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

#include "penalty_method.h"

namespace firstcontact {
namespace {

constexpr double kEnd = 4.0;       // [s]
constexpr double kStill = 0.5;     // [s]  Length of the last part, in which the hand holds still.
constexpr double kRate = 4000.0;   // [Hz]
constexpr std::size_t kJump = 4;   // [ticks]  A millisecond.
constexpr double kSpacing = 4e-3;  // [m]  Of the points of the penalty method.

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
  double jump = 0.0;       // [N]  Greatest change of the force in a millisecond.
  double clearance = 1e9;  // [m]  Negative: penetration.

  [[nodiscard]] bool is_inserted() const { return height < 0.006; }
  [[nodiscard]] bool is_still() const { return swing < 0.01; }
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

/// A tick of a method: the command, the height of the tool and its clearance.
struct Felt {
  ForceCommand command;
  double height = 0.0;
  double clearance = 1e9;
};

/// The hand and its mechanism.
struct HandChoice {
  double stiffness = 400.0;  // [N/m]
  double friction = 0.0;     // [N]
};

SimulatedOperatorOptions hand_of(const Pose& start, std::uint64_t seed, const HandChoice& choice) {
  SimulatedOperatorOptions options;
  options.path = path_of(start, seed);
  options.seed = seed;
  options.hand.stiffness = choice.stiffness;
  options.mechanism.friction = choice.friction;
  options.mechanism.angular_friction = 0.005 * choice.friction;
  options.hand.tremor = 0.0;
  options.hand.angular_tremor = 0.0;
  return options;
}

/// Runs a session of the hand.
///
/// @param step  computes the tick of a method from a state of the device and the time [ns]
template <class Step>
Insertion insert(const SimulatedOperatorOptions& hand, const Step& step) {
  SimulatedOperator handle(hand);
  Insertion found;
  std::vector<double> still;
  std::vector<Eigen::Vector3d> forces;
  const auto count = static_cast<std::size_t>(kEnd * kRate);
  double mean = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const auto now = static_cast<std::int64_t>(static_cast<double>(k) * 1e9 / kRate);
    const Felt felt = step(handle.read(now), now);
    handle.command(felt.command, now);
    forces.push_back(felt.command.force_D);
    const double force = felt.command.force_D.norm();
    found.greatest = std::max(found.greatest, force);
    found.jump = std::max(found.jump, (forces[k] - forces[k - std::min(k, kJump)]).norm());
    found.clearance = std::min(found.clearance, felt.clearance);
    found.height = felt.height;
    if (static_cast<double>(k) >= (kEnd - kStill) * kRate) {
      still.push_back(force);
      mean += force;
    }
  }
  mean /= static_cast<double>(still.size());
  found.swing = swing_of(still) / std::max(0.05, mean);
  return found;
}

Insertion insert_god_object(const HapticSetup& setup, std::uint64_t seed, const HandChoice& hand) {
  const SimulatedOperatorOptions options = hand_of(setup.scene.tools[0].X_WB, seed, hand);
  HapticSessionOptions session_options = setup.options;
  session_options.mappings = complete_mappings(setup.scene, session_options.mappings);
  session_options.mappings[0].device = SimulatedOperator(options).capabilities();
  HapticSession session(setup.scene, session_options);
  const auto step = [&](const DeviceState& state, std::int64_t /*now*/) {
    const std::array states{state};
    Felt felt{.command = session.step(states).tools[0].command};
    felt.height = session.contacts().pose(0).position.z();
    if (session.cycle() != nullptr) {
      felt.clearance = session.cycle()->clearance;
    }
    return felt;
  };
  return insert(options, step);
}

/// Cuts a vector to a length.
Eigen::Vector3d cut(const Eigen::Vector3d& vector, double most) {
  const double length = vector.norm();
  return length > most ? Eigen::Vector3d(vector * (most / length)) : vector;
}

Insertion insert_penalty(const HapticSetup& setup, const PenaltyGains& gains, std::uint64_t seed,
                         const HandChoice& hand) {
  const HapticTool& tool = setup.scene.tools[0];
  const HapticBody& body = setup.scene.bodies[0];
  Mesh placed = body.shape.mesh();
  for (Eigen::Vector3d& vertex : placed.vertices) {
    vertex = body.X_WB.rotation * vertex + body.X_WB.position;
  }
  PenaltyMethod method(tool.shape.mesh(), placed, tool.X_WB, tool.p_BC, kSpacing, gains);
  const Eigen::Vector3d start = tool.X_WB.rotation * tool.p_BC + tool.X_WB.position;
  const HapticLimits& limits = setup.options.forces.limits;
  ForceCommand last;
  const auto step = [&](const DeviceState& state, std::int64_t /*now*/) {
    Pose target;
    target.rotation = (state.X_DH.rotation * tool.X_WB.rotation).normalized();
    target.position = start + state.X_DH.position - target.rotation * tool.p_BC;
    const PenaltyForce force = method.tick(target, 1.0 / kRate);
    // The limits of the god-object's force.
    last.force_D += cut(cut(force.force, limits.force) - last.force_D, limits.force_slew / kRate);
    last.torque_D +=
        cut(cut(force.torque, limits.torque) - last.torque_D, limits.torque_slew / kRate);
    return Felt{
        .command = last, .height = method.tool().position.z(), .clearance = -method.depth()};
  };
  return insert(hand_of(tool.X_WB, seed, hand), step);
}

/// The sum over the seeds of a method.
struct Account {
  int seeds = 0;
  int inserted = 0;
  int still = 0;
  int both = 0;
  std::vector<double> swings;
  double jump = 0.0;       // [N]
  double greatest = 0.0;   // [N]
  double clearance = 1e9;  // [m]

  void add(const Insertion& found) {
    ++seeds;
    inserted += found.is_inserted() ? 1 : 0;
    still += found.is_still() ? 1 : 0;
    both += found.is_inserted() && found.is_still() ? 1 : 0;
    swings.push_back(found.swing);
    jump = std::max(jump, found.jump);
    greatest = std::max(greatest, found.greatest);
    clearance = std::min(clearance, found.clearance);
  }

  void print(const char* name) {
    std::sort(swings.begin(), swings.end());
    std::printf("%-34s %3d/%-3d %3d/%-3d %8.3g %8.3g %8.3g %8.3g %10.3g\n", name, inserted, seeds,
                still, seeds, 100.0 * swings[swings.size() / 2], 100.0 * swings.back(), jump,
                greatest, clearance > 0.0 ? 0.0 : -1e6 * clearance);
    std::fflush(stdout);
  }
};

std::string name_of(const PenaltyGains& gains) {
  std::array<char, 64> text{};
  (void)std::snprintf(text.data(), text.size(), "%s %g N/m %g ms",
                      gains.is_coupled ? "coupled" : "direct", gains.stiffness,
                      1e3 * gains.damping);
  return text.data();
}

Account run_penalty(const HapticSetup& setup, const PenaltyGains& gains, int seeds,
                    const HandChoice& hand) {
  Account account;
  for (int seed = 1; seed <= seeds; ++seed) {
    account.add(insert_penalty(setup, gains, static_cast<std::uint64_t>(seed), hand));
  }
  account.print(name_of(gains).c_str());
  return account;
}

bool is_better(const Account& a, const Account& b) {
  if (a.both != b.both || a.inserted != b.inserted) {
    return std::pair(a.both, a.inserted) > std::pair(b.both, b.inserted);
  }
  return a.both > 0 ? a.clearance > b.clearance : a.swings.back() < b.swings.back();
}

/// The best gains of the grid.
PenaltyGains best_of_grid(const HapticSetup& setup, bool is_coupled, int seeds,
                          const HandChoice& hand) {
  PenaltyGains best;
  Account of_best;
  for (const double gain : {1000.0, 3000.0, 10000.0, 30000.0}) {
    for (const double damping : {0.0, 1e-3}) {
      const PenaltyGains gains{.stiffness = gain, .damping = damping, .is_coupled = is_coupled};
      const Account account = run_penalty(setup, gains, seeds, hand);
      if (of_best.seeds == 0 || is_better(account, of_best)) {
        best = gains;
        of_best = account;
      }
    }
  }
  return best;
}

int run(const std::string& file, int seeds, const HandChoice& hand, int seeds_of_grid) {
  Scene scene = read_scene(file);
  ShapeCache cache;
  prepare_haptics(scene, cache, kEnd);
  const HapticSetup setup = haptic_setup(load_scene(std::move(scene), cache));
  std::printf("%-34s %7s %7s %8s %8s %8s %8s %10s\n", "method", "in", "still", "swing %", "worst %",
              "N in ms", "force N", "inside um");
  std::fflush(stdout);
  std::vector<PenaltyGains> best;
  for (const bool is_coupled : {false, true}) {
    if (seeds_of_grid > 0) {
      best.push_back(best_of_grid(setup, is_coupled, seeds_of_grid, hand));
    }
  }
  std::printf("all seeds\n");
  for (const PenaltyGains& gains : best) {
    run_penalty(setup, gains, seeds, hand);
  }
  Account god_object;
  for (int seed = 1; seed <= seeds; ++seed) {
    god_object.add(insert_god_object(setup, static_cast<std::uint64_t>(seed), hand));
  }
  god_object.print("god-object");
  std::printf("the god-object is apart by %.3g um, proven\n", 1e6 * god_object.clearance);
  return 0;
}

}  // namespace
}  // namespace firstcontact

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr,
                 "haptics_peg SCENE.json [SEEDS [STIFFNESS_OF_HAND [SEEDS_OF_GRID [FRICTION]]]]\n");
    return 2;
  }
  const auto number = [&](int at, double otherwise) {
    return argc > at ? std::atof(argv[at]) : otherwise;
  };
  return firstcontact::run(argv[1], static_cast<int>(number(2, 100.0)),
                           {.stiffness = number(3, 400.0), .friction = number(5, 0.0)},
                           static_cast<int>(number(4, 0.0)));
}
