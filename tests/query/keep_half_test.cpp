// keep_half: what starts apart within the margin slides, rolls and leaves however its surface is
// cut into triangles, and comes no nearer than half of its start distance.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

#include "query/sheet.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMargin = 1e-2;
constexpr double kGap = 5e-3;  // At the start: half of the margin.

void add_rectangle(Mesh& mesh, double x0, double y0, double x1, double y1, double z, bool other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : {std::pair(x0, y0), {x1, y0}, {x1, y1}, {x0, y1}}) {
    mesh.vertices.emplace_back(x, y, z);
  }
  const std::uint32_t k = other ? 1 : 0;
  mesh.triangles.push_back({first + k, first + 1 + k, first + 2 + k});
  mesh.triangles.push_back({first + k, first + 2 + k, first + (3 + k) % 4});
}

/// The square [-2, 2]^2 at z = 0, as a fan around a point.
Mesh fan(double x, double y, int sides_cut) {
  Mesh mesh;
  mesh.vertices.emplace_back(x, y, 0.0);
  const std::vector<Vector3d> corners{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  for (std::size_t k = 0; k < 4; ++k) {
    for (int part = 0; part < sides_cut; ++part) {
      const double s = static_cast<double>(part) / sides_cut;
      mesh.vertices.emplace_back((1.0 - s) * corners[k] + s * corners[(k + 1) % 4]);
    }
  }
  const auto rim = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t k = 0; k < rim; ++k) {
    mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % rim});
  }
  return mesh;
}

/// Flush rectangles of different sizes, that share no corners and have some in others' sides.
Mesh flush_faces() {
  Mesh mesh;
  add_rectangle(mesh, -2, -2, -0.3, 2, 0, false);
  add_rectangle(mesh, -0.3, -2, 2, 0.1, 0, true);
  add_rectangle(mesh, -0.3, 0.1, 0.4, 2, 0, false);
  add_rectangle(mesh, 0.4, 0.1, 2, 1.1, 0, false);
  add_rectangle(mesh, 0.4, 1.1, 2, 2, 0, true);
  return mesh;
}

struct Named {
  std::string name;
  Shape shape;
};

/// One flat floor, cut in many ways.
std::vector<Named> floors() {
  const auto flat = [](double, double) { return 0.0; };
  Mesh diagonal;
  add_rectangle(diagonal, -2, -2, 2, 2, 0, false);
  Mesh other;
  add_rectangle(other, -2, -2, 2, 2, 0, true);
  std::vector<Named> floors;
  floors.push_back({"one diagonal", Shape(diagonal)});
  floors.push_back({"the other diagonal", Shape(other)});
  floors.push_back({"a fan", Shape(fan(0.0, 0.0, 1))});
  floors.push_back({"a fan of needles", Shape(fan(1.7, -1.9, 9))});
  floors.push_back({"a grid", Shape(test::sheet(5, flat))});
  floors.push_back({"a fine grid", Shape(test::sheet(33, flat))});
  floors.push_back({"flush faces", Shape(flush_faces())});
  return floors;
}

