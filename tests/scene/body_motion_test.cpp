#include <firstcontact/scene/body_motion.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include <firstcontact/scene/detail/thin_mass.h>

namespace firstcontact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Pose kFrom{{1, 2, 3}, Eigen::Quaterniond(2, 0, 0, 2)};  // Not of length 1.

void expect_pose(const Motion& motion, double t, const Vector3d& position, double turned_about_z) {
  const Pose pose = motion.pose(t);
  EXPECT_LT((pose.position - position).norm(), 1e-14) << t;
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(turned_about_z, Vector3d::UnitZ()));
  EXPECT_LT(pose.rotation.normalized().angularDistance(expected), 1e-7) << t;
}

constexpr double kQuarter = 0.5 * std::numbers::pi;

TEST(NormalisedMotion, RunsOverTheDurationWhereItHasNoTimes) {
  for (const double duration : {0.1, 1.0, 7.0}) {
    expect_pose(normalised_motion(FixedMotion{kFrom}, duration), 0.7, {1, 2, 3}, kQuarter);
    const Motion straight =
        normalised_motion(ConstantVelocityMotion{kFrom, {2, 0, -4}, {0, 0, 10}}, duration);
    expect_pose(straight, 0.25, {1.5, 2, 2}, kQuarter + 2.5);
    const Motion screw =
        normalised_motion(ScrewMotion{kFrom, {1, 0, 0}, {0, 0, 5}, kQuarter, 3.0}, duration);
    expect_pose(screw, 1.0, {-1, 0, 6}, 2.0 * kQuarter);
  }
}

// Both ways end at the second pose; between, the origin is on a line, or on the arc of the screw.
TEST(NormalisedMotion, GoesBetweenTwoPosesAsAsked) {
  const Pose to{{-1, 0, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(2 * kQuarter, Vector3d::UnitZ()))};
  const Motion straight =
      normalised_motion(TwoPoseMotion{kFrom, to, Between::constant_velocity}, 1.0);
  const Motion screw = normalised_motion(TwoPoseMotion{kFrom, to, Between::screw}, 1.0);
  for (const Motion& motion : {straight, screw}) {
    expect_pose(motion, 0.0, {1, 2, 3}, kQuarter);
    expect_pose(motion, 1.0, {-1, 0, 3}, 2 * kQuarter);
  }
  expect_pose(straight, 0.5, {0, 1, 3}, 1.5 * kQuarter);
  // A quarter turn that takes (1, 2) to (-1, 0) is about (1, 0).
  const double arc = std::sqrt(2.0);
  expect_pose(screw, 0.5, {1 - arc, arc, 3}, 1.5 * kQuarter);
}

TEST(NormalisedMotion, TakesWaypointsByTheirTimes) {
  const Pose far{{9, 2, 3}, kFrom.rotation};
  const WaypointMotion waypoints{{2, 4}, {kFrom, far}, Between::constant_velocity};
  const Motion motion = normalised_motion(waypoints, 8.0);
  expect_pose(motion, 0.0, {1, 2, 3}, kQuarter);
  expect_pose(motion, 0.25, {1, 2, 3}, kQuarter);
  expect_pose(motion, 0.375, {5, 2, 3}, kQuarter);
  expect_pose(motion, 1.0, {9, 2, 3}, kQuarter);
  EXPECT_THROW((void)normalised_motion(waypoints, 3.0), std::invalid_argument);
}

TEST(NormalisedMotion, LeavesTheFrameOfVerticesInTheWorld) {
  expect_pose(normalised_motion(VertexMotion{{{1, 2, 3}}}, 2.0), 1.0, {0, 0, 0}, 0.0);
}

TEST(SpansDuration, HoldsForMotionsWithoutTimes) {
  EXPECT_FALSE(spans_duration(FixedMotion{}));
  EXPECT_FALSE(spans_duration(WaypointMotion{{0.0}, {Pose{}}}));
  EXPECT_TRUE(spans_duration(ConstantVelocityMotion{}));
  EXPECT_TRUE(spans_duration(ScrewMotion{}));
  EXPECT_TRUE(spans_duration(TwoPoseMotion{}));
  EXPECT_TRUE(spans_duration(VertexMotion{}));
}

/// A rectangle of 3 by 2 in the plane z = 5, its centre at (10, 20, 5).
Mesh rectangle(const Vector3d& moved = Vector3d::Zero()) {
  Mesh mesh{{{8.5, 19, 5}, {11.5, 19, 5}, {11.5, 21, 5}, {8.5, 21, 5}}, {{0, 1, 2}, {0, 2, 3}}};
  for (Vector3d& vertex : mesh.vertices) {
    vertex += moved;
  }
  return mesh;
}

// Closed forms: a plate, a rod, points.
TEST(ThinMass, IsThatOfAPlate) {
  const detail::ThinMass plate = detail::thin_mass(rectangle());
  EXPECT_NEAR(plate.mass, 6.0, 1e-14);
  EXPECT_LT((plate.p_BC - Vector3d(10, 20, 5)).norm(), 1e-14);
  const Matrix3d expected = Vector3d(6 * 4 / 12.0, 6 * 9 / 12.0, 6 * 13 / 12.0).asDiagonal();
  EXPECT_LT((plate.about_C - expected).norm(), 1e-13);
}

TEST(ThinMass, IsTheSameFarFromTheOrigin) {
  const detail::ThinMass here = detail::thin_mass(rectangle());
  const detail::ThinMass there = detail::thin_mass(rectangle({1e6, -1e6, 2e6}));
  EXPECT_LT((there.about_C - here.about_C).norm(), 1e-8);
  EXPECT_LT((there.p_BC - here.p_BC - Vector3d(1e6, -1e6, 2e6)).norm(), 1e-8);
}

TEST(ThinMass, IsThatOfARodWhereThereAreNoTriangles) {
  // Twice the same edge is a rod of twice the mass; a triangle of three edges has none of it.
  const Mesh rod{{{0, 0, 1}, {0, 0, 4}}, {{0, 1, 1}, {1, 0, 0}}};
  const detail::ThinMass thin = detail::thin_mass(rod);
  EXPECT_NEAR(thin.mass, 6.0, 1e-15);
  EXPECT_LT((thin.p_BC - Vector3d(0, 0, 2.5)).norm(), 1e-15);
  const Matrix3d expected = Vector3d(6 * 9 / 12.0, 6 * 9 / 12.0, 0).asDiagonal();
  EXPECT_LT((thin.about_C - expected).norm(), 1e-14);
}

TEST(ThinMass, LeavesOutEdgesBesideTriangles) {
  Mesh mesh = rectangle();
  mesh.vertices.emplace_back(100, 100, 100);
  mesh.triangles.push_back({0, 4, 4});
  mesh.triangles.push_back({4, 4, 4});
  EXPECT_NEAR(detail::thin_mass(mesh).mass, 6.0, 1e-14);
  EXPECT_LT((detail::thin_mass(mesh).p_BC - Vector3d(10, 20, 5)).norm(), 1e-14);
}

TEST(ThinMass, IsOneForEachPoint) {
  const Mesh points{{{1, 0, 0}, {-1, 0, 0}, {0, 3, 0}}, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};
  const detail::ThinMass thin = detail::thin_mass(points);
  EXPECT_EQ(thin.mass, 3.0);
  EXPECT_LT((thin.p_BC - Vector3d(0, 1, 0)).norm(), 1e-15);
  const Matrix3d expected = Vector3d(6, 2, 8).asDiagonal();
  EXPECT_LT((thin.about_C - expected).norm(), 1e-14);
}

}  // namespace
}  // namespace firstcontact
