// Curved shapes as what they are: pairs of convex sets, and sets against triangles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <firstcontact/geometry/convex_hull.h>
#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/motion/constant_rate_pair.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/shape_pair.h>

#include "support/random.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

Pose curved_pose(const Vector3d& position,
                 const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity()) {
  return {.position = position, .rotation = rotation};
}

Motion falls(const Vector3d& from, const Vector3d& by,
             const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity()) {
  return Motion::constant_velocity(curved_pose(from, rotation), by);
}

/// A floor of two triangles per cell at z = 0, of n cells along each side of 4 m.
Shape floor_of(int n) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int k = 0; k <= n; ++k) {
      mesh.vertices.emplace_back(4.0 * i / n - 2.0, 4.0 * k / n - 2.0, 0.0);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const auto a = static_cast<std::uint32_t>(i * (n + 1) + k);
      const auto b = a + static_cast<std::uint32_t>(n) + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return Shape(mesh);
}

/// A cylinder on its side, about the y axis.
const Eigen::Quaterniond kLying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()));

/// Both ways round.
FirstContactResult ask_curved(const MovingShape& A, const MovingShape& B,
                              const FirstContactOptions& options = {}) {
  Workspace workspace;
  const FirstContactResult result = first_contact(A, B, workspace, options);
  const FirstContactResult swapped = first_contact(B, A, workspace, options);
  EXPECT_EQ(result.verdict, swapped.verdict);
  EXPECT_EQ(result.t, swapped.t);
  EXPECT_EQ(result.contacts.size(), swapped.contacts.size());
  return result;
}

TEST(CurvedShapes, ACylinderOnItsSideLandsExactly) {
  const Shape cylinder = make_cylinder(0.25, 1.0, 0.01);
  const Motion fall = falls({0.1, 0.2, 1.25}, {0.0, 0.0, -2.0}, kLying);
  const Motion rest = Motion::fixed();
  for (const int cells : {1, 9}) {
    const Shape floor = floor_of(cells);
    const FirstContactResult result =
        ask_curved({floor, rest}, {cylinder, fall}, {.tolerance = 1e-9});
    ASSERT_EQ(result.verdict, Verdict::contact);
    EXPECT_EQ(result.enclosure_error, 0.0);
    EXPECT_LE(result.t, 0.5);
    EXPECT_GE(result.t, 0.5 - 1e-9);
    ASSERT_FALSE(result.contacts.empty());
    for (const Contact& contact : result.contacts) {
      ASSERT_TRUE(contact.n_AB_W);
      EXPECT_NEAR(contact.n_AB_W->z(), 1.0, 1e-9);
      EXPECT_NEAR(contact.p_WB.z(), contact.distance, 1e-12);
      EXPECT_NEAR(contact.p_WB.x(), 0.1, 1e-4);
      EXPECT_NEAR(contact.normal_velocity, -2.0, 1e-9);
      EXPECT_LE(contact.distance, 1e-9);
    }
  }
}

TEST(CurvedShapes, ConesAndEllipsoidsLandOnBoxesExactly) {
  const Shape box = make_box({4.0, 4.0, 1.0});
  const Motion rest = Motion::fixed();
  const Motion down =
      Motion::constant_velocity(curved_pose({0.2, 0.1, 2.0}, kLying * kLying), {0.0, 0.0, -2.0});
  const FirstContactResult cone = ask_curved({box, rest}, {make_cone(0.5, 1.0), down});
  ASSERT_EQ(cone.verdict, Verdict::contact);
  EXPECT_NEAR(cone.t, 0.5, 1e-6) << "its tip comes first";
  ASSERT_EQ(cone.contacts.size(), 1u);
  EXPECT_NEAR(cone.contacts[0].p_WA.x(), 0.2, 1e-9);
  EXPECT_NEAR(cone.contacts[0].p_WA.z(), 0.5, 1e-6);
  EXPECT_EQ(cone.contacts[0].feature_A.type, FeatureType::face);

  const Shape egg = make_ellipsoid({0.3, 0.2, 0.5}, 0.05);
  const FirstContactResult fallen =
      ask_curved({box, rest}, {egg, falls({0.0, 0.0, 2.0}, {0.0, 0.0, -2.0})}, {.tolerance = 1e-9});
  ASSERT_EQ(fallen.verdict, Verdict::contact);
  EXPECT_LE(fallen.t, 0.5);
  EXPECT_NEAR(fallen.t, 0.5, 1e-9);
  EXPECT_EQ(fallen.enclosure_error, 0.0);
  EXPECT_NEAR(fallen.contacts.at(0).n_AB_W->z(), 1.0, 1e-9);
}

