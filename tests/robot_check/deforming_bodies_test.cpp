// Bodies that deform beside robots: a tilting sheet against an arm in closed form, and the laws
// that other bodies keep, too.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/deforming_body.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/link_contact.h>
#include <firstcontact/robot_check/robot_gap.h>

#include "query/sheet.h"
#include "robot/planar_arm.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

std::string complaint_of(const auto& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "none";
}

/// Lets each vertex of a shape go a way of its own.
template <class Way>
DeformingBody deform(const Shape& shape, const Way& way) {
  std::vector<Vector3d> to;
  for (const Vector3d& v : shape.mesh().vertices) {
    to.push_back(v + way(v));
  }
  return move_vertices(shape, to);
}

std::size_t add(RobotScene& scene, const std::string& name, DeformingBody body) {
  return scene.add_body(name, std::move(body.shape), std::move(body.X_WS));
}

/// An arm of one bar that turns in the plane z = 0, and a large sheet z = height + slope x under
/// it, whose height and slope go from one value to another. It may pass through.
struct TiltingSheet {
  double angle[2];
  double height[2];
  double slope[2];

  explicit TiltingSheet(std::uint64_t seed) {
    Random random(seed);
    angle[0] = random.uniform(-3.0, 3.0);
    angle[1] = angle[0] + random.uniform(-8.0, 8.0);
    height[0] = random.uniform(-1.2, -0.7);
    height[1] = random.uniform(-0.6, 0.3);
    slope[0] = random.uniform(-0.4, 0.4);
    slope[1] = random.uniform(-0.8, 0.8);
  }

  [[nodiscard]] RobotScene scene(int squares) const {
    const auto z = [this](std::size_t end, double x) { return height[end] + slope[end] * x; };
    const Shape shape(sheet(squares, [&](double x, double) { return z(0, x); }));
    RobotScene scene;
    scene.add_robot("arm", planar_motion({ramp(angle[0], angle[1])}));
    add(scene, "sheet",
        deform(shape, [&](const Vector3d& v) { return Vector3d(0, 0, z(1, v.x()) - v.z()); }));
    return scene;
  }

  /// Between the bar and the sheet; negative where they overlap.
  [[nodiscard]] double gap(double t) const {
    const auto between = [t](const double(&ends)[2]) { return ends[0] + t * (ends[1] - ends[0]); };
    const double tilt = between(slope);
    const double at_hinge = between(height);
    const double at_tip = at_hinge + tilt * std::cos(between(angle));
    const double apart =
        at_hinge * at_tip > 0.0 ? std::min(std::abs(at_hinge), std::abs(at_tip)) : 0.0;
    return apart / std::sqrt(1.0 + tilt * tilt) - kBarRadius;
  }
};

TEST(DeformingBodies, MeetALinkInClosedForm) {
  int contacts = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const TiltingSheet c(seed);
    const RobotCheckOptions options;
    const SceneResult result = check_robots(c.scene(seed % 3 == 0 ? 1 : 12), options);
    ASSERT_NE(result.verdict, Verdict::undecided) << seed;
    for (int i = 0; i <= 2000; ++i) {
      const double t = result.t * i / 2000.0;
      ASSERT_GT(c.gap(t), result.verdict == Verdict::free ? 0.0 : -1e-12) << seed << " at " << t;
    }
    if (result.verdict != Verdict::free) {
      ++contacts;
      ASSERT_LE(c.gap(result.t), options.tolerance + 1e-12) << seed;
      const Contact& contact = result.pairs.at(result.first.value()).contacts.front();
      ASSERT_LT((contact.p_WA - contact.p_WB).norm(), options.tolerance + 1e-12) << seed;
    }
  }
  EXPECT_GT(contacts, 40);
  EXPECT_LT(contacts, 110);
}

TEST(DeformingBodies, TouchAtNoTimeOutsideOfIntervals) {
  RobotCheckOptions options;
  options.all_contacts_in_time = true;
  std::size_t intervals = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const TiltingSheet c(seed);
    const SceneResult result = check_robots(c.scene(6), options);
    ASSERT_EQ(result.pairs.size(), 1u);
    intervals += result.pairs[0].intervals.size();
    for (int i = 0; i <= 1000; ++i) {
      const double t = i / 1000.0;
      bool reported = false;
      for (const ContactInterval& interval : result.pairs[0].intervals) {
        reported = reported || (interval.enter <= t && t <= interval.leave);
      }
      ASSERT_TRUE(reported || c.gap(t) > -1e-12) << seed << " at " << t;
      ASSERT_TRUE(!reported || c.gap(t) < 0.05) << seed << " at " << t;
    }
  }
  EXPECT_GT(intervals, 20u);
}

