// keep_half and the contact band for links: what starts in contact, assembled or grasped, goes on
// as bodies do, and comes no nearer than half of its start distance.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/robot_check/check_robots.h>

#include "robot/planar_arm.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

constexpr double kClose = 1e-7;  // [m]  Between bodies that rest on each other.

/// A robot of one link with these geometries.
RobotMotion one_link(const std::vector<MemberGeometry>& geometries, const Motion& X_WL) {
  Link link{"link", {}, {}};
  for (const MemberGeometry& geometry : geometries) {
    link.collision.push_back(
        {.name = "", .X_LG = geometry.X_MG, .source = SphereGeometry{}, .shape = geometry.shape});
  }
  return {RobotModel({.name = "one", .links = {std::move(link)}, .joints = {}}), {}, X_WL};
}

Pose place(const Vector3d& p) { return {.position = p}; }

/// Boxes whose upper sides are at z = 0.
Shape floor_box() { return make_box({4, 4, 1}); }
constexpr double kFloor = -0.5;  // [m]  Height of its centre.

RobotCheckOptions keep_half(double margin_tolerance = 1e-6) {
  return {.tolerance = margin_tolerance, .start_contacts = StartContacts::keep_half};
}

/// A cube of 1 m whose lower side starts at a height, and moves so.
SceneResult slide(double gap, const Vector3d& way, const Vector3d& turn, double margin) {
  RobotScene scene{PairRules(margin)};
  scene.add_body("floor", floor_box(), Motion::fixed(place({0, 0, kFloor})));
  scene.add_robot("cube", one_link({{make_box({1, 1, 1}), {}}},
                                   Motion::constant_velocity(place({0, 0, 0.5 + gap}), way, turn)));
  return check_robots(scene, keep_half());
}

TEST(KeepHalfOfLinks, LetsALinkSlideTurnAndLeave) {
  for (const double margin : {0.0, 1e-2}) {
    const double gap = margin == 0.0 ? kClose : 5e-3;
    for (const Vector3d& way : {Vector3d(1, 0.3, 0), Vector3d(-1, 0, 0.5), Vector3d(0, 0, 2)}) {
      const SceneResult result = slide(gap, way, {0, 0, 2.0}, margin);
      EXPECT_EQ(result.verdict, Verdict::free) << margin << ' ' << result.t;
      EXPECT_GE(result.clearance, 0.499 * gap);
      EXPECT_LE(result.clearance, 0.501 * gap);
    }
  }
}

TEST(KeepHalfOfLinks, StopsALinkThatIsPressedOrTilted) {
  const double margin = 1e-2;
  const double gap = 5e-3;
  const SceneResult pressed = slide(gap, {0, 0, -gap}, Vector3d::Zero(), margin);
  ASSERT_EQ(pressed.verdict, Verdict::contact);
  // Between 3/4 and 1/2 of the start distance.
  EXPECT_GE(pressed.t, 0.249);
  EXPECT_LE(pressed.t, 0.501);
  const SceneResult tilted = slide(gap, Vector3d::Zero(), {0.1, 0, 0}, margin);
  ASSERT_EQ(tilted.verdict, Verdict::contact);
  EXPECT_GT(tilted.t, 0.0);
}

