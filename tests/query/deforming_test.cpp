// Meshes whose vertices move on lines: laws, closed forms, and everything that a rigid body can be
// asked.

#include <firstcontact/geometry/deforming_body.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/query/closest_approach.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/query/first_contact.h>

#include "query/sheet.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using test::sheet;

Mesh flat_sheet(int n) {
  return sheet(n, [](double, double) { return 0.0; });
}

Points moved(const Mesh& mesh, const Vector3d& by) {
  Points to = mesh.vertices;
  for (Vector3d& v : to) {
    v += by;
  }
  return to;
}

const Mesh kTriangle{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};

FirstContactResult ask(const DeformingBody& A, const DeformingBody& B,
                       const FirstContactOptions& options = {}) {
  Workspace workspace;
  return first_contact({A.shape, A.X_WS}, {B.shape, B.X_WS}, workspace, options);
}

DeformingBody rigid(const Shape& shape, const Motion& motion) { return {shape, motion}; }

// A corner is pulled up to a plate 1 m above: it is there after a half of its 2 m.
TEST(Deforming, FirstContactIsWhereTheVertexComes) {
  const DeformingBody tip =
      move_vertices(Shape(kTriangle), Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 2}});
  const Shape plate(sheet(6, [](double, double) { return 1.0; }));
  const FirstContactResult result = ask(tip, rigid(plate, Motion::fixed()));
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_LE(result.t, 0.5);
  EXPECT_NEAR(result.t, 0.5, 1e-6);
  ASSERT_FALSE(result.contacts.empty());
  const Contact& contact = result.contacts.front();
  EXPECT_EQ(contact.feature_A, (Feature{FeatureType::vertex, 2, 0}));
  EXPECT_NEAR((contact.p_WA - Vector3d(0, 1, 1)).norm(), 0.0, 1e-5);
  ASSERT_TRUE(contact.n_AB_W.has_value());
  EXPECT_NEAR(contact.n_AB_W->z(), 1.0, 1e-9);
  EXPECT_NEAR(contact.normal_velocity, -2.0, 1e-9);
}

// The velocity of a point of a face lies between those of its corners.
TEST(Deforming, ContactOfAFaceHasTheVelocityOfItsPoint) {
  const DeformingBody face =
      move_vertices(Shape(kTriangle), Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 4}});
  const Shape ball = make_sphere(0.25);
  const Motion rest = Motion::fixed({.position = {0.25, 0.25, 0.75}});
  const FirstContactResult result = ask(face, rigid(ball, rest));
  ASSERT_EQ(result.verdict, Verdict::contact);
  ASSERT_FALSE(result.contacts.empty());
  const Contact& contact = result.contacts.front();
  ASSERT_TRUE(contact.n_AB_W.has_value());
  // Velocity along the normal of the point at height z = 4 t y.
  const double velocity = 4.0 * contact.p_WA.y() * contact.n_AB_W->z();
  EXPECT_NEAR(contact.normal_velocity, -velocity, 1e-9);
}

TEST(Deforming, ContactAtTheVeryEndIsOne) {
  const Shape floor(flat_sheet(4));
  const Mesh above = sheet(3, [](double, double) { return 1.0; });
  const DeformingBody landing = move_vertices(Shape(above), moved(above, {0, 0, -1}));
  EXPECT_EQ(ask(landing, rigid(floor, Motion::fixed())).verdict, Verdict::contact);
  const DeformingBody hovering = move_vertices(Shape(above), moved(above, {0, 0, -1.0 + 0x1p-18}));
  EXPECT_EQ(ask(hovering, rigid(floor, Motion::fixed())).verdict, Verdict::free);
}

