// Times the first contact of many moving bodies, side by side with FCL's dynamic broad phase. FCL
// tests 100 instants of the same step.
//
//   many_bodies_benchmark [--quick] OUTPUT.json
//
// The bodies are torus knots of 5,000 triangles at random places. About one pair for each 20 bodies
// comes close. Either all bodies are free, or one pair meets at 95 % of the step. Times are wall
// times after loading, the median of three.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/many_bodies/many_bodies.h>

#include "benchmarks/support/fcl_scene.h"
#include "benchmarks/support/normalised_mesh.h"
#include "benchmarks/support/random_motion.h"
#include "benchmarks/support/timing.h"
#include "benchmarks/support/torus_knot.h"
#include "tests/support/random.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;

constexpr std::uint64_t kSeed = 20261124;
constexpr double kDensity = 1.7e-3;  // [1/m^3]  Bodies of radius 1 m that move about 2 m.
constexpr std::size_t kMostForFcl = 20'000;

std::vector<PlainMotion> random_scene(std::size_t n) {
  test::Random random(kSeed);
  const double side = std::cbrt(static_cast<double>(n) / kDensity);
  std::vector<PlainMotion> motions(n);
  for (PlainMotion& motion : motions) {
    motion.position = {random.uniform(0.0, side), random.uniform(0.0, side),
                       random.uniform(0.0, side)};
    motion.rotation = random.rotation();
    motion.translation = random.uniform(0.2, 2.0) * random.direction();
    motion.rotation_vector = random.uniform(0.0, 0.5 * std::numbers::pi) * random.direction();
  }
  return motions;
}

/// Makes a set of the scene's bodies, after it has taken every pair in contact apart.
BodySet free_set(const Shape& shape, std::vector<PlainMotion>& motions) {
  BodySet bodies;
  for (const PlainMotion& motion : motions) {
    bodies.add(shape, motion.motion());
  }
  ManyBodiesWorkspace workspace;
  ManyBodiesOptions options;
  options.pair.contacts = ContactState::none;
  double parking = -10.0;
  for (SceneResult found = first_contact(bodies, workspace, options);
       found.verdict != Verdict::free; found = first_contact(bodies, workspace, options)) {
    for (const PairAnswer& pair : found.pairs) {
      motions[pair.members[1]] = {.position = {parking, -10.0, -10.0}};
      bodies.set_motion(pair.members[1], motions[pair.members[1]].motion());
      parking -= 3.0;
    }
  }
  return bodies;
}

/// Adds two bodies, far from the others, that meet at 95 % of the step.
void add_late_contact(const Shape& shape, std::vector<PlainMotion>& motions, BodySet& bodies) {
  const PlainMotion target{.position = {0.0, 0.0, -1000.0}};
  PlainMotion arrow{.position = {4.0, 0.0, -1000.0}, .translation = {-4.0, 0.0, 0.0}};
  Workspace workspace;
  const FirstContactResult whole_way =
      first_contact({shape, target.motion()}, {shape, arrow.motion()}, workspace);
  arrow.translation *= whole_way.t / 0.95;
  for (const PlainMotion& motion : {target, arrow}) {
    motions.push_back(motion);
    bodies.add(shape, motion.motion());
  }
}

template <class Query>
double wall_ms(const Query& query) {
  std::vector<double> times;
  for (int k = 0; k < 3; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    query();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
            .count());
  }
  return quantile(times, 0.5);
}

json measure(const Shape& shape, const std::vector<PlainMotion>& motions, const BodySet& bodies,
             const char* scene) {
  std::fprintf(stderr, "  %zu bodies, %s ...\n", bodies.size(), scene);
  ManyBodiesWorkspace workspace;
  SceneResult result;
  const auto with_threads = [&](int threads) {
    ManyBodiesOptions options;
    options.threads = threads;
    return wall_ms([&] { result = first_contact(bodies, workspace, options); });
  };
  json out = {{"bodies", bodies.size()},
              {"scene", scene},
              {"one_thread_ms", with_threads(1)},
              {"two_threads_ms", with_threads(2)},
              {"contact", result.verdict == Verdict::contact},
              {"t", result.t},
              {"node_groups", result.work.node_groups}};
  if (bodies.size() <= kMostForFcl) {
    FclScene peer(shape.mesh(), motions);
    FclScene::Answer answer;
    out["fcl_100_samples_ms"] = wall_ms([&] { answer = peer.sample(100); });
    out["fcl_contact"] = answer.contact;
    out["fcl_t"] = answer.t;
  }
  return out;
}

json measure_all(bool quick) {
  const Shape shape(normalised(torus_knot(5'000)));
  json out = json::array();
  for (const std::size_t n : {100, 1'000, 10'000, 100'000}) {
    if (quick && n > 1'000) {
      break;
    }
    std::vector<PlainMotion> motions = random_scene(n);
    BodySet bodies = free_set(shape, motions);
    out.push_back(measure(shape, motions, bodies, "free"));
    add_late_contact(shape, motions, bodies);
    out.push_back(measure(shape, motions, bodies, "late contact"));
  }
  return out;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  const bool quick = argc == 3 && std::string(argv[1]) == "--quick";
  if (argc != 2 && !quick) {
    std::fprintf(stderr, "usage: many_bodies_benchmark [--quick] OUTPUT.json\n");
    return 2;
  }
  std::ofstream(argv[argc - 1]) << firstcontact::benchmarks::measure_all(quick).dump(2) << '\n';
  return EXIT_SUCCESS;
}