// Its prism would be in contact: exact is more than never late.
TEST(CurvedShapes, ACylinderPassesWhereItsPrismWouldNot) {
  const Shape cylinder = make_cylinder(0.5, 1.0, 0.05);
  const Shape post = make_cylinder(0.5, 1.0, 0.05);
  const Motion rest = Motion::fixed();
  const Motion pass = Motion::constant_velocity(curved_pose({-3.0, 1.0 + 1e-4, 0.0}),
                                                {6.0, 0.0, 0.0}, {0.0, 0.0, 40.0});
  EXPECT_EQ(ask_curved({post, rest}, {cylinder, pass}).verdict, Verdict::free);
  const Shape prism = cylinder.as_triangles();
  const FirstContactResult by_triangles = ask_curved({prism, rest}, {prism, pass});
  EXPECT_EQ(by_triangles.verdict, Verdict::contact);
  EXPECT_GT(by_triangles.enclosure_error, 0.0);
}

TEST(CurvedShapes, IsNoLaterThanTheDistanceAndNoEarlierThanItsPrism) {
  test::Random random(11);
  const Shape knot = floor_of(5);
  int contacts = 0;
  Workspace workspace;
  for (int round = 0; round < 60; ++round) {
    const Shape curved = round % 3 == 0   ? make_cylinder(0.3, 0.8, 0.01)
                         : round % 3 == 1 ? make_cone(0.3, 0.8, 0.01)
                                          : make_ellipsoid({0.4, 0.2, 0.1}, 0.02);
    const Vector3d from = random.vector(1.0, 1.5) + Vector3d(0.0, 0.0, 1.0);
    const Motion X =
        Motion::constant_velocity(curved_pose(from, random.rotation()),
                                  random.vector(0.5, 2.0) - from, random.vector(0.0, 20.0));
    const Motion rest = Motion::fixed();
    const FirstContactResult exact = ask_curved({knot, rest}, {curved, X});
    const Shape outer = curved.as_triangles();
    const FirstContactResult prism = ask_curved({knot, rest}, {outer, X});
    ASSERT_LE(prism.t, exact.t + 1e-5) << round;
    if (exact.verdict == Verdict::contact) {
      ++contacts;
      const DistanceResult there = distance({knot, rest}, {curved, X}, exact.t, workspace);
      ASSERT_LE(there.distance, 1e-6) << round;
      ASSERT_GE(there.distance, there.lower_bound);
      ASSERT_FALSE(exact.contacts.empty());
    }
    for (int k = 0; k < 20 && exact.t > 0.0; ++k) {
      const double t = exact.t * k / 20.0;
      ASSERT_GT(distance({knot, rest}, {curved, X}, t, workspace).distance, 0.0) << round;
    }
  }
  EXPECT_GT(contacts, 20);
}

// Half a unit in the last place of a late time is a way, too: 1 um of it here.
TEST(LateContact, AtTheLastInstantIsFound) {
  Workspace workspace;
  const double rest_until = 1.0 - 0x1p-20;
  const std::vector<double> times{0.0, rest_until, 1.0};
  const std::vector<Pose> poses{curved_pose({3.0, 0.0, 0.0}), curved_pose({3.0, 0.0, 0.0}),
                                curved_pose({1.5, 0.0, 0.0})};
  const Motion late = Motion::waypoints(times, poses);
  const Shape ball = make_sphere(0.5);
  for (const Shape& shape : {make_ellipsoid({1.0, 0.5, 0.5}), make_box({2.0, 1.0, 1.0})}) {
    const FirstContactResult found =
        first_contact({shape, Motion::fixed()}, {ball, late}, workspace, {});
    EXPECT_EQ(found.verdict, Verdict::contact);
    EXPECT_GT(found.t, rest_until);
  }
}

TEST(CurvedShapes, HaveTheirDistance) {
  Workspace workspace;
  const Motion rest = Motion::fixed();
  const Shape ball = make_sphere(0.5);
  const Shape egg = make_ellipsoid({1.0, 0.5, 0.25});
  const Motion beside = Motion::fixed(curved_pose({3.0, 0.0, 0.0}));
  const DistanceResult found = distance({egg, rest}, {ball, beside}, 0.0, workspace);
  EXPECT_NEAR(found.distance, 1.5, 1e-12);
  EXPECT_LE(found.lower_bound, 1.5);
  // Proven is the distance of the triangles around the two.
  EXPECT_GE(found.lower_bound, 1.5 - egg.enclosure_error() - 1e-9);
  EXPECT_EQ(found.enclosure_error, 0.0);
  ASSERT_TRUE(found.closest);
  EXPECT_NEAR(found.closest->p_WA.x(), 1.0, 1e-6);
  EXPECT_NEAR(found.closest->p_WB.x(), 2.5, 1e-6);
  // Two equal, crossed cylinders: the distance of their axes less both radii.
  const Shape rod = make_cylinder(0.1, 4.0);
  const Motion crossed = Motion::fixed(curved_pose({0.3, 0.0, 0.2}, kLying));
  EXPECT_NEAR(distance({rod, rest}, {rod, crossed}, 0.0, workspace).distance, 0.1, 1e-9);
}