/// The cube [-0.5, 0.5]^3 as a primitive, and with each side cut into a grid.
std::vector<Named> cubes() {
  Mesh cut;
  const auto flat = [](double, double) { return 2.0; };  // [-2, 2]^2 at z = 2, a quarter of it.
  for (const Quaterniond& q :
       {Quaterniond(1, 0, 0, 0), Quaterniond(0, 1, 0, 0), Quaterniond(1, 1, 0, 0),
        Quaterniond(1, -1, 0, 0), Quaterniond(1, 0, 1, 0), Quaterniond(1, 0, -1, 0)}) {
    const Mesh side = test::sheet(3, flat);
    const auto first = static_cast<std::uint32_t>(cut.vertices.size());
    for (const Vector3d& v : side.vertices) {
      cut.vertices.emplace_back(0.25 * (q.normalized() * v));
    }
    for (const auto& t : side.triangles) {
      cut.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  std::vector<Named> cubes;
  cubes.push_back({"a cube", make_box({1, 1, 1})});
  cubes.push_back({"a cube cut finely", Shape(std::move(cut))});
  return cubes;
}

/// A path of the cube over the floor that rests: both are placed by `X_WF`.
struct Path {
  Vector3d from;  // Position of the cube's centre in the floor's frame.
  Vector3d way;
  Vector3d turn = Vector3d::Zero();
};

struct Answer {
  FirstContactResult result;
  double distance = 0.0;  // At t.
};

Answer ask(const Shape& floor, const Shape& cube, const Path& path, const Pose& X_WF, bool swapped,
           double margin = kMargin) {
  const Motion rest = Motion::fixed(X_WF);
  const Quaterniond& R = X_WF.rotation;
  const Motion moves = Motion::constant_velocity(
      {.position = X_WF.position + R * path.from, .rotation = R}, R * path.way, R * path.turn);
  Workspace workspace;
  FirstContactOptions options;
  options.margin = margin;
  options.start_contacts = StartContacts::keep_half;
  const MovingShape A{floor, rest};
  const MovingShape B{cube, moves};
  Answer answer;
  answer.result =
      swapped ? first_contact(B, A, workspace, options) : first_contact(A, B, workspace, options);
  answer.distance = distance(A, B, answer.result.t, workspace).distance;
  return answer;
}

/// Tests all floors, cubes and roles, at the origin and turned and far from it.
void for_each_cut(const Path& path, const std::function<void(const Answer&)>& check,
                  double margin = kMargin) {
  const Pose far{.position = {1234.5, -9876.5, 432.1},
                 .rotation = Quaterniond(0.8, -0.3, 0.5, 0.1).normalized()};
  for (const Named& floor : floors()) {
    for (const Named& cube : cubes()) {
      for (const bool swapped : {false, true}) {
        for (const bool is_far : {false, true}) {
          SCOPED_TRACE(floor.name + ", " + cube.name + (swapped ? ", swapped" : "") +
                       (is_far ? ", far" : ""));
          check(ask(floor.shape, cube.shape, path, is_far ? far : Pose{}, swapped, margin));
        }
      }
    }
  }
}

void expect_free(const Path& path, double gap = kGap, double margin = kMargin) {
  for_each_cut(
      path,
      [&](const Answer& answer) {
        EXPECT_EQ(answer.result.verdict, Verdict::free) << answer.result.t;
        EXPECT_GE(answer.result.clearance, 0.5 * gap - 1e-9);
      },
      margin);
}

/// The cube's centre where its lower side is at a height.
Vector3d above(double x, double y, double gap) { return {x, y, 0.5 + gap}; }

// A side of the cube comes over triangles that it was far from at the start.
TEST(KeepHalf, LetsACubeSlideHoweverTheFloorIsCut) {
  expect_free({above(-1.2, 0.1, kGap), {2.3, 0.3, 0.0}});
  expect_free({above(-0.4, -0.7, kGap), {0.0, 1.1, 0.0}, {0.0, 0.0, 3.0}});
}

// The smallest margin that a user sees, the tolerance; far away doubles hold no such gap.
TEST(KeepHalf, LetsACubeSlideWithinTheTolerance) {
  expect_free({above(-1.2, 0.1, 5e-7), {2.3, 0.3, 0.0}}, 5e-7, 0.0);
}

TEST(KeepHalf, LetsACubeSlideOffTheFloor) {
  expect_free({above(0.9, 0.2, kGap), {3.0, 1.0, 0.0}, {0.0, 0.0, 0.5}});
}

TEST(KeepHalf, LetsACubeRiseAndLeave) {
  expect_free({above(-0.3, 0.4, kGap), {0.2, 0.1, 0.8}, {0.3, -0.2, 0.4}});
}

TEST(KeepHalf, StopsACubeThatIsPressedOrTilted) {
  const auto stops = [](const Answer& answer) {
    ASSERT_EQ(answer.result.verdict, Verdict::contact);
    EXPECT_GE(answer.distance, 0.5 * kGap - 1e-9);
    EXPECT_LE(answer.distance, 0.5 * kGap + 1e-6 + 1e-9);
  };
  for_each_cut({above(-1.2, 0.1, kGap), {2.3, 0.3, -0.02}}, stops);
  for_each_cut({above(-0.2, 0.1, kGap), {0.3, 0.3, 0.0}, {0.4, 0.1, 0.0}}, stops);
}

/// A floor with a step up at x = 1.5, in one mesh or in many triangles.
Mesh stepped_floor(int n) {
  return test::sheet(4 * n, [](double x, double) { return x > 1.3 ? 0.4 : 0.0; });
}

// The riser was far at the start. It stops the cube, whatever the floor's part at the start allows.
TEST(KeepHalf, StopsACubeAtAStep) {
  for (const int n : {1, 2, 8}) {
    const Shape floor(stepped_floor(n));
    for (const Named& cube : cubes()) {
      for (const bool swapped : {false, true}) {
        const Answer answer =
            ask(floor, cube.shape, {above(-0.4, 0.1, kGap), {2.0, 0.0, 0.0}}, {}, swapped);
        ASSERT_EQ(answer.result.verdict, Verdict::contact) << n << cube.name;
        EXPECT_GE(answer.distance, 0.5 * kGap - 1e-9);
        EXPECT_LE(answer.distance, 0.5 * kGap + 1e-6 + 1e-9);
      }
    }
  }
}

// A prism's edges and sides come down one after the other, each from farther away than the margin.
TEST(KeepHalf, LetsAWheelRoll) {
  constexpr int kSides = 48;
  Mesh wheel;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2.0 * 3.14159265358979323846 * k / kSides;
    for (const double y : {-0.2, 0.2}) {
      wheel.vertices.emplace_back(0.5 * std::sin(angle), y, -0.5 * std::cos(angle));
    }
    const auto next = static_cast<std::uint32_t>(2 * ((k + 1) % kSides));
    const auto own = static_cast<std::uint32_t>(2 * k);
    wheel.triangles.push_back({own, own + 1, next});
    wheel.triangles.push_back({next, own + 1, next + 1});
  }
  const Shape shape(std::move(wheel));
  for (const Named& floor : floors()) {
    const Answer answer = ask(
        floor.shape, shape, {above(-1.2, 0.1, kGap), {2.0, 0.0, 0.0}, {0.0, 4.0, 0.0}}, {}, false);
    EXPECT_EQ(answer.result.verdict, Verdict::free) << floor.name << answer.result.t;
  }
}

// The start is that of the step, not of a part of it.
TEST(KeepHalf, KnowsTheStartOfTheStepAtWaypoints) {
  const Shape cube = make_box({1, 1, 1});
  const Motion rest = Motion::fixed();
  const std::vector<double> times{0.0, 0.4, 1.0};
  const std::vector<Pose> poses{{.position = above(-1.0, 0.0, kGap)},
                                {.position = above(1.0, 0.0, 0.6 * kGap)},
                                {.position = above(1.0, -1.0, 0.4 * kGap)}};
  const Motion path = Motion::waypoints(times, poses);
  FirstContactOptions options;
  options.margin = kMargin;
  options.start_contacts = StartContacts::keep_half;
  for (const Named& floor : floors()) {
    Workspace workspace;
    const FirstContactResult result =
        first_contact({floor.shape, rest}, {cube, path}, workspace, options);
    ASSERT_EQ(result.verdict, Verdict::contact) << floor.name;
    EXPECT_NEAR(result.t, 0.7, 1e-3);
  }
}

// Laws: what is proven holds at dense samples, however the floor is cut.
TEST(KeepHalf, HoldsToHalfOfTheStartDistanceAlongAnyPath) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto vector = [&] { return Vector3d(number(rng), number(rng), number(rng)); };
  const std::vector<Named> all_floors = floors();
  const Shape cube = make_box({1, 1, 1});
  int stopped = 0;
  for (int i = 0; i < test::rounds(40, 8); ++i) {
    const double gap = kMargin * std::pow(10.0, -2.0 * std::abs(number(rng)));
    const Path path{above(0.5 * number(rng), 0.5 * number(rng), gap),
                    vector().cwiseProduct(Vector3d(1.0, 1.0, gap)), gap * vector()};
    for (const Named& floor : all_floors) {
      const Answer answer = ask(floor.shape, cube, path, {}, i % 2 == 0);
      SCOPED_TRACE(floor.name + " " + std::to_string(i));
      ASSERT_NE(answer.result.verdict, Verdict::undecided);
      ASSERT_NE(answer.result.verdict, Verdict::contact_at_start);
      const double held = 0.5 * gap - 1e-12;
      EXPECT_GE(answer.result.clearance, held);
      if (answer.result.verdict == Verdict::contact) {
        ++stopped;
        EXPECT_LE(answer.distance, 0.5 * gap * (1.0 + 0x1p-9) + 1e-6);
      }
      const Motion moves = Motion::constant_velocity({.position = path.from}, path.way, path.turn);
      const Motion rest = Motion::fixed();
      Workspace workspace;
      for (int k = 0; k <= 32; ++k) {
        const double t = answer.result.t * k / 32.0;
        ASSERT_GE(distance({floor.shape, rest}, {cube, moves}, t, workspace).distance, held);
      }
    }
  }
  EXPECT_GT(stopped, test::rounds(40, 20));
}

