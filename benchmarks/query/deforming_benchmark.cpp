// Times the first contact of the bunny (69,451 triangles), which moves rigidly, with a deforming
// sheet of 9,800 triangles. The same sheet without deformation is timed beside it, and so is the
// deformation.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/query/first_contact.h>

#include "benchmarks/support/normalised_mesh.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr int kSide = 70;        // Number of squares along a side, of two triangles each.
constexpr double kHeight = 1.3;  // [m]  The bunny's radius is 1.

const Mesh& sheet() {
  static const Mesh kSheet = [] {
    Mesh mesh;
    for (int i = 0; i <= kSide; ++i) {
      for (int j = 0; j <= kSide; ++j) {
        mesh.vertices.emplace_back(4.0 * i / kSide - 2.0, 4.0 * j / kSide - 2.0, kHeight);
      }
    }
    const auto index = [](int i, int j) { return static_cast<std::uint32_t>(i * (kSide + 1) + j); };
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
        mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
      }
    }
    return mesh;
  }();
  return kSheet;
}

template <class Place>
Points moved(const Place& place) {
  Points to;
  for (const Vector3d& v : sheet().vertices) {
    to.push_back(place(v));
  }
  return to;
}

/// Motion of the sheet.
struct Course {
  const char* name;
  Points to;
};

std::vector<Course> courses() {
  const auto waves = [](const Vector3d& v, double height) {
    return height * std::sin(3.0 * v.x()) * std::cos(2.0 * v.y());
  };
  return {
      {"rises",
       moved([&](const Vector3d& v) { return Vector3d(v.x(), v.y(), 2.0 + waves(v, 0.2)); })},
      {"ripples, near", moved([&](const Vector3d& v) {
         return Vector3d(v.x(), v.y(), kHeight - 0.15 + waves(v, 0.05));
       })},
      {"drapes", moved([](const Vector3d& v) {
         return Vector3d(v.x(), v.y(), 0.4 - 0.3 * v.head<2>().squaredNorm());
       })},
      {"falls", moved([&](const Vector3d& v) { return Vector3d(v.x(), v.y(), waves(v, 0.1)); })},
      {"folds over", moved([](const Vector3d& v) {
         return v.x() < 0.0 ? Vector3d(-v.x(), v.y(), v.z() - 0.5) : Vector3d(v);
       })},
  };
}

void ask(benchmark::State& state, const DeformingBody& body) {
  static const Shape kBunny(bunny());
  const Motion turning = Motion::constant_velocity(Pose{}, {0.1, 0.0, 0.0}, {0.3, 0.0, 1.0});
  Workspace workspace;
  FirstContactOptions options;
  options.contacts = ContactState::first;
  FirstContactResult result;
  for (auto _ : state) {
    first_contact({body.shape, body.X_WS}, {kBunny, turning}, workspace, options, result);
    benchmark::DoNotOptimize(result);
  }
  state.counters["t"] = result.t;
  state.counters["node_groups"] = static_cast<double>(result.work.node_groups);
  state.counters["triangle_pairs"] = static_cast<double>(result.work.triangle_pairs);
  state.counters["steps"] = static_cast<double>(result.work.steps);
}

void deform(benchmark::State& state, const Shape& shape, const Points& to) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(move_vertices(shape, to));
  }
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;  // NOLINT: of this program alone.
  namespace fc = firstcontact;
  const fc::Shape shape(sheet());
  for (const Course& course : courses()) {
    const fc::DeformingBody body = move_vertices(shape, course.to);
    benchmark::RegisterBenchmark(("sheet " + std::string(course.name)).c_str(),
                                 [=](benchmark::State& state) { ask(state, body); })
        ->Unit(benchmark::kMicrosecond);
  }
  for (const double way : {-0.15, -1.3}) {
    const fc::DeformingBody body{
        shape, fc::Motion::constant_velocity(fc::Pose{}, Vector3d(0.0, 0.0, way))};
    benchmark::RegisterBenchmark(way > -1.0 ? "rigid sheet, near" : "rigid sheet falls",
                                 [=](benchmark::State& state) { ask(state, body); })
        ->Unit(benchmark::kMicrosecond);
  }
  benchmark::RegisterBenchmark("move_vertices", [=](benchmark::State& state) {
    deform(state, shape, courses()[3].to);
  })->Unit(benchmark::kMicrosecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
