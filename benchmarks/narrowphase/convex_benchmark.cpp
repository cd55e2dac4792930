// Times the certified first contact of pairs of convex sets beside FCL's continuousCollide of the
// same bodies. A second part times a curved body against a mesh, beside the prism around that body.
// FCL samples: its naive solver calls collide() at 10 times, and misses contacts between them. Its
// conservative advancement does not support cylinders, and its libccd solver aborts on some of
// these pairs.
//
// Bodies of 0.2 m to 1 m move by 1 m to 3 m towards or past each other and turn by up to pi. Each
// run queries 256 pairs in turn, so that the processor cannot predict the branches of any. About
// half of the pairs meet.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/narrowphase/continuous_collision.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/query/first_contact.h>

#include "benchmarks/support/torus_knot.h"
#include "tests/support/random.h"

namespace firstcontact::benchmarks {
namespace {

using Eigen::Vector3d;
using test::Random;

constexpr std::uint64_t kSeed = 20261126;
constexpr std::size_t kPairs = 256;

enum class Kind { sphere, capsule, box, cylinder, cone, ellipsoid };

struct Course {
  Pose start;
  Vector3d translation;
  Vector3d rotation;

  [[nodiscard]] Motion motion() const {
    return Motion::constant_velocity(start, translation, rotation);
  }
};

struct Case {
  Shape A;
  Shape B;
  Course course_A;
  Course course_B;
  Vector3d size_A;
  Vector3d size_B;
};

Shape make(Kind kind, const Vector3d& size) {
  switch (kind) {
    case Kind::sphere:
      return make_sphere(size.x());
    case Kind::capsule:
      return make_capsule(size.x(), size.z());
    case Kind::box:
      return make_box(2.0 * size);
    case Kind::cylinder:
      return make_cylinder(size.x(), size.z());
    case Kind::cone:
      return make_cone(size.x(), size.z());
    case Kind::ellipsoid:
      break;
  }
  return make_ellipsoid(size);
}

std::shared_ptr<fcl::CollisionGeometryd> make_fcl(Kind kind, const Vector3d& size) {
  switch (kind) {
    case Kind::capsule:
      return std::make_shared<fcl::Capsuled>(size.x(), size.z());
    case Kind::cylinder:
      return std::make_shared<fcl::Cylinderd>(size.x(), size.z());
    case Kind::cone:
      return std::make_shared<fcl::Coned>(size.x(), size.z());
    default:
      return std::make_shared<fcl::Ellipsoidd>(size.x(), size.y(), size.z());
  }
}

/// Returns the random cases of a pair of kinds, made once for each pair.
const std::vector<Case>& random_cases(Kind kind_A, Kind kind_B) {
  static std::map<std::pair<Kind, Kind>, std::vector<Case>> kept;
  std::vector<Case>& cases = kept[{kind_A, kind_B}];
  if (!cases.empty()) {
    return cases;
  }
  Random random(kSeed);
  for (std::size_t k = 0; k < kPairs; ++k) {
    const auto size = [&] {
      const double x = random.uniform(0.1, 0.5);
      const double y = random.uniform(0.1, 0.5);
      return Vector3d(x, y, random.uniform(0.1, 0.5));
    };
    const Vector3d size_A = size();
    const Vector3d size_B = size();
    const Vector3d from = random.vector(1.2, 2.0);
    const Course A{{.rotation = random.rotation()},
                   random.vector(0.0, 0.5),
                   random.vector(0.0, std::numbers::pi)};
    const Course B{{.position = from, .rotation = random.rotation()},
                   -from + random.vector(0.0, 1.6),
                   random.vector(0.0, std::numbers::pi)};
    cases.push_back({make(kind_A, size_A), make(kind_B, size_B), A, B, size_A, size_B});
  }
  return cases;
}

template <class Ask>
void run(benchmark::State& state, std::size_t count, const Ask& ask) {
  std::size_t k = 0;
  std::uint64_t steps = 0;
  std::uint64_t contacts = 0;
  std::uint64_t asked = 0;
  FirstContactResult result;
  for (auto _ : state) {
    ask(k, result);
    benchmark::DoNotOptimize(result.t);
    steps += result.work.steps;
    contacts += is_contact(result.verdict) ? 1 : 0;
    ++asked;
    k = k + 1 == count ? 0 : k + 1;
  }
  state.counters["steps"] = static_cast<double>(steps) / static_cast<double>(asked);
  state.counters["contacts"] = static_cast<double>(contacts) / static_cast<double>(asked);
}

/// @param exact  whether the curved surfaces are tested, else their triangles
void first_contact_of(benchmark::State& state, Kind kind_A, Kind kind_B, bool exact,
                      ContactState contacts) {
  std::vector<Case> cases = random_cases(kind_A, kind_B);
  std::vector<std::pair<Motion, Motion>> motions;
  for (Case& c : cases) {
    motions.emplace_back(c.course_A.motion(), c.course_B.motion());
    if (!exact) {
      c.A = c.A.as_triangles();
      c.B = c.B.as_triangles();
    }
  }
  Workspace workspace;
  const FirstContactOptions options{.contacts = contacts};
  run(state, cases.size(), [&](std::size_t k, FirstContactResult& result) {
    first_contact({cases[k].A, motions[k].first}, {cases[k].B, motions[k].second}, workspace,
                  options, result);
  });
}

void BM_Pair(benchmark::State& state, Kind A, Kind B) {
  first_contact_of(state, A, B, true, ContactState::none);
}
void BM_PairWithContacts(benchmark::State& state, Kind A, Kind B) {
  first_contact_of(state, A, B, true, ContactState::nearest());
}
void BM_PairByTriangles(benchmark::State& state, Kind A, Kind B) {
  first_contact_of(state, A, B, false, ContactState::none);
}
void BM_PairFcl(benchmark::State& state, Kind A, Kind B) {
  struct FclCase {
    std::shared_ptr<fcl::CollisionGeometryd> A;
    std::shared_ptr<fcl::CollisionGeometryd> B;
    std::shared_ptr<fcl::InterpMotion<double>> X_WA;
    std::shared_ptr<fcl::InterpMotion<double>> X_WB;
  };
  std::vector<FclCase> cases;
  for (const Case& c : random_cases(A, B)) {
    const auto motion = [](const Course& course) {
      const Motion m = course.motion();
      const auto at = [&](double t) {
        const Pose pose = m.pose(t);
        fcl::Transform3d X = fcl::Transform3d::Identity();
        X.linear() = pose.rotation.normalized().toRotationMatrix();
        X.translation() = pose.position;
        return X;
      };
      return std::make_shared<fcl::InterpMotion<double>>(at(0.0), at(1.0));
    };
    cases.push_back(
        {make_fcl(A, c.size_A), make_fcl(B, c.size_B), motion(c.course_A), motion(c.course_B)});
  }
  fcl::ContinuousCollisionRequestd request;
  request.ccd_motion_type = fcl::CCDM_LINEAR;
  request.gjk_solver_type = fcl::GST_INDEP;
  request.ccd_solver_type = fcl::CCDC_NAIVE;
  std::size_t k = 0;
  for (auto _ : state) {
    const FclCase& c = cases[k];
    fcl::ContinuousCollisionResultd result;
    benchmark::DoNotOptimize(
        fcl::continuousCollide(c.A.get(), c.X_WA.get(), c.B.get(), c.X_WB.get(), request, result));
    k = k + 1 == cases.size() ? 0 : k + 1;
  }
}

/// Times a cylinder that moves towards a torus knot of 20,000 triangles.
void against_mesh(benchmark::State& state, bool exact) {
  const Shape knot(torus_knot(static_cast<std::size_t>(state.range(0))));
  const Motion rest = Motion::fixed();
  Random random(kSeed);
  std::vector<Shape> shapes;
  std::vector<Motion> motions;
  const double size = knot.hierarchy().radius;
  for (std::size_t k = 0; k < 64; ++k) {
    const Shape cylinder = make_cylinder(0.1 * size, 0.3 * size);
    shapes.push_back(exact ? cylinder : cylinder.as_triangles());
    const Vector3d from = random.vector(1.5, 2.0) * size;
    motions.push_back(Motion::constant_velocity({.position = from, .rotation = random.rotation()},
                                                -from + random.vector(0.0, 0.8) * size,
                                                random.vector(0.0, std::numbers::pi)));
  }
  Workspace workspace;
  const FirstContactOptions options{.tolerance = 1e-6 * size, .contacts = ContactState::none};
  run(state, shapes.size(), [&](std::size_t k, FirstContactResult& result) {
    first_contact({shapes[k], motions[k]}, {knot, rest}, workspace, options, result);
  });
}

void BM_CylinderOnMesh(benchmark::State& state) { against_mesh(state, true); }
void BM_PrismOnMesh(benchmark::State& state) { against_mesh(state, false); }
BENCHMARK(BM_CylinderOnMesh)->Arg(20'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_PrismOnMesh)->Arg(20'000)->Unit(benchmark::kMicrosecond);

#define FIRSTCONTACT_CONVEX_PAIR(name, A, B)                      \
  BENCHMARK_CAPTURE(BM_Pair, name, Kind::A, Kind::B);             \
  BENCHMARK_CAPTURE(BM_PairWithContacts, name, Kind::A, Kind::B); \
  BENCHMARK_CAPTURE(BM_PairByTriangles, name, Kind::A, Kind::B)

FIRSTCONTACT_CONVEX_PAIR(cylinders, cylinder, cylinder);
FIRSTCONTACT_CONVEX_PAIR(ellipsoids, ellipsoid, ellipsoid);
FIRSTCONTACT_CONVEX_PAIR(cones, cone, cone);
FIRSTCONTACT_CONVEX_PAIR(box_and_cylinder, box, cylinder);
FIRSTCONTACT_CONVEX_PAIR(capsule_and_cylinder, capsule, cylinder);
FIRSTCONTACT_CONVEX_PAIR(sphere_and_ellipsoid, sphere, ellipsoid);
BENCHMARK_CAPTURE(BM_PairFcl, cylinders, Kind::cylinder, Kind::cylinder);
BENCHMARK_CAPTURE(BM_PairFcl, ellipsoids, Kind::ellipsoid, Kind::ellipsoid);
BENCHMARK_CAPTURE(BM_PairFcl, cones, Kind::cone, Kind::cone);

}  // namespace
}  // namespace firstcontact::benchmarks
