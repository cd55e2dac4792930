// Hulls that come near: apart for no longer than the shapes are, and nearly as long; and answers
// that may be early, but for no more than was asked.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/detail/hull_approach.h>
#include <firstcontact/robot_check/detail/link_query.h>
#include <firstcontact/robot_check/link_pair_motion.h>

#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

/// Two shapes on their ways, asked as links are.
struct Pair {
  Shape A;
  Shape B;
  LinkMotion X_FA;
  LinkMotion X_FB;

  [[nodiscard]] FirstContactResult exact(const FirstContactOptions& options) const {
    Workspace workspace;
    return first_contact({A, X_FA}, {B, X_FB}, workspace, options);
  }

  [[nodiscard]] FirstContactResult early(double by, const FirstContactOptions& options,
                                         const TimeWindow& window = {}) const {
    const detail::HullCorners corners_A = detail::hull_corners(A);
    const detail::HullCorners corners_B = detail::hull_corners(B);
    detail::LinkWorkspace workspace;
    FirstContactResult result;
    detail::first_contact_early({A, X_FA}, {B, X_FB}, detail::hull_of(A, B, corners_A),
                                detail::hull_of(B, A, corners_B), window, by, workspace, options,
                                result);
    return result;
  }

  [[nodiscard]] double distance_at(double t) const {
    Workspace workspace;
    return distance({A, X_FA}, {B, X_FB}, t, workspace).distance;
  }

  [[nodiscard]] double apart_until(const TimeWindow& window, double threshold = 0.0) const {
    LinkScratch scratch;
    const auto ball = [](const Shape& shape, const LinkMotion& motion) {
      return LinkBall{motion, shape.hierarchy().centre, shape.hierarchy().radius * (1.0 + 1e-12)};
    };
    LinkPairMotion motion(ball(A, X_FA), ball(B, X_FB), scratch);
    const detail::HullCorners corners_A = detail::hull_corners(A);
    const detail::HullCorners corners_B = detail::hull_corners(B);
    return detail::follow_hulls(detail::hull_of(A, B, corners_A), detail::hull_of(B, A, corners_B),
                                motion, window, threshold, 1e-9, 0.0)
        .t;
  }
};

Motion straight_way(const Vector3d& from, const Vector3d& to) {
  const auto identity = Eigen::Quaterniond::Identity();
  return Motion::constant_velocity(Pose{from, identity}, Pose{to, identity});
}

/// A cube of 0.2 m on its way to another one at the origin.
Pair cubes(const Vector3d& from, const Vector3d& to) {
  const Shape cube = make_box({0.2, 0.2, 0.2});
  return {cube, cube, LinkMotion(straight_way(from, to)), LinkMotion(Motion::fixed())};
}

/// An angle piece, which no hull tells from a block.
Shape any_shape(Random& random) {
  switch (static_cast<int>(random.uniform(0.0, 4.0))) {
    case 0:
      return make_box(Vector3d(random.uniform(0.05, 0.4), random.uniform(0.05, 0.4), 0.1));
    case 1:
      return make_cylinder(random.uniform(0.05, 0.2), random.uniform(0.1, 0.5));
    case 2:
      return make_sphere(random.uniform(0.05, 0.2));
    default:
      return Shape({.vertices = {{0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3}, {0.3, 0.1, 0}},
                    .triangles = {{0, 1, 4}, {0, 2, 3}}},
                   random.chance(0.5) ? 0.01 : 0.0);
  }
}

Motion any_motion(Random& random) {
  const Vector3d from = random.vector(0.0, 0.8);
  const Vector3d way = random.vector(0.0, 1.5);
  const Vector3d turn = random.vector(0.0, 3.0);
  return Motion::constant_velocity(Pose{from, Eigen::Quaterniond::Identity()}, way, turn);
}

