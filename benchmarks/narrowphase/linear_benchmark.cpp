// Time of the elementary tests of features whose corners move on lines, apart and touching.

#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <random>
#include <vector>

#include <firstcontact/narrowphase/linear_contact.h>

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using Corners = std::array<LinearPoint, 4>;  // Face and vertex, or the ends of two edges.

enum Case { kApart, kTouching, kCoplanar };

/// Features of size 1 whose corners move by about 1; that meet at a random time, or pass.
std::vector<Corners> questions(int kind, bool edges) {
  std::mt19937_64 rng(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] {
    return Vector3d(uniform(rng), uniform(rng), kind == kCoplanar ? 0.0 : uniform(rng));
  };
  std::vector<Corners> result;
  for (int i = 0; i < 1000; ++i) {
    std::array<Vector3d, 4> c{vector(), vector(), vector(), vector()};
    if (edges) {
      c[3] = 0.7 * c[0] + 0.3 * c[1] + 0.5 * (0.7 * c[0] + 0.3 * c[1] - c[2]);
    } else {
      c[3] = 0.2 * c[0] + 0.3 * c[1] + 0.5 * c[2];
    }
    const double t = 0.5 * (uniform(rng) + 1.0);
    const Vector3d apart =
        kind == kApart ? Vector3d(3.0 * vector().normalized()) : Vector3d::Zero();
    Corners& corners = result.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3d velocity = vector();
      const bool of_B = k == 3 || (edges && k == 2);
      const Vector3d at = of_B ? Vector3d(c[k] + apart) : c[k];
      corners[k] = {at - t * velocity, at + (1.0 - t) * velocity};
    }
  }
  return result;
}

void ask(benchmark::State& state, bool edges) {
  const std::vector<Corners> all = questions(static_cast<int>(state.range(0)), edges);
  std::size_t i = 0;
  double steps = 0.0;
  double contacts = 0.0;
  for (auto _ : state) {
    const Corners& c = all[i++ % all.size()];
    const LinearContact answer = edges ? linear_edge_edge_contact({c[0], c[1]}, {c[2], c[3]})
                                       : linear_vertex_face_contact(c[3], {c[0], c[1], c[2]});
    steps += answer.steps;
    contacts += answer.verdict == LinearVerdict::contact ? 1.0 : 0.0;
  }
  state.counters["steps"] = benchmark::Counter(steps, benchmark::Counter::kAvgIterations);
  state.counters["contacts"] = benchmark::Counter(contacts, benchmark::Counter::kAvgIterations);
}

void BM_VertexFace(benchmark::State& state) { ask(state, false); }
void BM_EdgeEdge(benchmark::State& state) { ask(state, true); }
BENCHMARK(BM_VertexFace)->DenseRange(kApart, kCoplanar)->ArgName("case");
BENCHMARK(BM_EdgeEdge)->DenseRange(kApart, kCoplanar)->ArgName("case");

}  // namespace
}  // namespace firstcontact::benchmarks

BENCHMARK_MAIN();
