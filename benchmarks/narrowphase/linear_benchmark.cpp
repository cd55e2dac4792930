// Times the elementary tests of features whose corners move on lines, apart and touching.

#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <firstcontact/narrowphase/linear_contact.h>

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using Corners = std::array<LinearPoint, 4>;  // Face and vertex, or the ends of two edges.

/// Families of questions; all after `touching` are degenerate.
///
/// The degenerate ones imitate the handcrafted queries of the Tight-Inclusion benchmark (Wang et
/// al. 2021). Features lie in one plane, are parallel, collinear or of length 0, or are far from
/// the origin.
enum class Family { apart, touching, coplanar, parallel, collinear, zero_length, far };

constexpr std::array kFamilies = {Family::apart,    Family::touching,  Family::coplanar,
                                  Family::parallel, Family::collinear, Family::zero_length,
                                  Family::far};

const char* name(Family family) {
  constexpr const char* kNames[] = {"apart",     "touching",    "coplanar", "parallel",
                                    "collinear", "zero length", "far"};
  return kNames[static_cast<int>(family)];
}

/// Makes features of size 1 whose corners move by about 1, and which meet at a random time or pass.
std::vector<Corners> questions(Family family, bool edges) {
  std::mt19937_64 rng(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const bool flat = family == Family::coplanar;
  const bool line = family == Family::collinear;
  const auto vector = [&] {
    Vector3d v(uniform(rng), uniform(rng), uniform(rng));
    v.z() = flat || line ? 0.0 : v.z();
    v.y() = line ? 0.0 : v.y();
    return v;
  };
  const Vector3d offset = family == Family::far ? Vector3d(1e6, -1e6, 5e5) : Vector3d::Zero();
  std::vector<Corners> result;
  for (int i = 0; i < 1000; ++i) {
    std::array<Vector3d, 4> c{vector(), vector(), vector(), vector()};
    if (family == Family::zero_length) {
      c[1] = c[0];
    }
    if (edges) {
      const Vector3d point = 0.7 * c[0] + 0.3 * c[1];
      const Vector3d along =
          family == Family::parallel ? Vector3d(c[1] - c[0]) : Vector3d(point - c[2]);
      c[2] = point - along;
      c[3] = point + 0.5 * along;
    } else {
      c[3] = 0.2 * c[0] + 0.3 * c[1] + 0.5 * c[2];
    }
    const double t = 0.5 * (uniform(rng) + 1.0);
    const Vector3d apart =
        family == Family::apart ? Vector3d(3.0 * vector().normalized()) : Vector3d::Zero();
    const Vector3d shared = vector();
    Corners& corners = result.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      const bool of_B = k == 3 || (edges && k == 2);
      // Parallel edges stay parallel, as each feature has one velocity.
      Vector3d velocity = vector();
      if (family == Family::parallel) {
        velocity = of_B ? shared : Vector3d::Zero();
      }
      const Vector3d at = (of_B ? Vector3d(c[k] + apart) : c[k]) + offset;
      corners[k] = {at - t * velocity, at + (1.0 - t) * velocity};
    }
  }
  return result;
}

void ask(benchmark::State& state, Family family, bool edges) {
  const std::vector<Corners> all = questions(family, edges);
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

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;  // NOLINT: of this program alone.
  for (const bool edges : {false, true}) {
    for (const Family family : kFamilies) {
      const std::string name_of =
          std::string(edges ? "edge/edge" : "vertex/face") + ", " + name(family);
      benchmark::RegisterBenchmark(name_of.c_str(),
                                   [=](benchmark::State& state) { ask(state, family, edges); });
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
