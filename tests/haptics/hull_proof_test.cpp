// Proofs by hulls agree with those by triangles.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/detail/hull_proof.h>

#include "support/random.h"

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Makes the mesh of a shape with some triangles left out, or with another mesh beside it.
Mesh mesh_of(const Shape& shape, std::size_t left_out, const Vector3d& beside) {
  Mesh mesh = shape.mesh();
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.resize(mesh.triangles.size() - left_out);
  if (!beside.isZero()) {
    for (const Vector3d& vertex : shape.mesh().vertices) {
      mesh.vertices.push_back(vertex + beside);
    }
    for (const auto& [a, b, c] : shape.mesh().triangles) {
      mesh.triangles.push_back({a + count, b + count, c + count});
    }
  }
  return mesh;
}

TEST(HullProof, TellsConvexShapes) {
  EXPECT_TRUE(is_convex(make_box({1.0, 2.0, 3.0}), 0.0));
  EXPECT_TRUE(is_convex(make_cylinder(0.02, 0.2), 0.0));
  EXPECT_TRUE(is_convex(make_cone(0.02, 0.2), 0.0));
  EXPECT_TRUE(is_convex(make_ellipsoid({0.02, 0.03, 0.05}, 1e-3), 1e-9));
  const Shape box = make_box({1.0, 2.0, 3.0});
  EXPECT_FALSE(is_convex(Shape(mesh_of(box, 1, Vector3d::Zero())), 0.0));         // Open.
  EXPECT_FALSE(is_convex(Shape(mesh_of(box, 0, Vector3d(5.0, 0.0, 0.0))), 0.0));  // Two boxes.
  EXPECT_FALSE(is_convex(Shape(mesh_of(box, 10, Vector3d::Zero())), 0.0));        // Flat.
}

TEST(HullProof, FindsTheFirstContactOfTheTriangles) {
  const Shape A = make_cylinder(0.02, 0.2, 2e-4).as_triangles();
  const Shape B = make_cone(0.03, 0.1, 2e-4).as_triangles();
  const FirstContactOptions options{
      .margin = 1e-4, .tolerance = 1e-5, .contacts = ContactState::none};
  Workspace workspace;
  test::Random random(3);
  int contacts = 0;
  for (int k = 0; k < 200; ++k) {
    const Pose from{0.2 * random.direction(), random.rotation()};
    const Motion still = Motion::fixed({Vector3d::Zero(), random.rotation()});
    const Motion moves = Motion::constant_velocity(
        from, -2.0 * from.position + 0.1 * random.direction(), 1.5 * random.direction());
    const FirstContactResult expected = first_contact({A, still}, {B, moves}, workspace, options);
    FirstContactResult found;
    first_contact_of_hulls({A, still}, {B, moves}, options, found);
    EXPECT_EQ(found.verdict, expected.verdict) << k;
    // Both end within the tolerance above the margin.
    const double slowest = 0.02;  // [m per step]
    EXPECT_NEAR(found.t, expected.t, options.tolerance / slowest) << k;
    contacts += found.verdict == Verdict::contact ? 1 : 0;
  }
  EXPECT_GT(contacts, 50);
}

TEST(HullProof, EndsWithItsBudget) {
  const Shape A = make_cylinder(0.02, 0.2);
  const Motion still = Motion::fixed();
  const Motion moves = Motion::constant_velocity({.position = {0.0, 0.0, 1.0}},
                                                 Vector3d(0.0, 0.0, -2.0), Vector3d(1, 2, 3));
  FirstContactOptions options;
  options.budget.steps = 1;
  FirstContactResult found;
  first_contact_of_hulls({A, still}, {A, moves}, options, found);
  EXPECT_EQ(found.verdict, Verdict::undecided);
  EXPECT_EQ(found.reason, UndecidedReason::work);
  EXPECT_LE(found.work.steps, 1U);
}

}  // namespace
}  // namespace firstcontact::detail
