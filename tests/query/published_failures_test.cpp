// Published failures of continuous collision detection elsewhere, each as a promise here.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/query/first_contact.h>

#include "support/first_contact_oracle.h"
#include "support/library_case.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using oracle::GeneratedCase;
using oracle::MotionInput;
using oracle::MotionKind;
using oracle::MovingSoup;
using oracle::PoseInput;
using oracle::Quaternion;
using oracle::Truth;
using oracle::TruthKind;

constexpr double kPi = std::numbers::pi;

MovingSoup box(const Vector3d& center, const Vector3d& half) {
  MovingSoup soup;
  for (int k = 0; k < 8; ++k) {
    soup.vertices.push_back({center.x() + (k & 1 ? half.x() : -half.x()),
                             center.y() + (k & 2 ? half.y() : -half.y()),
                             center.z() + (k & 4 ? half.z() : -half.z())});
  }
  soup.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return soup;
}

MovingSoup quad(const std::array<oracle::Vector3<double>, 4>& corners) {
  MovingSoup soup;
  soup.vertices.assign(corners.begin(), corners.end());
  soup.triangles = {{0, 1, 2}, {0, 2, 3}};
  return soup;
}

void append(MovingSoup& soup, const MovingSoup& more) {
  const std::size_t n = soup.vertices.size();
  soup.vertices.insert(soup.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& t : more.triangles) {
    soup.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
}

MotionInput velocity(const PoseInput& start, const oracle::Vector3<double>& translation,
                     const oracle::Vector3<double>& spin = {}) {
  MotionInput m;
  m.kind = MotionKind::constant_velocity;
  m.poses = {start};
  m.translation = translation;
  m.rotation_vector = spin;
  return m;
}

Quaternion about_z(double angle) {
  return {std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
}

/// Holds the library to the oracle's answer, which it returns for the test to look at.
Truth expect_truth(const GeneratedCase& c) {
  const Truth truth = oracle::FirstContactOracle(c.A, c.B, c.margin).first_contact();
  EXPECT_NE(truth.kind, TruthKind::gave_up);
  Workspace workspace;
  EXPECT_EQ(complaint(c, ask_library(c, workspace), truth), "");
  return truth;
}

void expect_contact_at(const GeneratedCase& c, double t) {
  const Truth truth = expect_truth(c);
  ASSERT_EQ(truth.kind, TruthKind::contact);
  EXPECT_NEAR(truth.hi, t, 1e-14);
}

/// Two boxes on a line towards each other.
GeneratedCase head_on(double tolerance) {
  GeneratedCase c{box({0.0, 0.0, 4.0}, {1.0, 1.0, 1.0}), box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), 0.0,
                  tolerance};
  c.A.motion = velocity({}, {0.0, 0.0, -2.0});
  c.B.motion = velocity({}, {0.0, 0.0, 3.0});
  return c;
}

// flexible-collision-library/fcl#120: conservative advancement of meshes gave wrong answers for two
// boxes in translation, whatever the bounding volume.
TEST(PublishedFailures, Fcl120BoxesInTranslation) {
  for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
    GeneratedCase c{box({0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}), box({0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}),
                    0.0, tolerance};
    c.B.motion = velocity({{5.0, 0.25, 0.125}, {}}, {-10.0, 0.0, 0.0});
    expect_contact_at(c, 0.4);
    c.B.motion = velocity({{5.0, 1.25, 0.125}, {}}, {-10.0, 0.0, 0.0});
    EXPECT_EQ(expect_truth(c).kind, TruthKind::free);
  }
}

// flexible-collision-library/fcl#555 (and python-fcl#38): both boxes move towards each other;
// bounds of opposite sign cancelled, and the hit was missed.
TEST(PublishedFailures, Fcl555BoxesTowardsEachOther) { expect_contact_at(head_on(1e-6), 0.4); }

// flexible-collision-library/fcl#581: no contact information at the time of contact.
TEST(PublishedFailures, Fcl581ContactStateComesAlong) {
  const GeneratedCase c = head_on(1e-6);
  const Shape A = to_shape(c.A);
  const Shape B = to_shape(c.B);
  Workspace workspace;
  const FirstContactResult result =
      first_contact({A, to_motion(c.A.motion)}, {B, to_motion(c.B.motion)}, workspace, {});
  ASSERT_EQ(result.verdict, Verdict::contact);
  ASSERT_FALSE(result.contacts.empty());
  for (const Contact& contact : result.contacts) {
    EXPECT_LE(contact.distance, 1e-6);
    EXPECT_NEAR((contact.p_WB - contact.p_WA).norm(), contact.distance, 1e-12);
    EXPECT_NEAR(contact.p_WA.z(), 2.2, 2e-6);
    ASSERT_TRUE(contact.n_AB_W.has_value());
    EXPECT_NEAR(contact.n_AB_W->z(), -1.0, 1e-6);
    EXPECT_NEAR(contact.normal_velocity, -5.0, 1e-5);
  }
}

