// Times the hard cases, each with its counts of work; every case should take less than 10 ms.

#include <benchmark/benchmark.h>

#include <vector>

#include "benchmarks/query/hard_cases.h"

namespace firstcontact::benchmarks {
namespace {

void BM_HardCase(benchmark::State& state, const HardCase& c) {
  Workspace workspace;
  FirstContactResult result;
  for (auto _ : state) {
    first_contact(c.moving_A(), c.moving_B(), workspace, c.options, result);
    benchmark::DoNotOptimize(result);
  }
  if (result.verdict != c.verdict) {
    state.SkipWithError("wrong verdict");
  }
  state.counters["node_groups"] = static_cast<double>(result.work.node_groups);
  state.counters["triangle_pairs"] = static_cast<double>(result.work.triangle_pairs);
  state.counters["contacts"] = static_cast<double>(result.contacts.size());
  state.counters["steps"] = static_cast<double>(result.work.steps);
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  const std::vector<firstcontact::benchmarks::HardCase> cases =
      firstcontact::benchmarks::hard_cases();
  for (const auto& c : cases) {
    benchmark::RegisterBenchmark(c.name.c_str(), [&c](benchmark::State& state) {
      firstcontact::benchmarks::BM_HardCase(state, c);
    })->Unit(benchmark::kMicrosecond);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
