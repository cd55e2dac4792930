// Edges and places of planners: never free where they are not, and tight.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/robot_check/check_robots.h>

#include "planning/plan_cases.h"
#include "robot/planar_arm.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

/// A wheel with a peg of 5 mm at 0.5 m from its axis, on a joint without limits; pegs stand around
/// it at given angles. A second wheel, far off, mimics it.
PlanScene wheel(const std::vector<double>& angles) {
  RobotDescription robot{.name = "wheel", .links = {{"base"}, {"rim"}, {"other"}}, .joints = {}};
  for (const std::size_t link : {std::size_t{1}, std::size_t{2}}) {
    robot.links[link].collision.push_back(
        {.name = "",
         .X_LG = {{0.5, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
         .source = SphereGeometry{},
         .shape = make_box({0.01, 0.01, 0.01})});
  }
  robot.joints.push_back({.name = "turn",
                          .type = JointType::continuous,
                          .parent = "base",
                          .child = "rim",
                          .axis = Vector3d::UnitZ()});
  robot.joints.push_back({.name = "follows",
                          .type = JointType::continuous,
                          .parent = "base",
                          .child = "other",
                          .X_PJ = {{5.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                          .axis = Vector3d::UnitZ(),
                          .mimic = Mimic{.joint = "turn"}});
  const RobotModel model(robot);
  RobotScene scene;
  for (const double angle : angles) {
    scene.add_body("peg " + std::to_string(angle), make_box({0.01, 0.01, 0.01}),
                   resting_at({0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0}));
  }
  const RobotMotion rest = at_rest(model);
  const std::vector<std::string> names = {"turn"};
  const std::size_t index = scene.add_robot("wheel", rest);
  return {.scene = std::move(scene),
          .robots = {index},
          .space = ConfigurationSpace::of_joints(model, names, detail::given_motions(rest))};
}

TEST(EdgeChecker, SeesAPlateBetweenAnyTwoSamples) {
  const EdgeChecker checker(with_gantry(thin_wall(0.0)));
  Random random(1);
  for (int k = 0; k < rounds(200, 40); ++k) {
    const Configuration from = {random.uniform(-2.0, -0.11), random.uniform(-2, 2),
                                random.uniform(-2, 2)};
    const Configuration to = {random.uniform(0.11, 2.0), random.uniform(-2, 2),
                              random.uniform(-2, 2)};
    const EdgeAnswer answer = checker.check(from, to);
    ASSERT_EQ(answer.verdict, EdgeVerdict::blocked) << k;
    // The face of the cube meets that of the wall at x = -0.100005.
    const double meets = (-0.100005 - from[0]) / (to[0] - from[0]);
    ASSERT_LE(answer.fraction, meets) << k;
    ASSERT_GE(answer.fraction, 0.999 * meets - 1e-5) << k;
    ASSERT_TRUE(answer.pair.has_value());
    EXPECT_EQ(checker.scene().name((*answer.pair)[0]), "wall");
    EXPECT_EQ(checker.scene().name((*answer.pair)[1]), "gantry/tool");
  }
}

/// The fractions of edges that the gantry's tool, at a speed, ends in the wall at x = 0.
void expect_fractions(double tolerance, double from_x, double to_x) {
  const EdgeChecker checker(with_gantry(thin_wall(0.0)), {.fraction_tolerance = tolerance});
  Random random(3);
  for (int k = 0; k < rounds(40, 10); ++k) {
    const Configuration from = {from_x, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
    const Configuration to = {to_x, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)};
    const EdgeAnswer answer = checker.check(from, to);
    ASSERT_EQ(answer.verdict, EdgeVerdict::blocked) << k;
    const double meets = (-0.100005 - from_x) / (to_x - from_x);
    const double by_distance = 1.1e-6 / (to_x - from_x);
    ASSERT_LE(answer.fraction, meets) << k;
    ASSERT_GE(answer.fraction, meets - tolerance - by_distance - 1e-12) << k;
    ASSERT_EQ(checker.check_quickly(from, to).verdict, EdgeVerdict::blocked) << k;
  }
}

TEST(EdgeChecker, MayTellAFractionThatIsLessByItsTolerance) {
  for (const double tolerance : {0.0, 1e-3, 0.1, 1.0}) {
    expect_fractions(tolerance, -1.0, 1.0);
    expect_fractions(tolerance, -2.0, -0.1);      // Blocked at the very end.
    expect_fractions(tolerance, -0.10002, 2.0);   // So, too, at the very begin;
    expect_fractions(tolerance, -0.10002, -0.1);  // and along a very short edge.
  }
  EXPECT_THROW(EdgeChecker(with_gantry(RobotScene()), {.fraction_tolerance = -1e-9}),
               std::invalid_argument);
  EXPECT_THROW(EdgeChecker(with_gantry(RobotScene()), {.fraction_tolerance = 1.1}),
               std::invalid_argument);
  EXPECT_THROW(EdgeChecker(with_gantry(RobotScene()),
                           {.fraction_tolerance = std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
}

TEST(EdgeChecker, HasNoFractionWhereAnEdgeBeginsBlocked) {
  const EdgeChecker checker(with_gantry(thin_wall(0.0)), {.fraction_tolerance = 1e-3});
  for (const double x : {-0.100005, -0.05, 0.0}) {
    for (const double way : {0.0, 1e-12, -1.0, 1.0}) {
      const EdgeAnswer answer = checker.check({x, 0.0, 0.0}, {x + way, 0.0, 0.0});
      EXPECT_EQ(answer.verdict, EdgeVerdict::blocked) << x << ' ' << way;
      EXPECT_EQ(answer.fraction, 0.0) << x << ' ' << way;
    }
  }
}

// Along a wall within the tolerance an edge is blocked from its begin on or not at all; beyond it
// is free, however small the gap.
TEST(EdgeChecker, GrazesWithAFractionTolerance) {
  const EdgeChecker checker(with_gantry(thin_wall(0.0)), {.fraction_tolerance = 1e-3});
  for (const double gap : {1.1e-6, 1e-5, 1e-4}) {
    const double x = -0.100005 - gap;
    EXPECT_EQ(checker.check({x, -1.0, 0.3}, {x, 1.0, -0.4}).verdict, EdgeVerdict::free) << gap;
  }
  // It comes as near as that in the middle of the edge only, then leaves.
  const EdgeAnswer dives = checker.check({-0.1001, -1.5, 0.0}, {-0.1, 1.5, 0.0});
  EXPECT_EQ(dives.verdict, EdgeVerdict::blocked);
  EXPECT_LE(dives.fraction, 0.95);
  EXPECT_GE(dives.fraction, 0.95 - 1e-3 - 0.011);
}

TEST(EdgeChecker, FreesAnEdgeWithItsClearance) {
  const EdgeChecker checker(with_gantry(thin_wall(0.0)));
  const Configuration from = {-0.15, -1.0, 0.3};
  const Configuration to = {-0.15, 1.0, -0.4};
  const double gap = 0.15 - 0.100005;
  const EdgeAnswer quick = checker.check(from, to);
  EXPECT_EQ(quick.verdict, EdgeVerdict::free);
  EXPECT_EQ(quick.fraction, 1.0);
  EXPECT_LE(quick.clearance.value(), gap);
  const EdgeAnswer close = checker.check_closely(from, to);
  EXPECT_EQ(close.verdict, EdgeVerdict::free);
  EXPECT_LE(close.clearance.value(), gap);
  EXPECT_GE(close.clearance.value(), gap - 1e-5);
}

// A planner keeps a part of a blocked edge; that part must be free itself, as its end is rounded.
TEST(EdgeChecker, ProvesTheWayToTheRoundedPlace) {
  const PlanScene scene = with_gantry(thin_wall(0.3));
  const EdgeChecker checker(scene);
  // It reports as blocked only what is nearer than a tenth of the extra clearance.
  const EdgeChecker strict(scene, {.tolerance = 1e-10, .extra_clearance = 0.0});
  Random random(2);
  int blocked = 0;
  for (int k = 0; k < rounds(200, 40); ++k) {
    const Configuration from = {-1.0, random.uniform(-1, 1), random.uniform(-1, 1)};
    const Configuration to = {1.0, random.uniform(-1, 1), random.uniform(-1, 1)};
    const EdgeAnswer answer = checker.check(from, to);
    if (answer.verdict == EdgeVerdict::blocked) {
      ++blocked;
      const Configuration last = checker.space().interpolate(from, to, answer.fraction);
      ASSERT_EQ(strict.check(from, last).verdict, EdgeVerdict::free) << k;
    }
  }
  EXPECT_GT(blocked, rounds(200, 40) / 2);
}

/// A ball at x, and one that is planned, radii of 0.3 and 0.1 m.
PlanScene balls_at(double x) {
  RobotScene scene;
  scene.add_body("ball", make_sphere(0.3), resting_at({x, 0.0, 0.0}));
  ConfigurationSpace space = ConfigurationSpace::of_body(
      "moved", make_sphere(0.1), Vector3d::Constant(-1.0), Vector3d::Constant(1.0));
  const Configuration start = {x - 1.0, 0, 0, 1, 0, 0, 0};
  const std::size_t robot = scene.add_robot("moved", space.motion(start, start));
  return {.scene = std::move(scene), .robots = {robot}, .space = std::move(space)};
}

// Far from the origin, too, an edge has its fraction, and the way to its rounded place is free.
TEST(EdgeChecker, HasAFractionFarFromTheOrigin) {
  for (const double x : {0.0, 300.0, 1e4, 1e6}) {
    const PlanScene scene = balls_at(x);
    const EdgeChecker checker(scene);
    const EdgeChecker strict(scene, {.tolerance = 1e-10, .extra_clearance = 0.0});
    const Configuration from = {x - 1.0, 0, 0, 1, 0, 0, 0};
    const Configuration to = {x + 1.0, 0, 0, 0.6, 0.8, 0, 0};
    for (const EdgeAnswer& answer : {checker.check(from, to), checker.check_closely(from, to)}) {
      ASSERT_EQ(answer.verdict, EdgeVerdict::blocked) << x;
      EXPECT_NEAR(answer.fraction, 0.3, 1e-4) << x;
      const Configuration last = checker.space().interpolate(from, to, answer.fraction);
      EXPECT_EQ(strict.check(from, last).verdict, EdgeVerdict::free) << x;
    }
  }
}

// Half a turn has a fraction, too: the piece is proven by itself.
TEST(EdgeChecker, HasAFractionOfHalfATurn) {
  const PlanScene scene = balls_at(0.0);
  const Configuration from = {-1.0, 0, 0, 1, 0, 0, 0};
  const EdgeAnswer answer = EdgeChecker(scene).check(from, {1.0, 0, 0, 0, 0, 0, 1});
  ASSERT_EQ(answer.verdict, EdgeVerdict::blocked);
  EXPECT_NEAR(answer.fraction, 0.3, 1e-4);
}

/// A bar of 1 m that turns on a slide, which rests at a place, and on one that follows the turn.
ConfigurationSpace turning_on_slides(double place, double multiplier) {
  RobotDescription robot{
      .name = "r", .links = {{"base"}, {"rim"}, {"held"}, {"follower"}}, .joints = {}};
  robot.links[3].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = make_box({2.0, 0.1, 0.1})});
  robot.joints = {{.name = "turn", .type = JointType::continuous, .parent = "base", .child = "rim"},
                  {.name = "slide", .type = JointType::prismatic, .parent = "rim", .child = "held"},
                  {.name = "follows",
                   .type = JointType::prismatic,
                   .parent = "held",
                   .child = "follower",
                   .mimic = Mimic{.joint = "turn", .multiplier = multiplier}}};
  for (Joint& joint : robot.joints) {
    joint.limits = {.lower = -1e6, .upper = 1e6};
  }
  const std::vector<std::string> names = {"turn"};
  return ConfigurationSpace::of_joints(
      RobotModel(robot), names,
      {{"turn", CoordinatePath::constant(0.0)}, {"slide", CoordinatePath::constant(place)}});
}

// A rounded angle moves the end of all that is drawn out, also by slides that no edge moves.
TEST(ConfigurationSpace, BoundsTheRoundingOfPlaces) {
  const double ulp = 0x1p-53;
  EXPECT_GE(turning_on_slides(0.0, 0.0).rounding_bound({0.0}, {1.0}), ulp);
  EXPECT_GE(turning_on_slides(1e4, 0.0).rounding_bound({0.0}, {1.0}), ulp * 1e4);
  EXPECT_GE(turning_on_slides(0.0, 1e4).rounding_bound({0.0}, {1.0}), ulp * 2e4);
  EXPECT_LE(turning_on_slides(0.0, 0.0).rounding_bound({0.0}, {1.0}), 100.0 * ulp);
  // A body's positions count once: it turns about its origin, wherever that is.
  const Configuration from = {1e4, 0, 0, 1, 0, 0, 0};
  const Configuration to = {1e4, 1.0, 0, 0.6, 0.8, 0, 0};
  const double bound = balls_at(0.0).space.rounding_bound(from, to);
  EXPECT_GE(bound, ulp * 1e4);
  EXPECT_LE(bound, 1e-9);
  // Rounded, a place of half a turn may be reached the other way round.
  EXPECT_TRUE(std::isinf(balls_at(0.0).space.rounding_bound(from, {1e4, 0, 0, 0, 1, 0, 0})));
}

TEST(EdgeChecker, GivesAPlaceItsClearance) {
  const EdgeChecker checker(with_gantry(thin_wall(0.0)));
  const StateAnswer apart = checker.state({-0.5, 0.0, 0.0});
  EXPECT_EQ(apart.verdict, EdgeVerdict::free);
  EXPECT_LE(apart.clearance.value(), 0.399995);
  EXPECT_GE(apart.clearance.value(), 0.399985);
  const StateAnswer touching = checker.state({-0.05, 0.0, 0.0});
  EXPECT_EQ(touching.verdict, EdgeVerdict::blocked);
  EXPECT_EQ(touching.clearance, 0.0);
  EXPECT_TRUE(checker.is_free({-0.5, 0.0, 0.0}));
  EXPECT_FALSE(checker.is_free({-0.05, 0.0, 0.0}));
}

TEST(EdgeChecker, HasNoClearanceWhereNothingIsTested) {
  const EdgeChecker checker(with_gantry(RobotScene()));
  const StateAnswer alone = checker.state({0.0, 0.0, 0.0});
  EXPECT_EQ(alone.verdict, EdgeVerdict::free);
  EXPECT_EQ(alone.clearance, std::nullopt);
}

TEST(EdgeChecker, KeepsTheMargin) {
  RobotScene scene = thin_wall(0.0);
  scene.rules() = PairRules(0.03);
  const EdgeChecker checker(with_gantry(std::move(scene)));
  EXPECT_TRUE(checker.is_free({-0.1301, 0.0, 0.0}));
  EXPECT_FALSE(checker.is_free({-0.1299, 0.0, 0.0}));
}

/// A slot, open at the top, 0.3 m wide: no hull tells that a cube fits into it.
Shape slot() {
  Mesh slot;
  const auto add = [&](const Vector3d& sizes, const Vector3d& place) {
    const Shape box = make_box(sizes);
    const auto first = static_cast<std::uint32_t>(slot.vertices.size());
    for (const Vector3d& vertex : box.mesh().vertices) {
      slot.vertices.push_back(vertex + place);
    }
    for (auto triangle : box.mesh().triangles) {
      for (auto& corner : triangle) {
        corner += first;
      }
      slot.triangles.push_back(triangle);
    }
  };
  add({0.1, 1.0, 1.0}, {-0.2, 0.0, 0.0});
  add({0.1, 1.0, 1.0}, {0.2, 0.0, 0.0});
  add({0.5, 1.0, 0.1}, {0.0, 0.0, -0.55});
  return Shape(std::move(slot));
}

/// The tool, a cube of 0.2 m, begins 1 mm above a plate; a post stands 0.5 m along x.
PlanScene above_a_plate() {
  RobotScene scene(PairRules(0.01));
  scene.add_body("plate", make_box({4.0, 4.0, 1.0}), resting_at({0.0, 0.0, -0.601}));
  scene.add_body("post", make_box({0.2, 0.2, 1.0}), resting_at({0.5, 0.0, 0.4}));
  return with_gantry(std::move(scene));
}

// Held is the pair alone that is named: neither does it come nearer, nor is another one hidden.
TEST(EdgeChecker, HoldsAPairToItsOwnDistance) {
  const PlanScene scene = above_a_plate();
  const std::size_t tool = scene.scene.find_member("gantry/tool").value();
  const EdgeChecker strict(scene);
  const EdgeChecker held(scene, {.held = {{{0, tool}, 5e-4, 1e-5}}});
  const Configuration start = {0.0, 0.0, 0.0};
  EXPECT_EQ(strict.check(start, start).verdict, EdgeVerdict::blocked);
  const Configuration away = {-1.0, 1.0, 0.0};
  for (const EdgeAnswer& answer : {held.check(start, away), held.check_quickly(start, away),
                                   held.check_closely(start, away)}) {
    EXPECT_EQ(answer.verdict, EdgeVerdict::free);
    EXPECT_GE(answer.clearance.value(), 0.01);  // Clearance of the post.
  }
  EXPECT_NEAR(held.check_closely(start, away).clearance.value(), 0.3, 1e-3);
  EXPECT_EQ(held.check(start, {-1.0, 1.0, -0.00048}).verdict, EdgeVerdict::free);
  const EdgeAnswer dives = held.check(start, {-1.0, 1.0, -0.001});
  EXPECT_EQ(dives.verdict, EdgeVerdict::blocked);
  EXPECT_EQ(dives.pair, (BodyPair{0, tool}));
  EXPECT_NEAR(dives.fraction, 0.5, 0.03);
  EXPECT_EQ(held.check_quickly(start, {-1.0, 1.0, -0.001}).verdict, EdgeVerdict::blocked);
  EXPECT_EQ(held.check_closely(start, {-1.0, 1.0, -0.001}).verdict, EdgeVerdict::blocked);
  const EdgeAnswer hits = held.check(start, {1.0, 0.0, 0.0});
  EXPECT_EQ(hits.verdict, EdgeVerdict::blocked);
  EXPECT_EQ(hits.pair, (BodyPair{1, tool}));
  EXPECT_NEAR(hits.fraction, 0.29, 1e-3);
}

TEST(EdgeChecker, RefusesHeldPairsOfWhichNothingWouldBeProven) {
  const PlanScene scene = above_a_plate();
  const std::size_t tool = scene.scene.find_member("gantry/tool").value();
  const auto problem = [](const PlanScene& plan, const HeldPair& pair) {
    try {
      const EdgeChecker checker(plan, {.held = {pair}});
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(problem(scene, {{0, 1}, 5e-4, 1e-5}).find("not tested"), std::string::npos);
  EXPECT_NE(problem(scene, {{0, tool}, 0.0, 1e-5}).find("distances"), std::string::npos);
  EXPECT_NE(problem(scene, {{0, tool}, 5e-4, 0.0}).find("tolerances"), std::string::npos);
  PlanScene ignored = scene;
  ignored.scene.rules().ignore({0, tool});
  EXPECT_NE(problem(ignored, {{0, tool}, 5e-4, 1e-5}).find("not tested"), std::string::npos);
  PlanScene inexact = scene;
  inexact.scene.set_tracking_error(inexact.robots.front(), "z", {.distance = 1e-4});
  EXPECT_NE(problem(inexact, {{0, tool}, 5e-4, 1e-5}).find("tracking errors"), std::string::npos);
}

TEST(EdgeChecker, IsUndecidedBeyondTheEffort) {
  RobotScene scene;
  scene.add_body("slot", slot());
  const PlanScene plan = with_gantry(std::move(scene));
  const Configuration above = {0.0, 0.0, 1.0};
  const Configuration within = {0.01, 0.0, 0.0};
  EXPECT_EQ(EdgeChecker(plan).check(above, within).verdict, EdgeVerdict::free);
  const EdgeChecker lazy(plan, {.effort = 1});
  for (const EdgeAnswer& answer : {lazy.check(above, within), lazy.check_quickly(above, within)}) {
    EXPECT_EQ(answer.verdict, EdgeVerdict::undecided);
    EXPECT_EQ(answer.reason, UndecidedReason::work);
    EXPECT_LT(answer.fraction, 1.0);
    ASSERT_TRUE(answer.pair.has_value());
    EXPECT_EQ(plan.name((*answer.pair)[0]), "slot");
  }
}

TEST(EdgeChecker, IsAsTrueWhenItIsQuick) {
  RobotScene scene = thin_wall(0.3);
  scene.add_body("slot", slot(), resting_at({-1.0, 0.0, 0.0}));
  const EdgeChecker checker(with_gantry(std::move(scene)));
  Random random(6);
  int blocked = 0;
  for (int k = 0; k < rounds(300, 40); ++k) {
    const Configuration from = {random.uniform(-2, 2), random.uniform(-1, 1),
                                random.uniform(-1, 1)};
    const Configuration to = {random.uniform(-2, 2), random.uniform(-1, 1), random.uniform(-1, 1)};
    const EdgeAnswer whole = checker.check(from, to);
    const EdgeAnswer quick = checker.check_quickly(from, to);
    ASSERT_EQ(quick.verdict, whole.verdict) << k;
    ASSERT_EQ(quick.fraction, whole.verdict == EdgeVerdict::free ? 1.0 : 0.0) << k;
    const EdgeAnswer close = checker.check_closely(from, to);
    ASSERT_EQ(close.verdict, whole.verdict) << k;
    ASSERT_NEAR(close.fraction, whole.fraction, 1e-5) << k;
    blocked += whole.verdict == EdgeVerdict::blocked ? 1 : 0;
  }
  EXPECT_GT(blocked, rounds(300, 40) / 4);
}

TEST(EdgeChecker, TurnsAJointWithoutLimitsTheShortWay) {
  const double pi = std::numbers::pi;
  const EdgeChecker at_half_turn(wheel({pi}));
  const EdgeChecker at_zero(wheel({0.0}));
  const Configuration from = {3.0};
  const Configuration to = {-3.0};
  EXPECT_EQ(at_half_turn.check(from, to).verdict, EdgeVerdict::blocked);
  EXPECT_EQ(at_zero.check(from, to).verdict, EdgeVerdict::free);
  EXPECT_NEAR(at_zero.space().distance(from, to), 2.0 * pi - 6.0, 1e-12);
  // Whole turns do not matter.
  EXPECT_EQ(at_zero.check({3.0 + 2.0 * pi}, to).verdict, EdgeVerdict::free);
  const Configuration middle = at_zero.space().interpolate(from, to, 0.5);
  EXPECT_NEAR(middle[0], pi, 1e-12);
}

TEST(EdgeChecker, MovesJointsThatMimic) {
  PlanScene scene = wheel({});
  RobotScene with_peg;
  with_peg.add_body("peg", make_box({0.01, 0.01, 0.01}), resting_at({5.0, 0.5, 0.0}));
  with_peg.add_robot("wheel", scene.scene.robot_motion(0));
  scene.scene = std::move(with_peg);
  const EdgeChecker checker(std::move(scene));
  const EdgeAnswer answer = checker.check({0.0}, {2.0});
  ASSERT_EQ(answer.verdict, EdgeVerdict::blocked);
  EXPECT_EQ(checker.scene().name((*answer.pair)[1]), "wheel/other");
}

TEST(EdgeChecker, CarriesWhatIsHeld) {
  RobotScene scene = thin_wall(0.0);
  scene.add_body("load", make_box({0.1, 0.1, 0.1}));
  PlanScene plan = with_gantry(std::move(scene));
  const std::size_t load = plan.scene.find_member("load").value();
  const std::size_t tool = plan.scene.find_member("gantry/tool").value();
  plan.scene.attach({.body = load, .link = tool, .X_LB = Pose{{0.5, 0.0, 0.0}}});
  const EdgeChecker checker(std::move(plan));
  const EdgeAnswer answer = checker.check({-2.0, 0.0, 0.0}, {-0.2, 0.0, 0.0});
  ASSERT_EQ(answer.verdict, EdgeVerdict::blocked);
  // The far face of the load is 0.55 m before the tool's middle.
  EXPECT_NEAR(answer.fraction, (-0.550005 + 2.0) / 1.8, 1e-5);
  // And from wherever an edge begins.
  EXPECT_FALSE(checker.is_free({-0.5, 0.0, 0.0}));
  EXPECT_TRUE(checker.is_free({-0.6, 0.0, 0.0}));
}

TEST(EdgeChecker, MovesABodyAsSlerpDoes) {
  const EdgeChecker checker(with_bar(thin_wall(0.0), {0.4, 0.02, 0.02}));
  const double half = std::sqrt(0.5);
  const Configuration along = {-0.3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  const Configuration across = {-0.1, 0.0, 0.0, half, 0.0, 0.0, half};
  EXPECT_TRUE(checker.is_free(along));
  EXPECT_TRUE(checker.is_free(across));
  EXPECT_EQ(checker.check(along, across).verdict, EdgeVerdict::free);
  // The same rotation by the other sign is the same edge.
  Configuration other = across;
  for (std::size_t k = 3; k < 7; ++k) {
    other[k] = -other[k];
  }
  EXPECT_EQ(checker.check(along, other).verdict, EdgeVerdict::free);
  EXPECT_NEAR(checker.space().distance(across, other), 0.0, 1e-9);
  // Turned first, in place, the bar would hit the wall.
  const Configuration near = {-0.1, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(checker.is_free(near));
  const EdgeAnswer turning = checker.check(across, near);
  ASSERT_EQ(turning.verdict, EdgeVerdict::blocked);
  const EdgeChecker strict(checker.scene(), {.tolerance = 1e-10, .extra_clearance = 0.0});
  const Configuration last = checker.space().interpolate(across, near, turning.fraction);
  EXPECT_EQ(strict.check(across, last).verdict, EdgeVerdict::free);
  EXPECT_GT(turning.fraction, 0.1);
}

TEST(EdgeChecker, AnswersManyAsOneByOne) {
  const EdgeChecker checker(with_gantry(thin_wall(0.3)));
  Random random(3);
  std::vector<Configuration> from;
  std::vector<Configuration> to;
  for (int k = 0; k < rounds(100, 20); ++k) {
    from.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    to.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  }
  for (const int threads : {1, 2}) {
    const std::vector<EdgeAnswer> answers = checker.check(from, to, threads);
    ASSERT_EQ(answers.size(), from.size());
    for (std::size_t k = 0; k < from.size(); ++k) {
      const EdgeAnswer one = checker.check(from[k], to[k]);
      ASSERT_EQ(answers[k].verdict, one.verdict) << k;
      ASSERT_EQ(answers[k].fraction, one.fraction) << k;
      ASSERT_EQ(answers[k].clearance, one.clearance) << k;
      ASSERT_EQ(answers[k].pair, one.pair) << k;
    }
  }
  to.pop_back();
  EXPECT_THROW((void)checker.check(from, to), std::invalid_argument);
}

TEST(EdgeChecker, TakesRobotsAtRestWithJoints) {
  RobotScene scene;
  scene.add_robot("other",
                  planar_motion({ramp(0.3, 0.3), ramp(-1.0, -1.0)}, resting_at({50.0, 0.0, 0.0})));
  PlanScene plan = with_gantry(std::move(scene));
  plan.robots = {1};
  const EdgeChecker checker(plan);
  EXPECT_EQ(checker.check({-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}).verdict, EdgeVerdict::free);
}

TEST(EdgeChecker, RefusesWhatMovesByItself) {
  RobotScene moving;
  moving.add_body("cart", make_box({1, 1, 1}),
                  Motion::constant_velocity(Pose{}, Vector3d(1.0, 0.0, 0.0)));
  EXPECT_THROW(EdgeChecker(with_gantry(std::move(moving))), std::invalid_argument);

  RobotScene held;
  held.add_body("load", make_box({0.1, 0.1, 0.1}));
  PlanScene plan = with_gantry(std::move(held));
  plan.scene.attach(
      {.body = 0, .link = plan.scene.find_member("gantry/tool").value(), .t_to = 0.5});
  EXPECT_THROW(EdgeChecker(std::move(plan)), std::invalid_argument);

  PlanScene two = with_gantry(RobotScene());
  const RobotMotion rest = at_rest(gantry());
  two.scene.add_robot("lift", RobotMotion(rest.model(), detail::given_motions(rest),
                                          Motion::constant_velocity(Pose{}, Vector3d::UnitZ())));
  EXPECT_THROW(EdgeChecker(std::move(two)), std::invalid_argument);

  PlanScene none = with_gantry(RobotScene());
  none.robots = {1};
  EXPECT_THROW(EdgeChecker(std::move(none)), std::invalid_argument);
  EXPECT_THROW(EdgeChecker(with_gantry(RobotScene()), {.tolerance = 0.0}), std::invalid_argument);
  EXPECT_THROW(EdgeChecker(with_gantry(RobotScene()), {.effort = 0}), std::invalid_argument);
}

TEST(ConfigurationSpace, NamesWhatIsNoConfiguration) {
  const PlanScene scene = with_gantry(RobotScene());
  EXPECT_EQ(scene.space.defect({0.0, 0.0, 2.0}), std::nullopt);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Configuration& bad :
       {Configuration{0.0, 0.0}, Configuration{0.0, nan, 0.0}, Configuration{0.0, 0.0, 2.1}}) {
    EXPECT_TRUE(scene.space.defect(bad).has_value());
  }
  EXPECT_NE(scene.space.defect({0.0, 0.0, 2.1}).value().find("\"z\""), std::string::npos);
  const PlanScene bar = with_bar(RobotScene(), {1, 1, 1});
  EXPECT_TRUE(bar.space.defect({0, 0, 0, 0, 0, 0, 0}).has_value());
  const std::vector<std::string> unknown = {"w"};
  EXPECT_THROW((void)ConfigurationSpace::of_joints(gantry(), unknown, {}), std::invalid_argument);
  const std::vector<std::string> twice = {"x", "x"};
  EXPECT_THROW((void)ConfigurationSpace::of_joints(gantry(), twice, {}), std::invalid_argument);
}

// The place that an edge's middle is rounded to lies on the motion that is checked.
TEST(ConfigurationSpace, InterpolatesAlongItsMotion) {
  Random random(4);
  const PlanScene bar = with_bar(RobotScene(), {0.4, 0.1, 0.1});
  const auto pose = [&] {
    const Vector3d p = random.vector(0.0, 1.0);
    const Eigen::Quaterniond r = random.rotation();
    return Configuration{p.x(), p.y(), p.z(), r.w(), r.x(), r.y(), r.z()};
  };
  for (int k = 0; k < 100; ++k) {
    const Configuration from = pose();
    const Configuration to = pose();
    const double share = random.uniform(0.0, 1.0);
    const Configuration middle = bar.space.interpolate(from, to, share);
    const Pose exact = bar.space.motion(from, to).base().pose(share);
    EXPECT_LE((exact.position - Vector3d(middle[0], middle[1], middle[2])).norm(), 1e-15);
    const double whole = bar.space.distance(from, to);
    EXPECT_NEAR(bar.space.distance(from, middle), share * whole, 1e-7);
    EXPECT_EQ(bar.space.interpolate(from, to, 0.0), from);
    EXPECT_EQ(bar.space.interpolate(from, to, 1.0), to);
  }
}

}  // namespace
}  // namespace firstcontact::test