// A law: what is proven holds at dense samples, and the same holds of the bodies asked as bodies.
TEST(KeepHalfOfLinks, HoldsToHalfOfTheStartDistanceAlongAnyPath) {
  const double margin = 1e-2;
  const Shape cube = make_box({1, 1, 1});
  const Shape floor = floor_box();
  const Motion rest = Motion::fixed(place({0, 0, kFloor}));
  int stopped = 0;
  int free = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const double gap = margin * random.logarithmic(1e-3, 0.9);
    const auto number = [&] { return random.uniform(-1.0, 1.0); };
    const Vector3d way(number(), number(), gap * number());
    const Vector3d turn = gap * Vector3d(number(), number(), number());
    const SceneResult link = slide(gap, way, turn, margin);
    const Motion moves = Motion::constant_velocity(place({0, 0, 0.5 + gap}), way, turn);
    Workspace workspace;
    const FirstContactResult body =
        first_contact({floor, rest}, {cube, moves}, workspace,
                      {.margin = margin, .start_contacts = StartContacts::keep_half});
    SCOPED_TRACE(seed);
    ASSERT_NE(link.verdict, Verdict::undecided);
    ASSERT_NE(link.verdict, Verdict::contact_at_start);
    const double held = 0.5 * gap - 1e-12;
    EXPECT_GE(link.clearance, held);
    EXPECT_NEAR(link.clearance, body.clearance, 1e-3 * gap);
    EXPECT_EQ(link.verdict, body.verdict);
    stopped += link.verdict == Verdict::contact ? 1 : 0;
    free += link.verdict == Verdict::free ? 1 : 0;
    if (link.verdict == Verdict::contact) {
      EXPECT_LE(distance({floor, rest}, {cube, moves}, link.t, workspace).distance,
                0.75 * gap * (1.0 + 0x1p-9));
    }
    for (int k = 0; k <= 64; ++k) {
      const double t = link.t * k / 64.0;
      ASSERT_GE(distance({floor, rest}, {cube, moves}, t, workspace).distance, held) << t;
    }
  }
  EXPECT_GE(stopped, 10);
  EXPECT_GE(free, 10);
}

// The hold is one of members: a cube slides from one geometry of a link to the next.
TEST(KeepHalfOfLinks, IsTheSameHoweverALinkIsCutIntoGeometries) {
  for (const bool is_cut : {false, true}) {
    RobotScene scene{PairRules(1e-2)};
    std::vector<MemberGeometry> floor;
    if (is_cut) {
      floor = {{make_box({2, 4, 1}), place({-1, 0, 0})}, {make_box({2, 4, 1}), place({1, 0, 0})}};
    } else {
      floor = {{floor_box(), {}}};
    }
    scene.add_robot("floor", one_link(floor, Motion::fixed(place({0, 0, kFloor}))));
    scene.add_robot(
        "cube", one_link({{make_box({1, 1, 1}), {}}},
                         Motion::constant_velocity(place({-1.2, 0, 0.505}), Vector3d(2.4, 0, 0))));
    const SceneResult result = check_robots(scene, keep_half());
    EXPECT_EQ(result.verdict, Verdict::free) << is_cut << ' ' << result.t;
    EXPECT_NEAR(result.clearance, 2.5e-3, 1e-5);
  }
}

// Other pairs keep their margin.
TEST(KeepHalfOfLinks, LeavesOtherPairsTheirMargin) {
  RobotScene scene{PairRules(1e-2)};
  scene.add_body("floor", floor_box(), Motion::fixed(place({0, 0, kFloor})));
  scene.add_body("wall", make_box({1, 4, 2}), Motion::fixed(place({2.0, 0, 1.5})));
  scene.add_robot("cube",
                  one_link({{make_box({1, 1, 1}), {}}},
                           Motion::constant_velocity(place({0, 0, 0.505}), Vector3d(2, 0, 0))));
  const SceneResult result = check_robots(scene, keep_half());
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_NEAR(result.t, 0.5 * (1.0 - 1e-2), 1e-6);
}

/// A gripper lifts a cube off a table, puts it back at t = 0.5 and then moves by `after`.
SceneResult grasp(const Vector3d& after, StartContacts starts) {
  constexpr double kHand = 0.1 + 2 * kClose + 0.025;
  RobotScene scene{PairRules(10.0 * kClose)};
  scene.add_body("table", floor_box(), Motion::fixed(place({0, 0, kFloor})));
  const std::size_t cube = scene.add_body("cube", make_box({0.1, 0.1, 0.1}),
                                          Motion::fixed(place({0, 0, 0.05 + kClose})));
  const std::vector<double> times = {0.0, 0.25, 0.5, 1.0};
  const Vector3d low(0, 0, kHand);
  const std::vector<Pose> poses = {place(low), place(low + Vector3d(0, 0, 0.3)), place(low),
                                   place(low + after)};
  const std::size_t hand = scene.add_robot(
      "hand", one_link({{make_box({0.05, 0.05, 0.05}), {}}}, Motion::waypoints(times, poses)));
  scene.attach({.body = cube, .link = scene.first_member(hand), .t_from = 0.0, .t_to = 0.5});
  return check_robots(scene, {.start_contacts = starts});
}