TEST(CurvedShapes, HaveTheirClosestApproach) {
  Workspace workspace;
  const Motion rest = Motion::fixed();
  const Shape egg = make_ellipsoid({1.0, 0.5, 0.25});
  const Shape rod = make_cylinder(0.1, 1.0);
  const Motion pass = falls({-4.0, 0.0, 2.0}, {8.0, 0.0, 0.0}, kLying);
  const ClosestApproachResult found = closest_approach({egg, rest}, {rod, pass}, workspace);
  EXPECT_NEAR(found.distance, 2.0 - 0.25 - 0.1, 1e-6);
  EXPECT_GE(found.lower_bound, found.distance - 1.1e-6);
  EXPECT_LE(found.lower_bound, 1.65 + 1e-9);
  EXPECT_EQ(found.enclosure_error, 0.0);
}

TEST(CurvedShapes, ContainAndAreContained) {
  const Motion rest = Motion::fixed();
  const Shape tank = make_cylinder(2.0, 4.0);
  const Shape speck = Shape(Mesh{.vertices = {{0.3, 0.2, 0.1}}, .triangles = {{0, 0, 0}}});
  EXPECT_EQ(ask_curved({tank, rest}, {speck, rest}).verdict, Verdict::contact_at_start);
  EXPECT_EQ(ask_curved({tank, rest}, {make_box({1, 1, 1}), rest}).verdict,
            Verdict::contact_at_start);
  const Shape cube = make_box({8.0, 8.0, 8.0});
  EXPECT_EQ(ask_curved({cube, rest}, {tank, rest}).verdict, Verdict::contact_at_start);
  // A solid of triangles alone, and the same as a surface.
  const Shape solid(cube.mesh(), 0.0, Filling::solid);
  const FirstContactResult inside = ask_curved({solid, rest}, {tank, rest});
  EXPECT_EQ(inside.verdict, Verdict::contact_at_start);
  ASSERT_EQ(inside.contacts.size(), 1u);
  EXPECT_EQ(inside.contacts[0].distance, 0.0);
  const Shape surface(cube.mesh(), 0.0, Filling::surface);
  EXPECT_EQ(ask_curved({surface, rest}, {tank, rest}).verdict, Verdict::free);
}

TEST(CurvedShapes, KeepHalfOfTheirStartDistance) {
  const Shape floor = floor_of(4);
  const Shape cylinder = make_cylinder(0.25, 1.0);
  const double gap = 1e-7;
  const Motion rest = Motion::fixed();
  const Motion rolls = Motion::constant_velocity(curved_pose({-1.0, 0.0, 0.25 + gap}, kLying),
                                                 {1.0, 0.0, 0.0}, {0.0, 4.0, 0.0});
  const Shape slab = make_box({4.0, 4.0, 0.2});
  const Motion below = Motion::fixed(curved_pose({0.0, 0.0, -0.1}));
  const FirstContactOptions options{.start_contacts = StartContacts::keep_half};
  EXPECT_EQ(ask_curved({floor, rest}, {cylinder, rolls}).verdict, Verdict::contact_at_start);
  for (const FirstContactResult& rolled : {ask_curved({floor, rest}, {cylinder, rolls}, options),
                                           ask_curved({slab, below}, {cylinder, rolls}, options)}) {
    EXPECT_EQ(rolled.verdict, Verdict::free);
    EXPECT_NEAR(rolled.clearance, 0.5 * gap, 0.01 * gap);
  }
}

TEST(CurvedShapes, ListTheContactsThatAreAsked) {
  const Shape floor = floor_of(8);
  const Shape cylinder = make_cylinder(0.25, 2.0);
  const Motion rest = Motion::fixed();
  const Motion fall = falls({0.1, 0.2, 1.25}, {0.0, 0.0, -2.0}, kLying);
  const auto contacts = [&](ContactState state) {
    return ask_curved({floor, rest}, {cylinder, fall}, {.contacts = state}).contacts.size();
  };
  EXPECT_EQ(contacts(ContactState::none), 0u);
  EXPECT_EQ(contacts(ContactState::first), 1u);
  EXPECT_GT(contacts(ContactState::all), 3u) << "several triangles lie under it";
  EXPECT_EQ(contacts(ContactState::nearest(2)), 2u);
}

