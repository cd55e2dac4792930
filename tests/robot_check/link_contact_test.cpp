// First contact of links: never late, never false, against closed forms, the query of rigid
// motions, dense samples and the oracle's places.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/narrowphase/triangle_distance.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/robot_check/link_contact.h>
#include <firstcontact/robot_files/read_urdf.h>

#include "robot/chain_case.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;
using oracle::Wide;

constexpr std::array<double, 2> kTimes = {0.0, 1.0};

CoordinatePath ramp(double from, double to) {
  const std::array<double, 2> q = {from, to};
  return CoordinatePath::linear(kTimes, q);
}

/// base - arm: one hinge about z.
RobotMotion hinge(const CoordinatePath& angle) {
  Joint joint{.name = "j", .type = JointType::continuous, .parent = "base", .child = "arm"};
  joint.axis = Vector3d::UnitZ();
  return RobotMotion(
      RobotModel({.name = "r", .links = {{"base", {}, {}}, {"arm", {}, {}}}, .joints = {joint}}),
      {{"j", angle}});
}

FirstContactResult contact_of(const MovingLink& A, const MovingLink& B,
                              const FirstContactOptions& options = {}) {
  Workspace workspace;
  return first_contact(A, B, workspace, options);
}

/// A needle along x from 0 to 1, and a ball on the circle of its tip.
TEST(LinkContact, FindsANeedleInClosedForm) {
  const Shape needle(Mesh{.vertices = {{0, 0, 0}, {1, 0, 0}}, .triangles = {{0, 1, 1}}});
  const Shape ball = make_sphere(0.01);
  const double at = 1.25;  // [rad]
  const LinkMotion obstacle(Motion::fixed(
      {0.5 * Vector3d(std::cos(at), std::sin(at), 0.0), Eigen::Quaterniond::Identity()}));
  // Touches where the distance of the centre from the needle, 0.5 sin(at - q), is the radius.
  const double touch = at - std::asin(0.01 / 0.5);
  for (const double turns : {0.0, 1.0, 40.0}) {
    const double way = 2.0 + 2.0 * std::numbers::pi * turns;
    const RobotMotion robot = hinge(ramp(0.0, way));
    const LinkMotion arm = robot.link(1);
    const FirstContactResult result = contact_of({needle, arm}, {ball, obstacle});
    ASSERT_EQ(result.verdict, Verdict::contact);
    EXPECT_LE(result.t, touch / way);
    EXPECT_GE(result.t, (touch - 4e-6) / way);
    ASSERT_FALSE(result.contacts.empty());
    EXPECT_LE(result.contacts.front().distance, 1e-6);
    // From the other end it touches after the rest of the turn.
    const RobotMotion back = hinge(ramp(0.0, -way));
    const LinkMotion back_arm = back.link(1);
    const FirstContactResult reverse = contact_of({ball, obstacle}, {needle, back_arm});
    const double other = (2.0 * std::numbers::pi - at) - std::asin(0.01 / 0.5);
    if (other < way) {
      ASSERT_EQ(reverse.verdict, Verdict::contact);
      EXPECT_LE(reverse.t, other / way);
      EXPECT_GE(reverse.t, (other - 4e-6) / way);
    } else {
      EXPECT_EQ(reverse.verdict, Verdict::free);
      EXPECT_EQ(reverse.t, 1.0);
    }
  }
}

