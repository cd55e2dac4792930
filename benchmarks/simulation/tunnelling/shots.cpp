#include "benchmarks/simulation/tunnelling/shots.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string_view>

#include <nlohmann/json.hpp>

#include "tests/support/random.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using nlohmann::json;

// At 0.5 m/s, most boxes have an instant at which they are in the plate.
constexpr double kSpeeds[] = {0.5, 2, 20, 50, 100, 200, 500, 1000, 2000};  // [m/s]
constexpr double kSpins[] = {0, 10, 100, 1000};                            // [rad/s]
constexpr int kStepsAtThePlate = 30;

/// Makes a shot whose sampled instants are at random distances from the plate.
Shot random_shot(double speed, double spin, test::Random& random) {
  Shot shot{.speed = speed, .X_WB = Isometry3d::Identity()};
  const double distance = 0.02 + random.uniform(0.0, 2.0) * speed * kStep;
  shot.X_WB.translation() =
      Vector3d(-distance, random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
  shot.X_WB.linear() = random.rotation().toRotationMatrix();
  shot.spin = spin * random.direction();
  return shot;
}

/// [m]  Computes how far the box's farthest corner is behind the near side of the plate.
double depth(const Isometry3d& X_WB) {
  const double reach = kBoxHalf * X_WB.linear().row(0).lpNorm<1>();
  return X_WB.translation().x() + reach + kPlateHalfThick;
}

bool is_behind(const Isometry3d& X_WB) { return X_WB.translation().x() > kPlateHalfThick; }

/// Returns whether the box is not beside the plate, where it could pass without contact.
bool is_at_the_plate(const Isometry3d& X_WB) {
  return X_WB.translation().tail<2>().lpNorm<Eigen::Infinity>() < kPlateHalf;
}

/// Outcomes of the boxes of one speed.
struct Tally {
  int shots = 0;
  int passed = 0;  ///< Boxes whose centre ended behind the plate and went through it.
  int sunk = 0;    ///< Boxes that did not pass, but had a corner behind the plate at the end of a
                   ///< step.
  int broken = 0;  ///< Boxes whose pose is not a number.
  int proven = 0;
};

void fly(Flight& flight, const Shot& shot, Tally& tally) {
  const double distance = -shot.X_WB.translation().x();
  const int steps = static_cast<int>(distance / (shot.speed * kStep)) + kStepsAtThePlate;
  double deepest = -1.0;
  bool passed = false;
  bool broken = false;
  for (int k = 0; k < steps && !broken; ++k) {
    flight.step();
    const Isometry3d X_WB = flight.box();
    broken = !X_WB.matrix().allFinite();
    passed = is_behind(X_WB) && (passed || is_at_the_plate(X_WB));
    deepest = std::max(deepest, depth(X_WB));
  }
  ++tally.shots;
  tally.broken += broken;
  tally.passed += passed;
  tally.sunk += !passed && deepest > 2.0 * kPlateHalfThick;
  tally.proven += flight.proven();
}

Tally shoot_all(const Contender& contender, double speed, int shots_of_a_spin) {
  Tally tally;
  test::Random random(static_cast<std::uint64_t>(speed));
  for (const double spin : kSpins) {
    for (int k = 0; k < shots_of_a_spin; ++k) {
      const Shot shot = random_shot(speed, spin, random);
      fly(*contender.load(shot), shot, tally);
    }
  }
  return tally;
}

}  // namespace

BoxMesh plate_mesh() {
  BoxMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.corners.emplace_back((k & 1) ? kPlateHalfThick : -kPlateHalfThick,
                              (k & 2) ? kPlateHalf : -kPlateHalf,
                              (k & 4) ? kPlateHalf : -kPlateHalf);
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

int shoot(int argc, char** argv, const std::vector<Contender>& contenders) {
  const bool quick = argc == 3 && std::string_view(argv[1]) == "--quick";
  if (argc != (quick ? 3 : 2)) {
    std::fprintf(stderr, "usage: %s [--quick] OUTPUT.json\n", argv[0]);
    return 2;
  }
  json rows = json::array();
  for (const Contender& contender : contenders) {
    for (const double speed : kSpeeds) {
      const Tally tally = shoot_all(contender, speed, quick ? 2 : 25);
      rows.push_back({{"contender", contender.name},
                      {"speed_m_per_s", speed},
                      {"shots", tally.shots},
                      {"passed", tally.passed},
                      {"sunk", tally.sunk},
                      {"broken", tally.broken},
                      {"proven", tally.proven}});
    }
  }
  std::ofstream(argv[argc - 1]) << rows.dump(2) << '\n';
  return 0;
}

}  // namespace firstcontact::benchmarks