TEST(DeformingBodies, ComeAsCloseAsTheySay) {
  RobotCheckOptions options;
  options.closest = true;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const TiltingSheet c(seed);
    const RobotScene scene = c.scene(6);
    const SceneResult result = check_robots(scene, options);
    double sampled = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 2000; ++i) {
      sampled = std::min(sampled, c.gap(i / 2000.0));
    }
    const ClosestApproach& least = result.pairs.at(result.closest.value()).closest.value();
    ASSERT_LE(least.lower_bound, std::max(sampled, 0.0) + 1e-12) << seed;
    ASSERT_LE(least.distance - least.lower_bound, options.tolerance) << seed;
    ASSERT_NEAR(least.distance, std::max(c.gap(least.t), 0.0), 1e-9 + options.tolerance) << seed;
    const double times[] = {0.0, 0.3, 1.0};
    const std::vector<RobotGap> gaps = robot_gaps(scene, times);
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      ASSERT_NEAR(gaps[k].distance, std::max(c.gap(times[k]), 0.0), 1e-9) << seed;
    }
  }
}

/// The frame of a mesh that grows about its middle rests, but its vertices do not.
TEST(DeformingBodies, AreTestedWhereOnlyTheirVerticesMove) {
  RobotScene scene;
  scene.add_robot("arm", planar_motion({ramp(0.0, 0.1)}));
  const Shape square(sheet(4, [](double, double) { return 3.0; }));
  add(scene, "cloth",
      deform(square, [](const Vector3d& v) { return Vector3d(v.x(), v.y(), 0.0); }));
  scene.add_body("post", make_sphere(0.5),
                 Motion::fixed({{3.5, 0.0, 3.0}, Eigen::Quaterniond::Identity()}));
  const SceneResult result = check_robots(scene);
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_LE(result.t, 0.5);
  EXPECT_NEAR(result.t, 0.5, 1e-6);  // The edge is at 2 (1 + t).
}

/// Alone or beside a robot that is far from them.
TEST(DeformingBodies, MeetEachOtherAsWithoutARobot) {
  int contacts = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const auto cloth = [&](double z) {
      const Shape shape(sheet(3, [&](double, double) { return z + random.uniform(-0.2, 0.2); }));
      const Vector3d shared = random.vector(0.0, 2.0);
      return deform(shape,
                    [&](const Vector3d&) { return Vector3d(shared + random.vector(0.0, 0.6)); });
    };
    const DeformingBody low = cloth(-0.5);
    const DeformingBody high = cloth(0.5);
    RobotScene scene;
    scene.add_robot(
        "arm", planar_motion({ramp(0.0, 1.0)},
                             Motion::fixed({{90.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()})));
    add(scene, "low", low);
    add(scene, "high", high);
    BodySet bodies;
    bodies.add(low.shape, low.X_WS);
    bodies.add(high.shape, high.X_WS);
    ManyBodiesWorkspace workspace;
    const SceneResult alone = first_contact(bodies, workspace);
    const SceneResult beside = check_robots(scene);
    ASSERT_EQ(beside.verdict, alone.verdict) << seed;
    contacts += alone.verdict == Verdict::contact ? 1 : 0;
    // Other frames round otherwise; 1e-6 m of tolerance at 1 m per step or more.
    ASSERT_NEAR(beside.t, alone.t, 2e-6) << seed;
  }
  EXPECT_GT(contacts, 10);
}

/// On a bar from the start, a little away from it.
TEST(DeformingBodies, KeepHalfOfAStartContact) {
  constexpr double kClose = 1e-7;  // [m]
  const auto with_way = [&](double at_middle) {
    const Shape shape(sheet(4, [&](double, double) { return kBarRadius + kClose; }));
    RobotScene scene;
    scene.add_robot("arm", planar_motion({ramp(0.0, 1.0)}));
    add(scene, "cloth", deform(shape, [&](const Vector3d& v) {
          return Vector3d(0.0, 0.0, v.isZero(0.1) ? at_middle : 0.2);
        }));
    return scene;
  };
  RobotCheckOptions options;
  EXPECT_EQ(check_robots(with_way(0.2), options).verdict, Verdict::contact_at_start);
  options.start_contacts = StartContacts::keep_half;
  EXPECT_EQ(check_robots(with_way(0.2), options).verdict, Verdict::free);
  const SceneResult into = check_robots(with_way(-0.2), options);
  ASSERT_EQ(into.verdict, Verdict::contact);
  EXPECT_LT(into.t, 1e-3);
}

TEST(DeformingBodies, AreNotHeldAndAreNoLinks) {
  const Shape square(sheet(2, [](double, double) { return 3.0; }));
  const DeformingBody cloth = deform(square, [](const Vector3d& v) { return Vector3d(0.5 * v); });
  RobotScene scene;
  const std::size_t robot = scene.add_robot("arm", planar_motion({ramp(0.0, 1.0)}));
  const std::size_t body = add(scene, "cloth", cloth);
  EXPECT_EQ(
      complaint_of([&] { scene.attach({.body = body, .link = scene.first_member(robot) + 1}); }),
      "RobotScene: 'cloth' deforms; a link holds rigid bodies only");
  const RobotMotion arm = planar_motion({ramp(0.0, 1.0)});
  const LinkMotion X_WL = arm.link(1);
  const LinkMotion X_WB(cloth.X_WS);
  const Shape post = make_sphere(0.1);
  Workspace workspace;
  EXPECT_EQ(complaint_of([&] {
              (void)first_contact({cloth.shape, X_WL}, {post, X_WB}, workspace);
            }),
            "queries of links: a shape deforms; links are rigid");
}

}  // namespace
}  // namespace firstcontact::test
