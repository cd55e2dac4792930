// Times the building of the hierarchy of a torus knot, on one and on two threads.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <cstddef>

#include <firstcontact/geometry/hierarchy.h>

#include "benchmarks/support/normalised_mesh.h"
#include "benchmarks/support/torus_knot.h"

namespace firstcontact::benchmarks {
namespace {

void BM_BuildHierarchy(benchmark::State& state) {
  const Mesh mesh = normalised(torus_knot(static_cast<std::size_t>(state.range(0))));
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(1)));
  std::size_t nodes = 0;
  for (auto _ : state) {
    const Hierarchy hierarchy = build_hierarchy(mesh);
    nodes = hierarchy.nodes.size();
    benchmark::DoNotOptimize(nodes);
  }
  state.counters["nodes"] = static_cast<double>(nodes);
}
BENCHMARK(BM_BuildHierarchy)
    ->ArgsProduct({{10'000, 100'000, 1'000'000}, {1, 2}})
    ->ArgNames({"triangles", "threads"})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace firstcontact::benchmarks