// flexible-collision-library/fcl#637: a crash, with input on which the discrete test works; a mesh
// against a cylinder. Here with doubled and degenerate triangles on top.
TEST(PublishedFailures, Fcl637MeshAgainstCylinder) {
  MovingSoup cylinder;
  constexpr std::size_t kSides = 12;
  for (std::size_t i = 0; i < kSides; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / kSides;
    cylinder.vertices.push_back({0.3 * std::cos(angle), 0.3 * std::sin(angle), -0.5});
    cylinder.vertices.push_back({0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.5});
  }
  for (std::size_t i = 0; i < kSides; ++i) {
    const std::size_t j = (i + 1) % kSides;
    cylinder.triangles.push_back({2 * i, 2 * j, 2 * i + 1});
    cylinder.triangles.push_back({2 * i + 1, 2 * j, 2 * j + 1});
    cylinder.triangles.push_back({0, 2 * i, 2 * j});  // Two of them degenerate.
  }
  MovingSoup mesh = box({0.0, 0.0, 0.0}, {0.5, 0.5, 0.5});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 2}, {3, 3, 3}, {4, 5, 4}});
  for (const double spin : {0.0, 1.0, 30.0}) {
    GeneratedCase c{mesh, cylinder, 0.0, 1e-6};
    c.B.motion = velocity({{2.0, 0.1, 0.2}, {0.9, 0.1, 0.2, 0.3}}, {-3.0, 0.0, 0.0},
                          {0.3 * spin, spin, 0.1 * spin});
    EXPECT_EQ(expect_truth(c).kind, TruthKind::contact);
    // Nested and at rest, in contact from the start on.
    c.B.motion = velocity({{0.5, 0.0, 0.0}, {}}, {0.0, 0.0, 0.0}, {0.0, spin, 0.0});
    EXPECT_EQ(expect_truth(c).hi, 0.0);
  }
}

// flexible-collision-library/fcl#117: the result still said "colliding" from an earlier call.
TEST(PublishedFailures, Fcl117ResultsAreNotCarriedOver) {
  const GeneratedCase hit = head_on(1e-6);
  const Shape A = to_shape(hit.A);
  const Shape B = to_shape(hit.B);
  const Motion X_WA = to_motion(hit.A.motion);
  const Motion towards = to_motion(hit.B.motion);
  const Motion away = Motion::constant_velocity({}, {0.0, 0.0, -3.0});
  Workspace workspace;
  FirstContactResult reused;
  first_contact({A, X_WA}, {B, towards}, workspace, {}, reused);
  ASSERT_EQ(reused.verdict, Verdict::contact);
  first_contact({A, X_WA}, {B, away}, workspace, {}, reused);
  EXPECT_EQ(reused.verdict, Verdict::free);
  EXPECT_EQ(reused.t, 1.0);
  EXPECT_FALSE(reused.t_upper.has_value());
  EXPECT_TRUE(reused.contacts.empty());
}

// erincatto/box2d#115: a false positive, and an endless loop where the angles were not normalised.
TEST(PublishedFailures, Box2d115FalsePositiveAndManyTurns) {
  GeneratedCase c{box({0.0, 0.0, 0.0}, {25.0, 5.0, 1.0}), box({0.0, 0.0, 0.0}, {2.5, 2.5, 1.0}),
                  0.0, 1e-6};
  c.A.motion.poses = {{{24.0, -60.0, 0.0}, about_z(2.95)}};
  const double from = 513.36676 - 162.0 * kPi;
  const double to = 513.62781 - 162.0 * kPi;
  const oracle::Vector3<double> start{53.474274, -50.252514, 0.0};
  const oracle::Vector3<double> end{54.595478, -51.083473, 0.0};
  c.B.motion = velocity({start, about_z(from)}, end - start, {0.0, 0.0, to - from});
  EXPECT_EQ(expect_truth(c).kind, TruthKind::free);
  c.B.motion = velocity({start, {}}, end - start, {0.0, 0.0, 513.62781});
  expect_truth(c);
}

// Jolt turns a body first and casts it along a line then (its documentation says so): a bar that
// is across a post only midway of its turn passes unnoticed.
TEST(PublishedFailures, JoltRotationBeforeTranslation) {
  GeneratedCase c{box({0.0, 0.6, 0.0}, {0.05, 0.05, 1.0}), box({0.0, 0.0, 0.0}, {1.0, 0.05, 0.05}),
                  0.0, 1e-6};
  // Lies along x at both ends of the step, and along y in between, where it passes the post.
  c.B.motion = velocity({{-0.5, 0.0, 0.0}, {}}, {1.0, 0.0, 0.0}, {0.0, 0.0, kPi});
  const Truth truth = expect_truth(c);
  ASSERT_EQ(truth.kind, TruthKind::contact);
  EXPECT_GT(truth.lo, 0.1);
  EXPECT_LT(truth.hi, 0.5);
  c.B.motion = velocity({{-0.5, 0.0, 0.0}, {}}, {1.0, 0.0, 0.0});
  EXPECT_EQ(expect_truth(c).kind, TruthKind::free);
}