// A law: vertices that stay are a body at rest, vertices that share a velocity one that translates.
TEST(Deforming, WithoutDeformationIsRigid) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto random_vector = [&] { return Vector3d(uniform(rng), uniform(rng), uniform(rng)); };
  const Mesh waves = sheet(12, [](double x, double y) { return 0.2 * std::sin(3.0 * x + y); });
  const Shape A(waves);
  const Shape B(sheet(9, [](double x, double y) { return 0.2 * std::cos(2.0 * x - y); }));
  int contacts = 0;
  for (int i = 0; i < 60; ++i) {
    const Vector3d translation = i % 2 == 0 ? Vector3d::Zero() : Vector3d(2.0 * random_vector());
    const DeformingBody deforming = move_vertices(A, moved(waves, translation));
    const Motion course = Motion::constant_velocity({.position = {0.0, 0.0, 2.0}},
                                                    2.0 * random_vector(), random_vector());
    const FirstContactResult as_rigid =
        ask(rigid(A, Motion::constant_velocity(Pose{}, translation)), rigid(B, course));
    const FirstContactResult answer = ask(deforming, rigid(B, course));
    ASSERT_EQ(answer.verdict, as_rigid.verdict) << i;
    EXPECT_NEAR(answer.t, as_rigid.t, 1e-4) << i;
    Workspace workspace;
    for (const double t : {0.0, 0.3, 1.0}) {
      const double distance_rigid =
          distance({A, Motion::constant_velocity(Pose{}, translation)}, {B, course}, t, workspace)
              .distance;
      const DistanceResult found =
          distance({deforming.shape, deforming.X_WS}, {B, course}, t, workspace);
      EXPECT_NEAR(found.distance, distance_rigid, 1e-12) << i;
      EXPECT_LE(found.lower_bound, found.distance);
    }
    contacts += answer.verdict == Verdict::contact ? 1 : 0;
  }
  EXPECT_GT(contacts, 5);
}

/// A thousand vertices of cloth that wraps over a ball.
DeformingBody wrapping_cloth() {
  const Mesh cloth = sheet(32, [](double, double) { return 1.2; });
  Points to = cloth.vertices;
  for (Vector3d& v : to) {
    v.z() = 0.9 - 0.8 * v.head<2>().squaredNorm();
  }
  return move_vertices(Shape(cloth, 0.01), to);
}

/// [m]  Of the vertices and the ball, at t; the faces are nearer.
double cloth_distance(const DeformingBody& cloth, const Vector3d& ball, double t) {
  double least = std::numeric_limits<double>::infinity();
  const Mesh& mesh = cloth.shape.mesh();
  for (const Vector3d& v : mesh.vertices) {
    const double z_to = 0.9 - 0.8 * v.head<2>().squaredNorm();
    const Vector3d now(v.x(), v.y(), (1.0 - t) * v.z() + t * z_to);
    least = std::min(least, (now - ball).norm());
  }
  return least - 0.01;
}

TEST(Deforming, ClothMeetsAMovingBall) {
  const DeformingBody cloth = wrapping_cloth();
  const Shape ball = make_sphere(0.9);
  for (const double speed : {0.0, 0.2, -0.3}) {
    const Motion course = Motion::constant_velocity(Pose{}, {speed, 0, 0}, {0.5, 0, 1.0});
    FirstContactOptions options;
    options.margin = 0.02;
    const FirstContactResult result = ask(cloth, rigid(ball, course), options);
    ASSERT_EQ(result.verdict, Verdict::contact);
    for (int k = 0; k <= 50; ++k) {
      const double t = result.t * k / 50.0;
      EXPECT_GE(cloth_distance(cloth, {speed * t, 0, 0}, t), 0.9 + 0.02 - 1e-12);
    }
    Workspace workspace;
    const DistanceResult at_contact =
        distance({cloth.shape, cloth.X_WS}, {ball, course}, result.t, workspace);
    EXPECT_NEAR(at_contact.distance, 0.02, 1.1e-6);
    EXPECT_LE(result.work.node_groups + result.work.steps, 20'000u);
  }
}

TEST(Deforming, ClosestApproachIsBelowASample) {
  const DeformingBody cloth = wrapping_cloth();
  const Shape ball = make_sphere(0.5);
  const Motion course = Motion::constant_velocity({.position = {0.0, -2.0, -1.5}}, {0.0, 4.0, 0.5});
  Workspace workspace;
  const MovingShape A{cloth.shape, cloth.X_WS};
  const MovingShape B{ball, course};
  const ClosestApproachResult closest = closest_approach(A, B, workspace);
  EXPECT_EQ(closest.reason, UndecidedReason::none);
  EXPECT_LE(closest.distance - closest.lower_bound, 1e-6 * (1.0 + 1e-9));
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= 200; ++k) {
    least = std::min(least, distance(A, B, k / 200.0, workspace).distance);
  }
  EXPECT_LE(closest.lower_bound, least);
  EXPECT_GE(closest.distance, closest.lower_bound);
  EXPECT_NEAR(closest.distance, least, 1e-3);
}