// A wall of another body is held to the margin: a hold is of two bodies.
TEST(KeepHalf, LeavesOtherPairsTheirMargin) {
  const Shape cube = make_box({1, 1, 1});
  const Shape wall = make_box({1, 4, 2});
  const Shape floor = floors()[0].shape;
  BodySet bodies{PairRules(kMargin)};
  bodies.add(cube, Motion::constant_velocity({.position = above(-1.0, 0.0, kGap)}, {2, 0, 0}));
  bodies.add(floor, Motion::fixed());
  bodies.add(wall, Motion::fixed({.position = {1.5, 0.0, 1.5}}));
  ManyBodiesWorkspace workspace;
  ManyBodiesOptions options;
  options.pair.start_contacts = StartContacts::keep_half;
  const SceneResult result = first_contact(bodies, workspace, options);
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_NEAR(result.t, 0.5 * (1.5 - kMargin), 1e-6);
  EXPECT_GE(result.clearance, 0.5 * kGap - 1e-9);
  EXPECT_LE(result.clearance, kGap);
}

TEST(KeepHalf, ReportsAStartInContact) {
  for_each_cut({above(0.0, 0.1, 0.0), {1.0, 0.0, 0.0}}, [](const Answer& answer) {
    EXPECT_EQ(answer.result.t, 0.0);
    EXPECT_LE(answer.distance, 1e-6);
  });
}

// The budget holds for the look at the start, too.
TEST(KeepHalf, EndsWithItsBudget) {
  const Shape floor = floors()[5].shape;
  const Motion rest = Motion::fixed();
  const Motion slides = Motion::constant_velocity({.position = above(0, 0, kGap)}, {1, 0, 0});
  Workspace workspace;
  FirstContactOptions options;
  options.margin = kMargin;
  options.start_contacts = StartContacts::keep_half;
  options.budget.steps = 2;
  const Shape cube = make_box({1, 1, 1});
  const FirstContactResult result =
      first_contact({floor, rest}, {cube, slides}, workspace, options);
  EXPECT_EQ(result.verdict, Verdict::undecided);
  EXPECT_EQ(result.reason, UndecidedReason::work);
  EXPECT_EQ(result.t, 0.0);
}

}  // namespace
}  // namespace firstcontact
