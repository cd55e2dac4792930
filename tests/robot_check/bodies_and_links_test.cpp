// Laws: the same bodies, asked as a set of bodies and as links of robots, answer the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/robot_check/check_robots.h>

#include "robot/planar_arm.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStone = 0.1;  // [m]
constexpr std::size_t kStones = 3;

/// A bar that turns about one of its ends, among balls that fly through its plane.
struct TurningBar {
  double from = 0.0;  // [rad]
  double to = 0.0;    // [rad]
  std::array<Vector2d, kStones> places;
  std::array<Vector2d, kStones> ways;

  explicit TurningBar(std::uint64_t seed) {
    Random random(seed);
    from = random.uniform(-3.0, 3.0);
    to = from + random.uniform(-15.0, 15.0);
    for (std::size_t k = 0; k < kStones; ++k) {
      places[k] = {random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)};
      ways[k] = {random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)};
    }
  }

  [[nodiscard]] Motion ball_motion(std::size_t k) const {
    return Motion::constant_velocity({.position = {places[k].x(), places[k].y(), 0.0}},
                                     Vector3d(ways[k].x(), ways[k].y(), 0.0));
  }

  /// The bar is the body 0, ball k the body k + 1.
  [[nodiscard]] BodySet bodies() const {
    BodySet set;
    const Pose start{.position = Vector3d::Zero(),
                     .rotation = Quaterniond(Eigen::AngleAxisd(from, Vector3d::UnitZ()))};
    set.add(bar(), Motion::constant_velocity(start, Vector3d::Zero(), Vector3d(0, 0, to - from)));
    for (std::size_t k = 0; k < kStones; ++k) {
      set.add(make_sphere(kStone), ball_motion(k));
    }
    return set;
  }

  /// The base is the member 0, the bar the member 1, ball k the member k + 2.
  [[nodiscard]] RobotScene links() const {
    RobotScene scene;
    scene.add_robot("arm", planar_motion({ramp(from, to)}));
    for (std::size_t k = 0; k < kStones; ++k) {
      scene.add_body("ball" + std::to_string(k), make_sphere(kStone), ball_motion(k));
    }
    return scene;
  }

  /// [m]  Of two bodies, in closed form.
  [[nodiscard]] double gap(const BodyPair& pair, double t) const {
    const auto ball = [&](std::size_t body) {
      return Vector2d(places[body - 1] + t * ways[body - 1]);
    };
    const double angle = from + t * (to - from);
    return pair[0] == 0 ? segment_distance(ball(pair[1]), Vector2d::Zero(),
                                           {std::cos(angle), std::sin(angle)}) -
                              kBarRadius - kStone
                        : (ball(pair[0]) - ball(pair[1])).norm() - 2.0 * kStone;
  }
};

bool holds(const std::vector<ContactInterval>& intervals, double t) {
  return std::any_of(intervals.begin(), intervals.end(), [t](const ContactInterval& interval) {
    return interval.enter <= t && t <= interval.leave;
  });
}

TEST(BodiesAndLinks, HaveTheSameContactsInTime) {
  std::size_t of_bodies = 0;
  std::size_t of_links = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const TurningBar c(seed);
    ManyBodiesWorkspace workspace;
    ManyBodiesOptions options;
    options.all_contacts_in_time = true;
    const std::vector<PairAnswer> bodies = answer_each_pair(c.bodies(), workspace, options);
    const SceneResult links = check_robots(c.links(), {.all_contacts_in_time = true});
    ASSERT_EQ(bodies.size(), links.pairs.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const PairAnswer& body = bodies[k];
      const PairAnswer& link = links.pairs[k];
      ASSERT_EQ((BodyPair{body.members[0] + 1, body.members[1] + 1}), link.members);
      ASSERT_EQ(body.verdict, link.verdict);
      // A tolerance of motion at 1e-3 m per step, which no pair here is slower than for long.
      ASSERT_NEAR(body.t, link.t, 1e-3);
      ASSERT_EQ(body.verdict == Verdict::free, body.intervals.empty());
      of_bodies += body.intervals.size();
      of_links += link.intervals.size();
      for (int i = 0; i <= 2000; ++i) {
        const double t = i / 2000.0;
        const double gap = c.gap(body.members, t);
        for (const auto* answer : {&body, &link}) {
          // Sound: what is outside of the intervals is free.
          ASSERT_TRUE(holds(answer->intervals, t) || gap > -1e-12) << t;
          // Tight: what is inside is in contact, or was so 1e-3 of the step before.
          ASSERT_TRUE(!holds(answer->intervals, t) || gap < 0.04) << t;
        }
      }
    }
  }
  EXPECT_GE(of_bodies, 60u);
  EXPECT_EQ(of_bodies, of_links);
}

}  // namespace
}  // namespace firstcontact::test
