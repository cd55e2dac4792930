// Times the elementary tests over the whole step: the mean time of a hit and of a miss.
//
// Both bodies move up to 1 m and turn by up to pi, each about its own axis. Features are 0.02 m to
// 0.5 m long and up to 1 m from the origin of their body. Every pair is placed so that the features
// meet inside at a random time. A miss is such a pair, moved aside by 0.01 m to 1 m. The relative
// motion is prepared once for the features of two bodies, and timed apart.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <firstcontact/narrowphase/edge_edge_contact.h>
#include <firstcontact/narrowphase/vertex_face_contact.h>

#include "benchmarks/support/random_motion.h"
#include "tests/support/random.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using test::Random;

constexpr int kPairs = 1000;  // Number of pairs of each outcome.
constexpr std::uint64_t kSeed = 20261123;

PlainMotion random_motion(Random& random) {
  return {.position = random.uniform(0.0, 1.0) * random.direction(),
          .rotation = random.rotation(),
          .translation = random.uniform(0.0, 1.0) * random.direction(),
          .rotation_vector = random.uniform(0.0, std::numbers::pi) * random.direction()};
}

RelativeMotion relative_motion(const PlainMotionPair& pair) {
  return RelativeMotion(pair.A.motion().path(0, Vector3d::Zero()),
                        pair.B.motion().path(0, Vector3d::Zero()), 1e-6);
}

/// Feature (a triangle or an edge) and a point inside it.
template <typename Feature>
std::pair<Feature, Vector3d> random_feature(Random& random) {
  const Vector3d lever = random.uniform(0.0, 1.0) * random.direction();
  const double size = 0.02 * std::pow(25.0, random.uniform(0.0, 1.0));
  Feature feature;
  Vector3d inside = Vector3d::Zero();
  double sum = 0.0;
  for (Vector3d& corner : feature) {
    corner = lever + 0.5 * size * random.direction();
    const double weight = random.uniform(0.05, 1.0);
    inside += weight * corner;
    sum += weight;
  }
  return {feature, inside / sum};
}

using Vertex = std::array<Vector3d, 1>;

struct VertexFace {
  using FeatureA = Triangle;
  using FeatureB = Vertex;
  static ElementaryContact solve(const ElementaryMotion& motion, const Triangle& face,
                                 const Vertex& vertex) {
    return vertex_face_contact(motion, face, vertex[0]);
  }
};

struct EdgeEdge {
  using FeatureA = Edge;
  using FeatureB = Edge;
  static ElementaryContact solve(const ElementaryMotion& motion, const Edge& a, const Edge& b) {
    return edge_edge_contact(motion, a, b);
  }
};

template <typename Test>
struct Query {
  ElementaryMotion motion;
  typename Test::FeatureA a;
  typename Test::FeatureB b;
  [[nodiscard]] ElementaryContact solve() const { return Test::solve(motion, a, b); }
};

template <typename Test>
Query<Test> random_query(Random& random, bool aside) {
  PlainMotionPair pair = {.A = random_motion(random), .B = random_motion(random)};
  const auto [a, point_A] = random_feature<typename Test::FeatureA>(random);
  const auto [b, point_B] = random_feature<typename Test::FeatureB>(random);
  const double t = random.uniform(0.0, 1.0);
  pair.B.position += pair.A.pose(t) * point_A - pair.B.pose(t) * point_B;
  if (aside) {
    pair.B.position += std::pow(100.0, -random.uniform(0.0, 1.0)) * random.direction();
  }
  return {ElementaryMotion(relative_motion(pair)), a, b};
}

template <typename Test>
struct Drawn {
  std::vector<Query<Test>> queries;
  int degenerate = 0;  // Number of pairs that were left out, as are misses that hit.
};

template <typename Test>
Drawn<Test> random_queries(ElementaryVerdict verdict) {
  Random random(kSeed);
  Drawn<Test> drawn;
  while (drawn.queries.size() < kPairs) {
    Query<Test> query = random_query<Test>(random, verdict == ElementaryVerdict::free);
    const ElementaryVerdict answer = query.solve().verdict;
    drawn.degenerate += answer == ElementaryVerdict::degenerate ? 1 : 0;
    if (answer == verdict) {
      drawn.queries.push_back(std::move(query));
    }
  }
  return drawn;
}

template <typename Test, ElementaryVerdict kVerdict>
void solve_all(benchmark::State& state) {
  const Drawn<Test> drawn = random_queries<Test>(kVerdict);
  int steps = 0;
  for (auto _ : state) {
    steps = 0;
    for (const Query<Test>& query : drawn.queries) {
      steps += query.solve().steps;
    }
    benchmark::DoNotOptimize(steps);
  }
  state.SetItemsProcessed(state.iterations() * kPairs);
  state.counters["steps"] = static_cast<double>(steps) / kPairs;
  state.counters["degenerate"] = drawn.degenerate;
}

void prepare_all(benchmark::State& state) {
  Random random(kSeed);
  std::vector<RelativeMotion> motions;
  for (int i = 0; i < kPairs; ++i) {
    motions.push_back(relative_motion({.A = random_motion(random), .B = random_motion(random)}));
  }
  for (auto _ : state) {
    for (const RelativeMotion& motion : motions) {
      benchmark::DoNotOptimize(ElementaryMotion(motion));
    }
  }
  state.SetItemsProcessed(state.iterations() * kPairs);
}

BENCHMARK(solve_all<VertexFace, ElementaryVerdict::contact>)->Name("vertex/face, hit");
BENCHMARK(solve_all<VertexFace, ElementaryVerdict::free>)->Name("vertex/face, miss");
BENCHMARK(solve_all<EdgeEdge, ElementaryVerdict::contact>)->Name("edge/edge, hit");
BENCHMARK(solve_all<EdgeEdge, ElementaryVerdict::free>)->Name("edge/edge, miss");
BENCHMARK(prepare_all)->Name("preparing a relative motion");

}  // namespace
}  // namespace firstcontact::benchmarks