/// A soup of small triangles, four at least.
Mesh random_mesh(Random& random, double size, int triangles = 4) {
  Mesh mesh;
  const double edge = triangles > 4 ? 0.2 * size : size;
  for (int i = 0; i < triangles; ++i) {
    const Vector3d centre = (size - edge) * random.direction();
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(centre + edge * random.vector(0.3, 1.0));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// The query for motions of constant rates is tested against an oracle of its own. Asked for a
/// margin a little less, its contact is one: ours must not come later.
TEST(LinkContact, AgreesWithTheQueryOfRigidMotions) {
  Workspace workspace;
  int contacts = 0;
  constexpr double kMargin = 0.01;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const int triangles = seed % 2 == 0 ? 4 : 60;
    const Shape A(random_mesh(random, 0.3, triangles));
    const Shape B(random_mesh(random, 0.3, triangles));
    const auto motion = [&] {
      const Vector3d start = random.direction();
      return Motion::constant_velocity({start, random.rotation()}, -start + random.vector(0.0, 0.8),
                                       random.vector(0.0, 6.0));
    };
    const Motion X_WA = motion();
    const Motion X_WB = motion();
    const LinkMotion link_A(X_WA);
    const LinkMotion link_B(X_WB);
    const FirstContactResult ours = contact_of({A, link_A}, {B, link_B}, {.margin = kMargin});
    FirstContactOptions options;
    options.margin = kMargin - 1e-8;
    options.tolerance = 1e-9;
    const FirstContactResult theirs = first_contact({A, X_WA}, {B, X_WB}, workspace, options);
    ASSERT_NE(ours.verdict, Verdict::undecided) << seed;
    if (theirs.verdict != Verdict::free) {
      ++contacts;
      ASSERT_NE(ours.verdict, Verdict::free) << seed;
      ASSERT_LE(ours.t, theirs.t) << seed;
    }
    if (ours.verdict != Verdict::free) {
      ASSERT_LE(distance({A, X_WA}, {B, X_WB}, ours.t, workspace).distance,
                kMargin + ours.tolerance_used + 1e-13)
          << seed;
    }
    const FirstContactResult swapped = contact_of({B, link_B}, {A, link_A}, {.margin = kMargin});
    EXPECT_EQ(swapped.verdict, ours.verdict) << seed;
    EXPECT_EQ(swapped.t, ours.t) << seed;
    ASSERT_EQ(swapped.contacts.size(), ours.contacts.size()) << seed;
    for (std::size_t k = 0; k < ours.contacts.size(); ++k) {
      EXPECT_EQ(swapped.contacts[k].feature_B, ours.contacts[k].feature_A) << seed;
      EXPECT_EQ(swapped.contacts[k].p_WB, ours.contacts[k].p_WA) << seed;
    }
  }
  EXPECT_GE(contacts, 50);
  EXPECT_LE(contacts, 250);
}

double mesh_distance(const Mesh& A, const LinkPose& a, const Mesh& B, const LinkPose& b) {
  const auto placed = [](const Mesh& mesh, const LinkPose& pose, std::size_t triangle) {
    Triangle T;
    for (std::size_t k = 0; k < 3; ++k) {
      T[k] = pose.p_OL + pose.R_FL * mesh.vertices[mesh.triangles[triangle][k]];
    }
    return T;
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < A.triangles.size(); ++i) {
    for (std::size_t j = 0; j < B.triangles.size(); ++j) {
      least = std::min(least, triangle_distance(placed(A, a, i), placed(B, b, j)).distance);
    }
  }
  return least;
}

/// The distance where the oracle puts the chain.
double exact_distance(const ChainCase& c, double t, const Mesh& A, const Mesh& B,
                      const Vector3d& p_WB) {
  Mesh placed = A;
  for (Vector3d& v : placed.vertices) {
    const auto p = oracle::exact_place(c.exact(t), Wide(t), exact_point(v));
    v = {p.x.nearest(), p.y.nearest(), p.z.nearest()};
  }
  LinkPose at_B;
  at_B.p_OL = p_WB;
  return mesh_distance(placed, {}, B, at_B);
}

/// Chains of all joints against a body in the world: no sample before t is in contact, none at all
/// if the answer is free; at t the oracle's places are within the tolerance.
TEST(LinkContact, ChainsAreNeverLateAndNeverFalse) {
  int contacts = 0;
  constexpr double kMargin = 0.01;
  constexpr int kSamples = rounds(500, 50);
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const ChainCase c = random_chain(seed, {.joints = 1 + static_cast<int>(seed % 12)});
    const LinkMotion tip = c.motion.link(c.motion.model().links().size() - 1);
    Random random(seed);
    const Shape A(random_mesh(random, 0.15));
    const Shape B(random_mesh(random, 0.15));
    const double near_t = random.uniform(0.3, 1.0);
    const Vector3d p_WB = tip.at(near_t).pose(near_t).p_OL + random.vector(0.0, 0.5);
    const LinkMotion body(Motion::fixed({p_WB, Eigen::Quaterniond::Identity()}));
    const FirstContactResult result = contact_of({A, tip}, {B, body}, {.margin = kMargin});
    ASSERT_NE(result.verdict, Verdict::undecided) << seed;
    const bool free = result.verdict == Verdict::free;
    LinkPose at_B;
    at_B.p_OL = p_WB;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = static_cast<double>(i) / kSamples;
      if (free || t < result.t) {
        ASSERT_GT(mesh_distance(A.mesh(), tip.at(t).pose(t), B.mesh(), at_B), kMargin - 1e-12)
            << seed << " at " << t;
      }
    }
    if (!free) {
      ++contacts;
      ASSERT_LE(exact_distance(c, result.t, A.mesh(), B.mesh(), p_WB),
                kMargin + result.tolerance_used + 1e-13)
          << seed;
    }
  }
  EXPECT_GE(contacts, 30);
  EXPECT_LE(contacts, 110);
}

