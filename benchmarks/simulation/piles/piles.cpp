#include "benchmarks/simulation/piles/piles.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "benchmarks/support/timing.h"
#include "tests/support/random.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using nlohmann::json;

constexpr double kSide = 2.0 * kBoxHalf;
constexpr double kGap = 1.8e-5;     // [m]  Gap between boxes at rest: about our contact distance.
constexpr double kMostTime = 60e3;  // [ms]  Processor time after which a pile is abandoned.
constexpr double kMostTimeQuick = 5e3;

/// Returns positions in rows, columns and layers.
std::vector<Vector3d> lattice(int count, int in_a_row, double apart, double up, double lowest) {
  std::vector<Vector3d> places;
  for (int k = 0; k < count; ++k) {
    const int in_layer = k % (in_a_row * in_a_row);
    const double middle = 0.5 * (in_a_row - 1);
    places.emplace_back(apart * (in_layer % in_a_row - middle),
                        apart * (in_layer / in_a_row - middle),
                        lowest + up * (k / (in_a_row * in_a_row)));
  }
  return places;
}

Pile resting(std::string name, const std::vector<Vector3d>& places, int steps) {
  Pile pile{.name = std::move(name), .boxes = {}, .spins = {}, .steps = steps};
  for (const Vector3d& place : places) {
    pile.boxes.emplace_back(Eigen::Translation3d(place));
    pile.spins.emplace_back(Vector3d::Zero());
  }
  return pile;
}

Pile turned(Pile pile) {
  test::Random random(pile.boxes.size());
  for (std::size_t k = 0; k < pile.boxes.size(); ++k) {
    pile.boxes[k].linear() = random.rotation().toRotationMatrix();
    pile.spins[k] = random.uniform(0.0, 3.0) * random.direction();
  }
  return pile;
}

int root(int count) { return static_cast<int>(std::lround(std::sqrt(count))); }

/// Makes a pile of boxes 1 m apart that never reach the floor.
Pile falling_apart(int count) {
  return turned(resting("falling apart", lattice(count, root(count), 1.0, 1.0, 100.0), 100));
}

Pile resting_apart(int count) {
  return resting("resting apart", lattice(count, root(count), 1.0, 1.0, kBoxHalf + kGap), 100);
}

/// Makes stacks of five boxes each, 1 m apart.
Pile stacks(int count) {
  return resting("stacks of five",
                 lattice(count, root(count / 5), 1.0, kSide + kGap, kBoxHalf + kGap), 100);
}

/// Makes a pile of boxes that all fall onto one heap.
Pile heap(int count) {
  const int in_a_row = static_cast<int>(std::lround(std::cbrt(count)));
  return turned(resting("heap", lattice(count, in_a_row, 2.0 * kSide, 2.0 * kSide, kSide), 300));
}

std::vector<Pile> all_piles(bool quick) {
  std::vector<Pile> piles;
  for (const int count : quick ? std::vector{100, 1'000} : std::vector{100, 1'000, 10'000}) {
    piles.push_back(falling_apart(count));
    piles.push_back(resting_apart(count));
    piles.push_back(stacks(count));
  }
  for (const int count : quick ? std::vector{27} : std::vector{125, 343, 1'000}) {
    piles.push_back(heap(count));
  }
  return piles;
}

json measure(const Pile& pile, const LoadPile& load, double most_time) {
  std::unique_ptr<PileWorld> world;
  const double loading = time_of([&] { world = load(pile); });
  std::vector<double> times;
  double sum = 0.0;
  while (static_cast<int>(times.size()) < pile.steps && sum < most_time) {
    times.push_back(1e-3 * time_of([&] { world->step(); }));
    sum += times.back();
  }
  json found = {{"pile", pile.name},
                {"boxes", pile.boxes.size()},
                {"loading_s", 1e-6 * loading},
                {"steps_ms", times}};
  for (const auto& [name, value] : world->remarks()) {
    found[name] = value;
  }
  return found;
}

}  // namespace

int measure_piles(int argc, char** argv, const std::string& engine, const LoadPile& load) {
  const bool quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  const int output = quick ? 2 : 1;
  if (argc <= output || argc > output + 2) {
    std::fprintf(stderr, "usage: %s [--quick] OUTPUT.json [NAME]\n", argv[0]);
    return 2;
  }
  const std::string only = argc > output + 1 ? argv[output + 1] : "";
  json rows = json::array();
  for (const Pile& pile : all_piles(quick)) {
    const std::string name = std::to_string(pile.boxes.size()) + " " + pile.name;
    if (name.find(only) == std::string::npos) {
      continue;
    }
    json row = measure(pile, load, quick ? kMostTimeQuick : kMostTime);
    row["engine"] = engine;
    const std::vector<double> times = row["steps_ms"];
    std::fprintf(
        stderr, "  %s: %.3g ms a step, %zu steps\n", name.c_str(),
        std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size()),
        times.size());
    rows.push_back(std::move(row));
  }
  std::ofstream(argv[output]) << rows.dump(2) << '\n';
  return 0;
}

}  // namespace firstcontact::benchmarks