TEST(HullApproach, EndsWhereCubesMeetAndNotLater) {
  const Pair pair = cubes({-1.2, 0.05, 0.0}, {-0.2, 0.05, 0.0});
  EXPECT_LE(pair.apart_until({0.0, 1.0}), 1.0);
  EXPECT_GE(pair.apart_until({0.0, 1.0}), 1.0 - 1e-3);
  EXPECT_LE(pair.apart_until({0.0, 1.0}, 0.1), 0.9);
  EXPECT_GE(pair.apart_until({0.0, 1.0}, 0.1), 0.9 - 1e-3);
  EXPECT_LE(pair.apart_until({0.5, 1.0}, 0.1), 0.9);
  EXPECT_EQ(pair.apart_until({0.25, 0.75}), 0.75);
  EXPECT_EQ(pair.apart_until({0.5, 0.5}), 0.5);
}

TEST(HullApproach, StaysAtTheBeginOfAContact) {
  EXPECT_EQ(cubes({0.0, 0.1, 0.0}, {1.0, 0.1, 0.0}).apart_until({0.0, 1.0}), 0.0);
  EXPECT_EQ(cubes({0.0, 0.2, 0.0}, {1.0, 0.2, 0.0}).apart_until({0.0, 1.0}), 0.0);  // Touches.
}

// Sound: no contact is passed over, however shapes turn. Tight: none is told too early.
TEST(HullApproach, KeepsFirstContacts) {
  Random random(1);
  const FirstContactOptions options{.tolerance = 1e-9, .contacts = ContactState::none};
  int contacts = 0;
  int left_to_hulls = 0;
  for (int k = 0; k < rounds(800, 150); ++k) {
    const Pair pair{any_shape(random), any_shape(random), LinkMotion(any_motion(random)),
                    LinkMotion(any_motion(random))};
    const FirstContactResult exact = pair.exact(options);
    for (const double by : {0.0, 1e-3, 0.1, 1.0}) {
      const FirstContactResult early = pair.early(by, options);
      ASSERT_EQ(early.verdict == Verdict::free, exact.verdict == Verdict::free) << k;
      if (early.verdict == Verdict::contact_at_start) {
        EXPECT_EQ(early.t, 0.0);
        continue;
      }
      if (exact.verdict == Verdict::free) {
        EXPECT_EQ(early.t, 1.0);
        left_to_hulls += pair.apart_until({0.0, 1.0}, pair.A.radius() + pair.B.radius()) == 1.0;
        continue;
      }
      ++contacts;
      ASSERT_LE(early.t, *exact.t_upper + 1e-6) << k;
      ASSERT_GE(early.t, exact.t - by - 1e-6) << k;
      ASSERT_TRUE(early.t_upper.has_value()) << k;
      ASSERT_LE(*early.t_upper - early.t, by + 1e-15) << k;
      ASSERT_GE(*early.t_upper, exact.t - 1e-6) << k;
      for (const double share : {0.5, 0.9, 0.999, 1.0 - 1e-6}) {
        ASSERT_GT(pair.distance_at(share * early.t), 0.0) << k;
      }
    }
  }
  EXPECT_GT(contacts, rounds(800, 150) / 5);
  EXPECT_GT(left_to_hulls, rounds(800, 150) / 10);
}

// Nothing of a window is told before it or after it.
TEST(HullApproach, KeepsToItsWindow) {
  const Pair pair = cubes({-1.2, 0.0, 0.0}, {0.8, 0.0, 0.0});  // In contact from 0.5 on.
  const FirstContactOptions options{.tolerance = 1e-9, .contacts = ContactState::none};
  EXPECT_EQ(pair.early(1e-3, options, {0.0, 0.49}).verdict, Verdict::free);
  EXPECT_EQ(pair.early(1e-3, options, {0.0, 0.49}).t, 0.49);
  const FirstContactResult late = pair.early(1e-3, options, {0.25, 0.5001});
  EXPECT_EQ(late.verdict, Verdict::contact);
  EXPECT_NEAR(late.t, 0.5, 1.1e-3);
  EXPECT_LE(late.t, 0.5 + 1e-12);
  EXPECT_LE(*late.t_upper, 0.5001);
  EXPECT_EQ(pair.early(1e-3, options, {0.6, 1.0}).t, 0.6);
  EXPECT_EQ(pair.early(1e-3, options, {0.75, 1.0}).verdict, Verdict::free);
}

}  // namespace
}  // namespace firstcontact::test