TEST(KeepHalfOfLinks, LetsAHandLiftAndPutDown) {
  EXPECT_EQ(grasp({0, 0, 0.3}, StartContacts::report).verdict, Verdict::contact_at_start);
  const SceneResult result = grasp({0, 0, 0.3}, StartContacts::keep_half);
  EXPECT_EQ(result.verdict, Verdict::free) << result.t;
  EXPECT_GE(result.clearance, 0.49 * kClose);
  EXPECT_LE(result.clearance, 0.51 * kClose);
  // Along the cube it leaves, too; into the cube it does not.
  EXPECT_EQ(grasp({0.3, 0, 0}, StartContacts::keep_half).verdict, Verdict::free);
  const SceneResult pressed = grasp({0, 0, -0.04}, StartContacts::keep_half);
  ASSERT_EQ(pressed.verdict, Verdict::contact);
  EXPECT_GE(pressed.t, 0.5);
  EXPECT_LE(pressed.t, 0.5 + 1e-5);
}

TEST(KeepHalfOfLinks, ReportsAStartAtDistanceZeroAndInside) {
  EXPECT_EQ(slide(0.0, {1, 0, 0}, Vector3d::Zero(), 1e-2).t, 0.0);
  EXPECT_EQ(slide(-0.6, {0, 0, 1}, Vector3d::Zero(), 1e-2).verdict, Verdict::contact_at_start);
}

TEST(KeepHalfOfLinks, EndsWithItsBudget) {
  RobotScene scene{PairRules(1e-2)};
  scene.add_body("floor", floor_box(), Motion::fixed(place({0, 0, kFloor})));
  scene.add_robot("cube",
                  one_link({{make_box({1, 1, 1}), {}}},
                           Motion::constant_velocity(place({0, 0, 0.505}), Vector3d(1, 0, 0))));
  RobotCheckOptions options = keep_half();
  options.budget.steps = 1;
  const SceneResult result = check_robots(scene, options);
  EXPECT_EQ(result.verdict, Verdict::undecided);
  EXPECT_EQ(result.reason, UndecidedReason::work);
}

TEST(KeepHalfOfLinks, IsNotForTrackingErrors) {
  RobotScene scene;
  const std::size_t arm = scene.add_robot("arm", planar_motion({ramp(0.0, 1.0)}));
  scene.set_tracking_error(arm, "j0", {.angle = 0.01});
  EXPECT_THROW((void)check_robots(scene, keep_half()), std::invalid_argument);
}

// A plate lands flat on two posts of one link, of which one is lower by less than the band.
TEST(ContactBandOfLinks, ListsTheFeaturesOfAllGeometries) {
  RobotScene scene;
  scene.add_robot("posts", one_link({{make_box({0.1, 0.1, 1}), place({-0.5, 0, 0})},
                                     {make_box({0.1, 0.1, 1}), place({0.5, 0, -5e-4})},
                                     {make_box({0.1, 0.1, 1}), place({0, 0.5, -5e-3})}},
                                    Motion::fixed()));
  scene.add_body("plate", make_box({2, 2, 0.1}),
                 Motion::constant_velocity(place({0, 0, 1.55}), Vector3d(0, 0, -2)));
  const auto geometries = [&](double band) {
    const SceneResult result = check_robots(scene, {.contact_band = band});
    std::set<std::size_t> found;
    for (const Contact& contact : result.pairs.at(0).contacts) {
      EXPECT_LE(contact.distance, 1e-6 + band + 1e-12);
      found.insert(contact.geometries[0]);
    }
    EXPECT_EQ(result.pairs[0].contact_count.at_least, result.pairs[0].contacts.size());
    return found;
  };
  EXPECT_EQ(geometries(0.0), (std::set<std::size_t>{0}));
  EXPECT_EQ(geometries(1e-3), (std::set<std::size_t>{0, 1}));
  EXPECT_EQ(geometries(1e-2), (std::set<std::size_t>{0, 1, 2}));
}

TEST(ContactBandOfLinks, IsNotNegative) {
  EXPECT_THROW((void)check_robots(RobotScene(), {.contact_band = -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact::test