// A corner slides over a face that tilts under it, at a tenth of the margin above the margin.
TEST(Deforming, SlidingOverATurningFaceDoesNotStall) {
  const DeformingBody face = move_vertices(
      Shape(Mesh{.vertices = {{-3, -3, 0}, {3, -3, 0}, {0, 3, 0}}, .triangles = {{0, 1, 2}}}),
      Points{{-3, -3, -3}, {3, -3, 3}, {0, 3, 0}});
  const double height = 1e-5;
  const DeformingBody tip =
      move_vertices(Shape(Mesh{.vertices = {{0.5, 0, height}, {0.5, 0, 1}, {0.6, 0, 1}},
                               .triangles = {{0, 1, 2}}}),
                    Points{{0.5, 0.5, 0.5 + height}, {0.5, 0.5, 2}, {0.6, 0.5, 2}});
  const FirstContactResult result = ask(face, tip);
  EXPECT_EQ(result.verdict, Verdict::free);
  EXPECT_LE(result.work.steps, 5'000u);
}

// A sheet that starts in the band is held to half its start distance: bending away goes on, bending
// up ends before it touches.
TEST(Deforming, KeepsHalfOfItsStartDistance) {
  const Mesh mesh = flat_sheet(2);
  const auto bent = [&](double height) {
    Points to = mesh.vertices;
    for (Vector3d& v : to) {
      v.z() += height * v.squaredNorm() / 8.0;
    }
    return move_vertices(Shape(mesh), to);
  };
  const double start = 4e-7;
  const Shape plate(sheet(2, [&](double, double) { return start; }));
  const DeformingBody rest = rigid(plate, Motion::fixed());
  FirstContactOptions options;
  EXPECT_EQ(ask(bent(1e-6), rest, options).verdict, Verdict::contact_at_start);
  options.start_contacts = StartContacts::keep_half;
  EXPECT_EQ(ask(bent(-0.1), rest, options).verdict, Verdict::free);
  const FirstContactResult pressed = ask(bent(1e-6), rest, options);
  ASSERT_EQ(pressed.verdict, Verdict::contact);
  const double left = start - 1e-6 * pressed.t;
  EXPECT_GE(left, 0.5 * start);
  EXPECT_LE(left, 0.75 * start);
}

// A solid follows its moving surface; the surface may grow over a body only by touching it.
TEST(Deforming, SolidsContainAndGrow) {
  const Shape box = make_box({1, 1, 1});
  Points larger = box.mesh().vertices;
  for (Vector3d& v : larger) {
    v *= 3.0;
  }
  const DeformingBody growing = move_vertices(box, larger);
  const Shape ball = make_sphere(0.1);
  const auto at = [](double x) { return Motion::fixed({.position = {x, 0, 0}}); };
  EXPECT_EQ(ask(growing, rigid(ball, at(0.1))).verdict, Verdict::contact_at_start);
  const FirstContactResult met = ask(growing, rigid(ball, at(1.1)));
  ASSERT_EQ(met.verdict, Verdict::contact);
  EXPECT_NEAR(met.t, 0.5, 1e-6);  // Its face is at 0.5 + t.
  EXPECT_EQ(ask(growing, rigid(ball, at(1.7))).verdict, Verdict::free);
  Workspace workspace;
  const auto distance_at = [&](double x, double t) {
    return distance({growing.shape, growing.X_WS}, {ball, at(x)}, t, workspace).distance;
  };
  EXPECT_NEAR(distance_at(1.1, 0.0), 0.5, 1e-9);
  EXPECT_NEAR(distance_at(1.1, 0.25), 0.25, 1e-9);
  EXPECT_EQ(distance_at(1.1, 1.0), 0.0);  // Inside.
}

// A shape may also deform as its moving frame sees it.
TEST(Deforming, GoesOnInAFrameThatTurns) {
  const Shape tip(kTriangle);
  const Shape stretched = tip.deforming(Points{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}});
  // A quarter turn about z takes the corner, at 1 + 2 t, into a wall at y = 1.5.
  const Motion turn = Motion::constant_velocity(Pose{}, {0, 0, 0}, {0, 0, 0.5 * 3.14159265358979});
  const Shape wall(
      Mesh{.vertices = {{-9, 1.5, -9}, {9, 1.5, -9}, {0, 1.5, 9}}, .triangles = {{0, 1, 2}}});
  const FirstContactResult result = ask(rigid(stretched, turn), rigid(wall, Motion::fixed()));
  ASSERT_EQ(result.verdict, Verdict::contact);
  const double y = (1.0 + 2.0 * result.t) * std::sin(0.5 * 3.14159265358979 * result.t);
  EXPECT_LE(y, 1.5);
  EXPECT_NEAR(y, 1.5, 1.1e-6);
}

