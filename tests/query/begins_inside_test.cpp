// Bodies that begin inside of surfaces.

#include <firstcontact/query/begins_inside.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/query/first_contact.h>

namespace firstcontact {
namespace {

using Eigen::Vector3d;

Pose pose_of(std::mt19937_64& rng, double reach) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(-reach, reach);
  Pose pose;
  for (double& coordinate : pose.position) {
    coordinate = place(rng);
  }
  for (double& part : pose.rotation.coeffs()) {  // One by one: compilers order arguments freely.
    part = normal(rng);
  }
  return pose;
}

/// The same triangles as a surface.
Shape surface_of(const Shape& solid) { return Shape(solid.mesh()); }

// Exact: where a body does not touch a surface, it begins inside of it if and only if it touches
// the solid that the surface bounds.
TEST(BeginsInside, SaysWhatTheSolidWouldSay) {
  std::mt19937_64 rng(17);
  Workspace workspace;
  int inside = 0;
  const std::array solids = {make_box({2.0, 3.0, 1.5}), make_cylinder(1.2, 2.0, 0.01)};
  const std::array surfaces = {surface_of(solids[0]), surface_of(solids[1])};
  const Shape small = make_box({0.1, 0.2, 0.15});
  for (int k = 0; k < 600; ++k) {
    const Shape& solid = solids[static_cast<std::size_t>(k % 2)];
    const Shape& surface = surfaces[static_cast<std::size_t>(k % 2)];
    const Pose X_WA = pose_of(rng, k < 300 ? 1.0 : 1e6);
    Pose X_WB = pose_of(rng, 1.8);
    X_WB.position += X_WA.position;
    const Motion A = Motion::fixed(X_WA);
    const Motion B = Motion::fixed(X_WB);
    if (first_contact({surface, A}, {small, B}, workspace).verdict != Verdict::free) {
      continue;  // The surfaces touch.
    }
    const bool truth =
        first_contact({solid, A}, {small, B}, workspace).verdict == Verdict::contact_at_start;
    const std::vector<ShapeAtStart> shapes = {{&surface, X_WA}, {&small, X_WB}};
    const std::vector<BeginsInside> expected =
        truth ? std::vector<BeginsInside>{{.inside = 1, .around = 0}} : std::vector<BeginsInside>();
    ASSERT_EQ(find_begins_inside(shapes), expected) << k;
    inside += truth ? 1 : 0;
  }
  EXPECT_GT(inside, 50);
}

TEST(BeginsInside, IsNotAskedOfSolidsOrBeyondTheSurface) {
  const Shape solid = make_box({2.0, 2.0, 2.0});
  const Shape surface = surface_of(solid);
  const Shape ball = make_sphere(0.1);
  const Pose away{.position = {1.5, 0.0, 0.0}, .rotation = Eigen::Quaterniond::Identity()};
  EXPECT_TRUE(find_begins_inside(std::vector<ShapeAtStart>{{&solid, {}}, {&ball, {}}}).empty());
  EXPECT_TRUE(find_begins_inside(std::vector<ShapeAtStart>{{&surface, {}}, {&ball, away}}).empty());
  EXPECT_TRUE(find_begins_inside({}).empty());
}

TEST(BeginsInside, ComesInTheOrderOfSurfacesThenBodies) {
  const Shape outer = surface_of(make_box({9.0, 9.0, 9.0}));
  const Shape inner = surface_of(make_box({3.0, 3.0, 3.0}));
  const Shape ball = make_sphere(0.1);
  const std::vector<ShapeAtStart> shapes = {{&ball, {}}, {&inner, {}}, {&outer, {}}, {&ball, {}}};
  const std::vector<BeginsInside> expected = {{0, 1}, {3, 1}, {0, 2}, {1, 2}, {3, 2}};
  EXPECT_EQ(find_begins_inside(shapes), expected);
}

// A cavity's triangles face into it: the space in it is outside of the solid.
TEST(BeginsInside, PassesOverCavities) {
  Mesh hollow = make_box({4.0, 4.0, 4.0}).mesh();
  const Mesh cavity = make_box({2.0, 2.0, 2.0}).mesh();
  const auto shift = static_cast<std::uint32_t>(hollow.vertices.size());
  hollow.vertices.insert(hollow.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  for (const auto& t : cavity.triangles) {
    hollow.triangles.push_back({t[1] + shift, t[0] + shift, t[2] + shift});
  }
  const Shape surface(hollow);
  const Shape ball = make_sphere(0.1);
  const Pose in_the_wall{.position = {1.5, 0.0, 0.0}, .rotation = Eigen::Quaterniond::Identity()};
  EXPECT_TRUE(find_begins_inside(std::vector<ShapeAtStart>{{&surface, {}}, {&ball, {}}}).empty());
  EXPECT_EQ(
      find_begins_inside(std::vector<ShapeAtStart>{{&surface, {}}, {&ball, in_the_wall}}).size(),
      1u);
}

}  // namespace
}  // namespace firstcontact