// moveit/moveit#2889: the hull of the first and the last pose covers little of what an arm sweeps
// that swings by 180 degrees past a thin post.
TEST(PublishedFailures, MoveIt2889HalfTurnPastAThinPost) {
  constexpr double kHalfWidth = 1e-3;
  GeneratedCase c{box({0.0, 0.9, 0.0}, {kHalfWidth, kHalfWidth, 1.0}), {}, 0.0, 1e-7};
  c.B = quad({{{0.0, 0.0, -0.05}, {1.0, 0.0, -0.05}, {1.0, 0.0, 0.05}, {0.0, 0.0, 0.05}}});
  c.B.motion = velocity({}, {}, {0.0, 0.0, kPi});
  // The arm first meets the post's edge that is nearest to the x axis and to the swing's center.
  expect_contact_at(c, std::atan2(0.9 - kHalfWidth, kHalfWidth) / kPi);
  c.B = quad({{{0.0, 0.0, -0.05}, {0.8, 0.0, -0.05}, {0.8, 0.0, 0.05}, {0.0, 0.0, 0.05}}});
  c.B.motion = velocity({}, {}, {0.0, 0.0, kPi});
  EXPECT_EQ(expect_truth(c).kind, TruthKind::free);
  // The same swing from pose to pose: the half turn about z is the documented choice.
  c.B.motion.kind = MotionKind::constant_velocity_between;
  c.B.motion.poses = {{{}, {}}, {{}, {0.0, 0.0, 0.0, 1.0}}};
  c.A.vertices = box({0.0, 0.7, 0.0}, {kHalfWidth, kHalfWidth, 1.0}).vertices;
  expect_contact_at(c, std::atan2(0.7 - kHalfWidth, kHalfWidth) / kPi);
}

// NVIDIA-Omniverse/PhysX#505: a sphere grazes the edge of one surface, and the wall of the same
// mesh behind it no longer stops it.
TEST(PublishedFailures, PhysXOmni505AGrazedTriangleHidesTheWall) {
  const auto mesh_with_surface_at = [](double y) {
    MovingSoup mesh = quad({{{-5.0, y, -1.0}, {0.0, y, -1.0}, {0.0, y, 1.0}, {-5.0, y, 1.0}}});
    append(mesh, quad({{{1.0, -2.0, -1.0}, {1.0, 2.0, -1.0}, {1.0, 2.0, 1.0}, {1.0, -2.0, 1.0}}}));
    return mesh;
  };
  MovingSoup sphere;
  sphere.vertices = {{0.0, 0.0, 0.0}};
  sphere.triangles = {{0, 0, 0}};
  sphere.radius = 0.25;
  sphere.motion = velocity({{-0.78131, 0.3092001, 0.0}, {}}, {4.0, -0.3, 0.0});
  // With the edge out of reach by a little, the wall stops the sphere.
  for (const bool reversed : {false, true}) {
    GeneratedCase c{mesh_with_surface_at(-0.001), sphere, 0.0, 1e-6};
    if (reversed) {
      std::swap(c.A.triangles[0], c.A.triangles[3]);
    }
    expect_contact_at(c, (0.75 + 0.78131) / 4.0);
    // Where it grazes the edge, that is the first contact.
    c.A.vertices = mesh_with_surface_at(0.0).vertices;
    const Truth truth = expect_truth(c);
    ASSERT_EQ(truth.kind, TruthKind::contact);
    EXPECT_LT(truth.hi, 0.25);
    // With the surface touching, a second step from the grazing time on still finds the wall.
    const Shape mesh = oracle::to_shape(c.A);
    const Shape ball = oracle::to_shape(c.B);
    Workspace workspace;
    FirstContactOptions options;
    options.start_contacts = StartContacts::keep_half;
    const auto& p = c.B.motion.poses[0].position;
    const Vector3d at_contact(p.x + 4.0 * truth.lo, p.y - 0.3 * truth.lo, 0.0);
    const FirstContactResult next = first_contact(
        {mesh, Motion::fixed()},
        {ball, Motion::constant_velocity({.position = at_contact + Vector3d(0.0, 1e-9, 0.0)},
                                         {4.0, 0.0, 0.0})},
        workspace, options);
    EXPECT_NE(next.verdict, Verdict::free);
    EXPECT_LE(next.t, (0.75 - at_contact.x()) / 4.0);
  }
}

}  // namespace
}  // namespace firstcontact