// Many deforming bodies: the earliest pair, whatever the number of threads.
TEST(Deforming, ManyBodiesAnswerAsTheirPairs) {
  std::mt19937_64 rng(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto random_vector = [&] { return Vector3d(uniform(rng), uniform(rng), uniform(rng)); };
  BodySet bodies;
  for (int k = 0; k < 40; ++k) {
    Mesh mesh = flat_sheet(4);
    const Vector3d at = 8.0 * random_vector();
    const Vector3d travel = 4.0 * random_vector();
    Points to;
    for (Vector3d& v : mesh.vertices) {
      v = 0.4 * v + at;
      to.push_back(v + travel + 0.3 * random_vector());
    }
    if (k % 3 == 0) {
      bodies.add(Shape(mesh), Motion::constant_velocity(Pose{}, travel, 0.1 * random_vector()));
    } else {
      DeformingBody body = move_vertices(Shape(mesh), to);
      bodies.add(body.shape, body.X_WS);
    }
  }
  ManyBodiesWorkspace workspace;
  ManyBodiesOptions options;
  options.pair.start_contacts = StartContacts::keep_half;
  double earliest = 1.0;
  for (const PairAnswer& pair : answer_each_pair(bodies, workspace, options)) {
    if (pair.verdict != Verdict::free) {
      earliest = std::min(earliest, pair.t);
    }
  }
  ASSERT_LT(earliest, 1.0);
  ASSERT_GT(earliest, 0.0);
  const SceneResult one = [&] {
    options.threads = 1;
    return first_contact(bodies, workspace, options);
  }();
  EXPECT_NEAR(one.t, earliest, 1e-6);
  for (const int threads : {2, 8}) {
    options.threads = threads;
    EXPECT_EQ(first_contact(bodies, workspace, options).t, one.t);
  }
}

// Bounds of boxes come from places at both ends only: vertices are in them at all times.
TEST(Deforming, BoxesHoldTheirTrianglesAtAllTimes) {
  const DeformingBody cloth = wrapping_cloth();
  const Hierarchy& hierarchy = cloth.shape.hierarchy();
  for (const double t : {0.0, 0.1, 0.5, 0.999, 1.0}) {
    for (std::uint32_t index = 0; index < hierarchy.nodes.size(); ++index) {
      HierarchyNode scratch;
      const HierarchyNode& node = hierarchy.node(index, t, scratch);
      for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
        if ((node.used() >> slot & 1u) == 0 || !node.is_leaf(slot)) {
          continue;
        }
        const Eigen::Matrix3d axes = box_axes(node, slot);
        const Vector3d centre(node.centre[0][slot], node.centre[1][slot], node.centre[2][slot]);
        Vector3d reach = Vector3d::Zero();
        for (const std::uint32_t v : hierarchy.triangles[node.child_triangle(slot)]) {
          const Vector3d q = axes * (hierarchy.vertex(v, t) / hierarchy.unit - centre);
          for (int k = 0; k < 3; ++k) {
            ASSERT_LE(std::abs(q[k]), static_cast<double>(node.half_extent(k, slot)));
            reach[k] = std::max(reach[k], std::abs(q[k]));
          }
        }
        // Tight at both ends: centres are floats, extents have ten bits.
        for (int k = 0; k < 3 && (t == 0.0 || t == 1.0); ++k) {
          ASSERT_LE(static_cast<double>(node.half_extent(k, slot)), 1.002 * reach[k] + 1e-6);
        }
      }
    }
  }
}

TEST(Deforming, RefusesWhatItCannotMove) {
  const Shape shape(kTriangle);
  EXPECT_THROW((void)move_vertices(shape, Points(2, Vector3d::Zero())), std::invalid_argument);
  EXPECT_THROW((void)move_vertices(shape, Points(4, Vector3d::Zero())), std::invalid_argument);
  Points bad(3, Vector3d::Zero());
  bad[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)move_vertices(shape, bad), std::invalid_argument);
  const Shape cylinder = make_cylinder(1.0, 1.0);
  EXPECT_THROW((void)move_vertices(cylinder, cylinder.mesh().vertices), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