/// The face of the prism over the contact point.
TEST(CurvedShapes, NameTheFaceOfTheTrianglesAroundThem) {
  test::Random random(12);
  const Motion rest = Motion::fixed();
  Workspace workspace;
  for (const Shape& shape : {make_cylinder(0.4, 1.0, 0.01), make_cone(0.4, 1.0, 0.01),
                             make_ellipsoid({0.5, 0.4, 0.3}, 0.02)}) {
    for (int round = 0; round < 60; ++round) {
      const Vector3d place = random.vector(1.5, 2.0);
      const Motion beside = Motion::fixed(curved_pose(place));
      const DistanceResult found =
          distance({shape, rest}, {make_sphere(0.1), beside}, 0.0, workspace);
      ASSERT_TRUE(found.closest);
      const Feature& face = found.closest->feature_A;
      ASSERT_EQ(face.type, FeatureType::face);
      ASSERT_LT(face.index, shape.mesh().triangles.size());
      const auto& t = shape.mesh().triangles[face.index];
      const Vector3d a = shape.mesh().vertices[t[0]];
      const Vector3d normal =
          (shape.mesh().vertices[t[1]] - a).cross(shape.mesh().vertices[t[2]] - a).normalized();
      // Near the plane of that face.
      ASSERT_NEAR(normal.dot(found.closest->p_WA - a), 0.0, 2.5 * shape.enclosure_error())
          << round << " face " << face.index;
    }
  }
}

/// Crossed rods: the exact distance is that of two lines less both radii.
TEST(CurvedShapes, HaveALowerBoundThatNeverExceedsTheirDistance) {
  test::Random random(9);
  Workspace workspace;
  const Shape rod = make_cylinder(0.01, 2.0);
  const Motion rest = Motion::fixed();
  int overlaps = 0;
  for (int round = 0; round < 60; ++round) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(
        random.uniform(0.3, 2.8), random.direction().cross(Vector3d::UnitZ()).normalized()));
    const Vector3d place = random.vector(0.0, 0.03);
    const Vector3d across = Vector3d::UnitZ().cross(turn * Vector3d::UnitZ()).normalized();
    const double exact = std::abs(across.dot(place)) - 0.02;
    const DistanceResult found =
        distance({rod, rest}, {rod, Motion::fixed(curved_pose(place, turn))}, 0.0, workspace);
    EXPECT_LE(found.lower_bound, std::max(0.0, exact) + 1e-16) << round;
    EXPECT_GE(found.lower_bound, exact - 2.0 * rod.enclosure_error() - 1e-12) << round;
    EXPECT_NEAR(found.distance, std::max(0.0, exact), 1e-10) << round;
    if (exact < -1e-9) {
      ++overlaps;
      EXPECT_EQ(found.distance, 0.0) << round;
      EXPECT_FALSE(found.closest->n_AB_W) << round;
    }
  }
  EXPECT_GT(overlaps, 10);
}

/// The line of centres of two rods side by side separates nothing.
TEST(CurvedShapes, AreApartInAWindowOfNoLength) {
  const Shape rod = make_cylinder(0.1, 4.0);
  for (const double t : {0.0, 0.5, 1.0}) {
    const Motion rest = Motion::fixed();
    const Motion beside = Motion::fixed(curved_pose({0.3, 0.0, 3.0}));
    const Vector3d centre = rod.hierarchy().centre;
    ConstantRatePair motion(rest, beside, centre, centre, 1e-6);
    Workspace workspace;
    FirstContactResult found;
    first_contact(ShapePair{rod, rod, motion}, TimeWindow{t, t}, workspace, {}, found);
    EXPECT_FALSE(is_contact(found.verdict)) << t;
  }
}

TEST(CurvedShapes, AgainstDeformingOnesAreAskedByTheirTriangles) {
  const Shape flag = floor_of(1).deforming(std::vector<Vector3d>(4, Vector3d(0.0, 0.0, 5.0)));
  const Shape cylinder = make_cylinder(0.25, 1.0);
  Workspace workspace;
  const FirstContactResult result = first_contact(
      {flag, Motion::fixed()}, {cylinder, Motion::fixed(curved_pose({0.0, 0.0, 3.0}))}, workspace);
  EXPECT_EQ(result.verdict, Verdict::contact);
  EXPECT_EQ(result.enclosure_error, cylinder.enclosure_error());
}

}  // namespace
}  // namespace firstcontact
