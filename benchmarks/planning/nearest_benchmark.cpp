// Times the nearest place of a tree of places of a body, by the tree's index and by a scan.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <limits>
#include <vector>

#include <firstcontact/edges/configuration_space.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/math/random_numbers.h>
#include <firstcontact/planning/detail/plan_tree.h>

namespace firstcontact::benchmarks {
namespace {

/// A tree of samples, and other samples to which the nearest is asked for.
struct Places {
  explicit Places(std::size_t count) {
    RandomNumbers random(1);
    for (std::size_t k = 0; k < count; ++k) {
      tree.add(space.sample(random), detail::kNoParent);
    }
    for (int k = 0; k < 1'000; ++k) {
      asked.push_back(space.sample(random));
    }
  }

  ConfigurationSpace space =
      ConfigurationSpace::of_body("part", make_box({0.1, 0.2, 0.3}), {-1, -1, -1}, {1, 1, 1});
  detail::PlanTree tree{space};
  std::vector<Configuration> asked;
};

std::size_t by_scan(const Places& places, const Configuration& q) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t node = 0; node < places.tree.size(); ++node) {
    const double distance = places.space.distance(places.tree[node], q);
    if (distance < least) {
      least = distance;
      nearest = node;
    }
  }
  return nearest;
}

template <class Find>
void measure(benchmark::State& state, const Find& find) {
  const Places places(static_cast<std::size_t>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(find(places, places.asked[next]));
    next = (next + 1) % places.asked.size();
  }
}

void BM_NearestByIndex(benchmark::State& state) {
  measure(state,
          [](const Places& places, const Configuration& q) { return places.tree.nearest(q); });
}
BENCHMARK(BM_NearestByIndex)->RangeMultiplier(10)->Range(100, 100'000)->ArgName("places");

void BM_NearestByScan(benchmark::State& state) { measure(state, by_scan); }
BENCHMARK(BM_NearestByScan)->RangeMultiplier(10)->Range(100, 100'000)->ArgName("places");

}  // namespace
}  // namespace firstcontact::benchmarks
