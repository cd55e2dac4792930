// Times the same motions on torus knots of 1,000 to 1,000,000 triangles, to show how the time of a
// query grows.
//
//   growth_benchmark [--quick] OUTPUT.json
//
// Processor times of one thread; cold and warm as in first_contact_benchmark.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/query/first_contact.h>

#include "benchmarks/support/normalised_mesh.h"
#include "benchmarks/support/random_motion.h"
#include "benchmarks/support/timing.h"
#include "benchmarks/support/torus_knot.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;

constexpr std::uint64_t kSeed = 20261122;

json measure(std::size_t triangles, int motions) {
  const Shape shape(normalised(torus_knot(triangles)));
  Workspace workspace;
  FirstContactResult result;
  std::vector<double> cold;
  std::vector<double> warm;
  std::vector<double> node_groups;
  for (const PlainMotionPair& pair : random_motions(shape, shape, motions, kSeed)) {
    const Motion motion_A = pair.A.motion();
    const Motion motion_B = pair.B.motion();
    const auto query = [&] {
      first_contact({shape, motion_A}, {shape, motion_B}, workspace, {}, result);
    };
    evict_caches();
    cold.push_back(time_of(query));
    warm.push_back(quantile({time_of(query), time_of(query), time_of(query)}, 0.5));
    node_groups.push_back(static_cast<double>(result.work.node_groups));
  }
  return {{"triangles", shape.mesh().triangles.size()},      {"motions", motions},
          {"cold_median_us", quantile(cold, 0.5)},           {"cold_p99_us", quantile(cold, 0.99)},
          {"warm_median_us", quantile(warm, 0.5)},           {"warm_p99_us", quantile(warm, 0.99)},
          {"node_groups_median", quantile(node_groups, 0.5)}};
}

json measure_all(int motions) {
  json out = json::array();
  for (const std::size_t triangles : {1'000, 10'000, 100'000, 1'000'000}) {
    std::fprintf(stderr, "  knot of %zu triangles ...\n", triangles);
    out.push_back(measure(triangles, motions));
  }
  return out;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  const bool quick = argc == 3 && std::string(argv[1]) == "--quick";
  if (argc != 2 && !quick) {
    std::fprintf(stderr, "usage: growth_benchmark [--quick] OUTPUT.json\n");
    return 2;
  }
  std::ofstream(argv[argc - 1]) << firstcontact::benchmarks::measure_all(quick ? 40 : 200).dump(2)
                                << '\n';
  return EXIT_SUCCESS;
}
