// Proofs by hulls agree with those by triangles.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/hull_proof.h>
#include <firstcontact/query/distance.h>

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

TEST(HullProof, FindsShapesThatFillTheirHulls) {
  EXPECT_TRUE(fills_its_hull(make_box({1.0, 2.0, 3.0}), 0.0));
  EXPECT_TRUE(fills_its_hull(make_cylinder(0.02, 0.2), 0.0));
  EXPECT_TRUE(fills_its_hull(make_cone(0.02, 0.2), 0.0));
  EXPECT_TRUE(fills_its_hull(make_ellipsoid({0.02, 0.03, 0.05}, 1e-3), 1e-9));
  const Shape box = make_box({1.0, 2.0, 3.0});
  EXPECT_FALSE(fills_its_hull(Shape(mesh_of(box, 1, Vector3d::Zero())), 0.0));         // Open.
  EXPECT_FALSE(fills_its_hull(Shape(mesh_of(box, 0, Vector3d(5.0, 0.0, 0.0))), 0.0));  // Two boxes.
  EXPECT_FALSE(fills_its_hull(Shape(mesh_of(box, 10, Vector3d::Zero())), 0.0));        // Flat.
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

// The reason for hulls: crossed slivers of two cylinders cost a proof by triangles this much.
TEST(HullProof, TakesFewStepsWhereThinTrianglesCross) {
  const Shape bar = make_cylinder(0.02, 0.2).as_triangles();
  const Shape tool = make_cylinder(0.02, 0.08).as_triangles();
  const double right_angle = 0.5 * std::numbers::pi;
  const Motion still =
      Motion::fixed({Vector3d(0.0, 0.0, -0.02),
                     Eigen::Quaterniond(Eigen::AngleAxisd(right_angle, Vector3d::UnitY()))});
  Pose near{Vector3d(0.0, 0.0, 0.03),
            Eigen::AngleAxisd(0.15, Vector3d(0.3, 0.2, 0.3).normalized()) *
                Eigen::Quaterniond(Eigen::AngleAxisd(right_angle, Vector3d::UnitX()))};
  Workspace workspace;
  for (int k = 0; k < 20; ++k) {  // Down to 3 contact distances.
    near.position.z() -=
        distance({bar, still}, {tool, Motion::fixed(near)}, 0.0, workspace).distance - 3e-5;
  }
  const Motion lifts =
      Motion::constant_velocity(near, Vector3d(0.0, 0.0, 1e-3), Vector3d(0.0, 0.0, 1e-3));
  const FirstContactOptions options{
      .margin = 1e-5, .tolerance = 1e-6, .contacts = ContactState::none};
  const FirstContactResult by_triangles =
      first_contact({bar, still}, {tool, lifts}, workspace, options);
  FirstContactResult found;
  first_contact_of_hulls({bar, still}, {tool, lifts}, options, found);
  EXPECT_EQ(by_triangles.verdict, Verdict::free);
  EXPECT_EQ(found.verdict, Verdict::free);
  EXPECT_EQ(found.t, 1.0);
  EXPECT_LT(found.work.steps, 100U);
  EXPECT_GT(by_triangles.work.node_groups + by_triangles.work.steps, kProofSteps);
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