/// Free at both ends, but the way between the two configurations runs through a post.
TEST(LinkContact, TheWayOfThePumaRunsThroughAThinPost) {
  const RobotModel puma = read_urdf(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                                    "data/robots/puma560_description/urdf/puma560_robot.urdf");
  std::map<std::string, JointMotion> joints;
  for (const Joint& joint : puma.joints()) {
    joints.emplace(joint.name, ramp(0.0, joint.name == "j1" ? 1.5 : 0.2));
  }
  const RobotMotion motion(puma, joints);
  const std::size_t hand = puma.links().size() - 2;
  const LinkGeometry& geometry = puma.links()[hand].collision.at(0);
  const LinkMotion link = motion.link(hand).then(precise(geometry.X_LG));
  const Shape& shape = geometry.shape.value();
  // A post through the place of the hand in the middle.
  const LinkPose middle = link.at(0.5).pose(0.5);
  const Vector3d centre = middle.p_OL + middle.R_FL * shape.hierarchy().centre;
  const Shape post = make_box({0.002, 0.002, 1.0});
  const Motion at_centre = Motion::fixed({centre, Eigen::Quaterniond::Identity()});
  const LinkMotion post_motion(at_centre);
  const FirstContactResult result = contact_of({shape, link}, {post, post_motion});
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_GT(result.t, 0.1);
  EXPECT_LT(result.t, 0.5);
  Workspace workspace;
  const auto distance_at = [&](double t) {
    const LinkPose pose = link.at(t).pose(t);
    const Motion X_WL = Motion::fixed({pose.p_OL, Eigen::Quaterniond(pose.R_FL)});
    return distance({shape, X_WL}, {post, at_centre}, 0.0, workspace).distance;
  };
  for (int i = 0; i < 100; ++i) {
    EXPECT_GT(distance_at(result.t * i / 100.0), 0.0);
  }
  EXPECT_LE(distance_at(result.t), 1e-6 + 1e-12);
  EXPECT_GT(distance_at(1.0), 0.0);
}

TEST(LinkContact, LinksOfOneRobotAreSeenFromTheirCommonAncestor) {
  // Two fingers on a palm that whirls a thousand times as fast, far away.
  Joint left{.name = "left", .type = JointType::prismatic, .parent = "palm", .child = "l"};
  Joint right{.name = "right", .type = JointType::prismatic, .parent = "palm", .child = "r"};
  right.mimic = Mimic{.joint = "left", .multiplier = -1.0, .offset = 0.0};
  const RobotModel model({.name = "hand",
                          .links = {{"palm", {}, {}}, {"l", {}, {}}, {"r", {}, {}}},
                          .joints = {left, right}});
  const RobotMotion motion(model, {{"left", ramp(-1.0, 0.0)}},
                           Motion::constant_velocity({{1e6, 0, 0}, Eigen::Quaterniond(1, 2, 3, 4)},
                                                     {1e3, 0, 0}, {100, 200, 300}));
  const RelativeLinkMotion relative = motion.relative(1, 2);
  const Shape box = make_box({0.5, 0.5, 0.5});
  const FirstContactResult result = contact_of({box, relative.A}, {box, relative.B});
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_EQ(result.tolerance_used, 1e-6);
  EXPECT_LE(result.t, 0.75);
  EXPECT_GE(result.t, 0.75 - 1e-6);
}

TEST(LinkContact, StartsInContactOrInside) {
  const Shape box = make_box({1, 1, 1});
  const Shape small = make_box({0.1, 0.1, 0.1});
  const RobotMotion robot = hinge(ramp(0.0, 1.0));
  const LinkMotion arm = robot.link(1);
  const LinkMotion inside(Motion::fixed({{0.2, 0, 0}, Eigen::Quaterniond::Identity()}));
  const FirstContactResult result = contact_of({box, arm}, {small, inside});
  EXPECT_EQ(result.verdict, Verdict::contact_at_start);
  EXPECT_EQ(result.t, 0.0);
  const LinkMotion touching(Motion::fixed({{1.0, 0, 0}, Eigen::Quaterniond::Identity()}));
  EXPECT_EQ(contact_of({box, arm}, {box, touching}).verdict, Verdict::contact_at_start);
}

TEST(LinkContact, SpendsNoMoreThanItsBudget) {
  const ChainCase c = random_chain(3, {.joints = 7});
  const LinkMotion tip = c.motion.link(7);
  Random random(1);
  const Shape A(random_mesh(random, 0.15));
  const LinkPose end = tip.at(1.0).pose(1.0);
  const LinkMotion body(Motion::fixed({end.p_OL, Eigen::Quaterniond::Identity()}));
  const FirstContactResult all = contact_of({A, tip}, {A, body});
  FirstContactOptions few;
  few.budget.steps = 20;
  const FirstContactResult some = contact_of({A, tip}, {A, body}, few);
  EXPECT_EQ(some.verdict, Verdict::undecided);
  EXPECT_EQ(some.reason, UndecidedReason::work);
  EXPECT_LE(some.t, all.t);
  EXPECT_THROW((void)contact_of({A, tip}, {A, body}, {.margin = -1.0}), std::invalid_argument);
  EXPECT_THROW((void)contact_of({A, tip}, {A, body}, {.tolerance = 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
