// A tool follows a target that is free, whatever the shapes near it.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/contact_loop.h>

#include "haptics/haptic_scenes.h"

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kCycle = 2e-3;  // [s]
constexpr std::size_t kSides = test::rounds(300, 150);

/// Makes a prism about z. With `pin` a small tetrahedron stands apart from it, so that no convex
/// set is the same body.
Shape make_prism(std::size_t sides, double radius, double length, bool has_pin) {
  Mesh mesh;
  const auto number = [](std::size_t k) { return static_cast<std::uint32_t>(k); };
  for (const double z : {-0.5 * length, 0.5 * length}) {
    for (std::size_t k = 0; k < sides; ++k) {
      const double angle =
          2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sides);
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  mesh.vertices.emplace_back(0.0, 0.0, -0.5 * length);
  mesh.vertices.emplace_back(0.0, 0.0, 0.5 * length);
  for (std::size_t k = 0; k < sides; ++k) {
    const std::size_t next = (k + 1) % sides;
    mesh.triangles.push_back({number(k), number(next), number(sides + next)});
    mesh.triangles.push_back({number(k), number(sides + next), number(sides + k)});
    mesh.triangles.push_back({number(2 * sides), number(next), number(k)});
    mesh.triangles.push_back({number(2 * sides + 1), number(sides + k), number(sides + next)});
  }
  if (has_pin) {
    const std::uint32_t first = number(mesh.vertices.size());
    const double size = 0.1 * radius;
    mesh.vertices.emplace_back(0.0, 0.0, 0.5 * length + size);
    mesh.vertices.emplace_back(size, 0.0, 0.5 * length + 2.0 * size);
    mesh.vertices.emplace_back(0.0, size, 0.5 * length + 2.0 * size);
    mesh.vertices.emplace_back(0.0, 0.0, 0.5 * length + 3.0 * size);
    mesh.triangles.push_back({first, first + 2, first + 1});
    mesh.triangles.push_back({first, first + 1, first + 3});
    mesh.triangles.push_back({first + 1, first + 2, first + 3});
    mesh.triangles.push_back({first + 2, first, first + 3});
  }
  return Shape(std::move(mesh));
}

/// Makes two bars that cross: the lower one lies along x, the tool along y.
HapticScene crossed(Shape lower, Shape tool) {
  const double right_angle = 0.5 * std::numbers::pi;
  HapticScene scene;
  scene.bodies.push_back(body_at("bar", std::move(lower), {0.0, 0.0, -0.02}));
  scene.bodies[0].X_WB.rotation = Eigen::AngleAxisd(right_angle, Vector3d::UnitY());
  scene.tools.push_back(tool_at("tool", std::move(tool), {0.0, 0.0, 0.021}));
  scene.tools[0].X_WB.rotation = Eigen::AngleAxisd(right_angle, Vector3d::UnitX());
  return scene;
}

/// The target of a hand that presses a tool down by 5 mm and turns it, then lifts it by 2 cm.
Pose target_at(const Pose& start, double time) {
  constexpr double kStroke = 0.2;  // [s]
  const double down = std::min(1.0, time / kStroke);
  const double up = std::clamp((time - 1.5 * kStroke) / kStroke, 0.0, 1.0);
  const double part = down * (1.0 - up);
  const Vector3d turn = part * Vector3d(0.3, 0.2, 0.3);
  Pose target = start;
  target.position += part * Vector3d(0.002, 0.001, -0.005) + up * Vector3d(0.0, 0.0, 0.02);
  if (turn.norm() > 0.0) {
    target.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * start.rotation;
  }
  return target;
}

void expect_that_it_follows(const HapticScene& scene, int most_unproven) {
  ContactLoop loop(scene);
  const Pose start = scene.tools[0].X_WB;
  int unproven = 0;
  for (int k = 0; k < 275; ++k) {
    const Pose target = target_at(start, kCycle * k);
    const HapticCycle& cycle = loop.advance(std::array{target}, kCycle, k);
    unproven += cycle.is_unproven ? 1 : 0;
    EXPECT_GT(cycle.clearance, 0.4 * loop.contact_distance());
    EXPECT_EQ(loop.contact_set().is_unproven, cycle.is_unproven);
  }
  EXPECT_LT((loop.pose(0).position - target_at(start, 1.0).position).norm(), 1e-9);
  EXPECT_LE(unproven, most_unproven);
}

TEST(FreeTarget, IsFollowedFromACylinderThatCrosses) {
  expect_that_it_follows(crossed(make_cylinder(0.02, 0.2), make_cylinder(0.02, 0.08)), 0);
}

TEST(FreeTarget, IsFollowedFromACone) {
  expect_that_it_follows(crossed(make_cylinder(0.02, 0.2), make_cone(0.02, 0.08)), 0);
}

TEST(FreeTarget, IsFollowedFromAConvexMeshOfThinTriangles) {
  expect_that_it_follows(
      crossed(make_prism(300, 0.02, 0.2, false), make_prism(300, 0.02, 0.08, false)), 0);
}

// No convex set serves here: shorter motions are proven.
TEST(FreeTarget, IsFollowedFromAMeshOfThinTriangles) {
  expect_that_it_follows(
      crossed(make_prism(kSides, 0.02, 0.2, true), make_prism(kSides, 0.02, 0.08, true)), 0);
}

// A deadline that no proof can keep: proofs of later cycles may take longer, and the tool goes on.
TEST(FreeTarget, IsFollowedThoughCyclesAreShort) {
  using Clock = std::chrono::steady_clock;
  const HapticScene scene =
      crossed(make_prism(kSides, 0.02, 0.2, true), make_prism(kSides, 0.02, 0.08, true));
  const Pose start = scene.tools[0].X_WB;
  const auto press = [&](ContactLoop& loop) {
    for (int k = 0; k < 110; ++k) {
      (void)loop.advance(std::array{target_at(start, kCycle * k)}, kCycle, k);
    }
  };
  const Pose lifted = target_at(start, 1.0);
  // The deadline is a share of the time that this machine takes for the first cycle.
  ContactLoop unhurried(scene);
  press(unhurried);
  const auto begin = Clock::now();
  (void)unhurried.advance(std::array{lifted}, kCycle, 0);
  const auto period = (Clock::now() - begin) / 8;
  ContactLoop loop(scene);
  press(loop);
  const auto left = [&] { return (loop.pose(0).position - lifted.position).norm(); };
  for (int k = 0; k < 300 && left() > 0.0; ++k) {
    (void)loop.advance(std::array{lifted}, kCycle, k, Clock::now() + period);
  }
  EXPECT_LT(left(), 1e-9);
}

}  // namespace
}  // namespace firstcontact
