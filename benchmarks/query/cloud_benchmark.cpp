// Times the first contact of the bunny (69,451 triangles) with a cloud of a million points, and
// with as many triangles of the same surface. A second part times the making of these shapes.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <firstcontact/geometry/point_cloud.h>
#include <firstcontact/query/first_contact.h>

#include "benchmarks/support/normalised_mesh.h"
#include "benchmarks/support/torus_knot.h"

namespace firstcontact::benchmarks {
namespace {

constexpr std::size_t kPoints = 1'000'000;

/// Makes a million points of a room of 10 m by 10 m by 3 m, as a scanner measures it.
///
/// The points lie on the floor and on a rough wall.
std::vector<Eigen::Vector3d> scanned_room() {
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> side(-5.0, 5.0);
  std::uniform_real_distribution<double> rough(-0.005, 0.005);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t k = 0; k < kPoints; ++k) {
    const double x = side(rng);
    const double y = side(rng);
    const double noise = rough(rng);
    points.emplace_back(k % 2 == 0 ? Eigen::Vector3d(x, y, noise)
                                   : Eigen::Vector3d(x, 5.0 + noise, 0.3 * (y + 5.0)));
  }
  return points;
}

const Shape& room() {
  static const Shape kRoom = make_point_cloud(scanned_room(), 0.01);
  return kRoom;
}

const Shape& knot() {
  static const Shape kKnot(torus_knot(kPoints));
  return kKnot;
}

double lowest(const Mesh& mesh) {
  double z = 0.0;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      z = std::min(z, mesh.vertices[v].z());
    }
  }
  return z;
}

/// Motions of the bunny over the floor at z = 0, which rests in the cloud's frame.
enum Course { kFarAway, kPasses, kFalls, kSkims };

Motion course(int kind) {
  Pose start;
  static const double kLowest = lowest(bunny());
  start.position = {-2.0, 0.0, kind == kFarAway ? 10.0 : kind == kSkims ? 0.02 - kLowest : 1.5};
  const Eigen::Vector3d travel =
      kind == kFalls ? Eigen::Vector3d(1.0, 1.0, -1.0) : Eigen::Vector3d(4.0, 1.0, 0.0);
  return Motion::constant_velocity(start, travel, {0.0, 0.0, kind == kSkims ? 0.0 : 2.0});
}

void ask(benchmark::State& state, const Shape& A) {
  static const Shape kBunny(bunny());
  const Motion rest = Motion::fixed({});
  const Motion moving = course(static_cast<int>(state.range(0)));
  Workspace workspace;
  FirstContactOptions options;
  options.contacts = ContactState::first;
  FirstContactResult result;
  for (auto _ : state) {
    first_contact({A, rest}, {kBunny, moving}, workspace, options, result);
    benchmark::DoNotOptimize(result);
  }
  state.counters["t"] = result.t;
  state.counters["verdict"] = static_cast<double>(result.verdict);
  state.counters["groups"] = static_cast<double>(result.work.node_groups);
  state.counters["steps"] = static_cast<double>(result.work.steps);
}

void BM_BunnyAgainstCloud(benchmark::State& state) { ask(state, room()); }
void BM_BunnyAgainstTriangles(benchmark::State& state) { ask(state, knot()); }
BENCHMARK(BM_BunnyAgainstCloud)
    ->DenseRange(kFarAway, kSkims)
    ->ArgName("course")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_BunnyAgainstTriangles)
    ->DenseRange(kFarAway, kSkims)
    ->ArgName("course")
    ->Unit(benchmark::kMicrosecond);

void BM_MakeCloud(benchmark::State& state) {
  const std::vector<Eigen::Vector3d> points = scanned_room();
  for (auto _ : state) {
    benchmark::DoNotOptimize(make_point_cloud(points));
  }
}
BENCHMARK(BM_MakeCloud)->Unit(benchmark::kMillisecond)->UseRealTime();

void BM_MakeTriangles(benchmark::State& state) {
  const Mesh mesh = torus_knot(kPoints);
  for (auto _ : state) {
    benchmark::DoNotOptimize(Shape(mesh));
  }
}
BENCHMARK(BM_MakeTriangles)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace firstcontact::benchmarks

BENCHMARK_MAIN();
