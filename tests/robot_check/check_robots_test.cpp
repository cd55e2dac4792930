// Checks of robots and bodies: never late, never false, and the laws that answers keep.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/narrowphase/triangle_distance.h>
#include <firstcontact/query/distance.h>
#include <firstcontact/robot_check/check_robots.h>
#include <firstcontact/robot_check/robot_gap.h>
#include <firstcontact/robot_check/touching_links.h>
#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/robot_files/read_urdf.h>

#include "robot/chain_case.h"
#include "robot/planar_arm.h"
#include "support/data_dir.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using oracle::Wide;

constexpr double kBall = 0.1;  // [m]  Radius of obstacles.

Motion at(const Vector3d& place) { return Motion::fixed({place, Eigen::Quaterniond::Identity()}); }

/// An arm of hinges that all move at constant rates, among balls in its plane; some of them move.
struct PlanarCase {
  std::vector<std::array<double, 2>> angles;
  std::vector<std::array<Vector2d, 2>> balls;
  PairRules rules;

  explicit PlanarCase(std::uint64_t seed) {
    Random random(seed);
    const auto bars = 1 + static_cast<std::size_t>(random.uniform(0.0, 5.0));
    for (std::size_t k = 0; k < bars; ++k) {
      const double from = random.uniform(-1.2, 1.2);
      angles.push_back({from, from + random.uniform(-1.0, 1.0)});
    }
    const auto place = [&] { return Vector2d(random.uniform(-4, 4), random.uniform(-4, 4)); };
    for (int k = 0; k < 4; ++k) {
      const Vector2d from = place();
      balls.push_back({from, k < 2 ? from : place()});
    }
    rules = PairRules(random.chance(0.5) ? 0.0 : 0.03);
  }

  [[nodiscard]] RobotScene scene() const {
    RobotScene scene(rules);
    std::vector<CoordinatePath> paths;
    for (const auto& [from, to] : angles) {
      paths.push_back(ramp(from, to));
    }
    scene.add_robot("arm", planar_motion(paths));
    for (std::size_t k = 0; k < balls.size(); ++k) {
      const Vector2d way = balls[k][1] - balls[k][0];
      scene.add_body("ball" + std::to_string(k), make_sphere(kBall),
                     Motion::constant_velocity(
                         {{balls[k][0].x(), balls[k][0].y(), 0.0}, Eigen::Quaterniond::Identity()},
                         Vector3d(way.x(), way.y(), 0.0)));
    }
    return scene;
  }

  /// The least distance over all tested pairs, less the margin, by the arm's own kinematics.
  [[nodiscard]] double gap(double t) const {
    std::vector<double> q;
    for (const auto& [from, to] : angles) {
      q.push_back(from + t * (to - from));
    }
    const std::vector<Vector2d> p = hinges(q);
    const auto ball = [&](std::size_t k) {
      return Vector2d((1 - t) * balls[k][0] + t * balls[k][1]);
    };
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
      for (std::size_t j = i + 2; j + 1 < p.size(); ++j) {
        least = std::min(least, segments_distance(p[i], p[i + 1], p[j], p[j + 1]) - 2 * kBarRadius);
      }
      for (std::size_t k = 0; k < balls.size(); ++k) {
        least = std::min(least, segment_distance(ball(k), p[i], p[i + 1]) - kBarRadius - kBall);
      }
    }
    for (std::size_t k = 2; k < balls.size(); ++k) {
      for (std::size_t other = 0; other < k; ++other) {
        least = std::min(least, (ball(k) - ball(other)).norm() - 2 * kBall);
      }
    }
    return least - *rules.margin({0, 1});
  }
};

/// A bar that passes a ball once in each turn: the angle between them is asin(0.15 / 0.5) then.
RobotScene turning_past_a_ball(double turns) {
  RobotScene scene;
  scene.add_robot("arm", planar_motion({ramp(0.0, 2.0 * std::numbers::pi * turns)}));
  const double angle = 2.0;
  scene.add_body("ball", make_sphere(kBall), at({0.5 * std::cos(angle), 0.5 * std::sin(angle), 0}));
  return scene;
}

TEST(CheckRobots, AgreesWithThePlanarArmInClosedForm) {
  int free = 0;
  int contacts = 0;
  int starts = 0;
  for (std::uint64_t seed = 0; seed < test::rounds(400, 80); ++seed) {
    const PlanarCase c(seed);
    const SceneResult result = check_robots(c.scene());
    ASSERT_NE(result.verdict, Verdict::undecided) << seed;
    free += result.verdict == Verdict::free ? 1 : 0;
    contacts += result.verdict == Verdict::contact ? 1 : 0;
    starts += result.verdict == Verdict::contact_at_start ? 1 : 0;
    constexpr int kSamples = 500;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = static_cast<double>(i) / kSamples;
      if (result.verdict == Verdict::free || t < result.t) {
        ASSERT_GT(c.gap(t), -1e-12) << seed << " at " << t;
      }
    }
    if (is_contact(result.verdict)) {
      ASSERT_LE(c.gap(result.t), result.tolerance_used + 1e-12) << seed;
      ASSERT_EQ(result.t_upper, result.t);
      ASSERT_FALSE(result.pairs.empty());
      const PairAnswer& pair = result.pairs.at(result.first.value());
      ASSERT_FALSE(pair.contacts.empty()) << seed;
      const Contact& contact = pair.contacts[0];
      ASSERT_NEAR((contact.p_WB - contact.p_WA).norm(), std::abs(contact.distance), 1e-9) << seed;
    } else {
      ASSERT_EQ(result.t, 1.0);
      ASSERT_FALSE(result.first.has_value());
    }
  }
  EXPECT_GE(free, test::rounds(40, 8));
  EXPECT_GE(contacts, test::rounds(100, 20));
  EXPECT_GE(starts, test::rounds(20, 4));
}

/// Contact points lie on the members, in the world.
TEST(CheckRobots, PointsAreInTheWorld) {
  RobotScene scene;
  const double quarter = 0.5 * std::numbers::pi;
  const Motion base = at({10.0, 20.0, 30.0});
  // The tip of the third bar comes down on the first one, at its middle.
  scene.add_robot(
      "arm", planar_motion({CoordinatePath::constant(0.0), CoordinatePath::constant(1.2 * quarter),
                            ramp(quarter, 2.0 * quarter)},
                           base));
  const SceneResult result = check_robots(scene);
  ASSERT_EQ(result.verdict, Verdict::contact);
  ASSERT_EQ(result.pairs.size(), 1u);
  EXPECT_EQ(result.pairs[0].members, (BodyPair{1, 3}));
  const Contact& contact = result.pairs[0].contacts.at(0);
  ASSERT_TRUE(contact.n_AB_W.has_value());
  EXPECT_LE((*contact.n_AB_W - Vector3d::UnitY()).norm(), 1e-4);
  // On the upper side of the first bar.
  EXPECT_NEAR(contact.p_WA.y(), 20.0 + kBarRadius, 1e-6);
  EXPECT_NEAR(contact.p_WA.z(), 30.0, 1e-9);
  EXPECT_GT(contact.p_WA.x(), 10.0);
  EXPECT_LT(contact.p_WA.x(), 11.0);
  EXPECT_LT(contact.normal_velocity, 0.0);
}

Mesh small_mesh(Random& random) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(0.15 * random.vector(0.2, 1.0));
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

double meshes_distance(const Mesh& A, const Mesh& B) {
  const auto corners = [](const Mesh& mesh, std::size_t k) {
    const auto& [a, b, c] = mesh.triangles[k];
    return Triangle{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < A.triangles.size(); ++i) {
    for (std::size_t j = 0; j < B.triangles.size(); ++j) {
      least = std::min(least, triangle_distance(corners(A, i), corners(B, j)).distance);
    }
  }
  return least;
}

/// A mesh carried by the tip of a chain of all joints, against one at rest: the oracle of 256 bits
/// has the places.
TEST(CheckRobots, CarriedBodiesFollowTheExactChain) {
  constexpr int kSamples = 30;
  int contacts = 0;
  for (std::uint64_t seed = 0; seed < test::rounds(60, 15); ++seed) {
    const ChainCase c = random_chain(seed, {.joints = 1 + static_cast<int>(seed % 12)});
    const std::size_t tip = c.motion.model().links().size() - 1;
    Random random(seed);
    const Mesh A = small_mesh(random);
    Mesh B = small_mesh(random);
    const double t_near = random.uniform(0.3, 1.0);
    const Vector3d p_WB = c.motion.path(tip, t_near).pose(t_near).p_OL + random.vector(0.0, 0.4);
    RobotScene scene;
    scene.add_robot("r", c.motion);
    const LinkPose start = c.motion.path(tip, 0.0).pose(0.0);
    const std::size_t carried = scene.add_body(
        "carried", Shape(A), Motion::fixed({start.p_OL, Eigen::Quaterniond(start.R_FL)}));
    scene.add_body("rest", Shape(B), at(p_WB));
    scene.attach({.body = carried, .link = tip});
    const auto X_LB = std::get<BodyStretch::Carried>(scene.stretches(carried)[0].how).X_LB;
    for (Vector3d& v : B.vertices) {
      v += p_WB;
    }
    const auto distance_at = [&](double t) {
      Mesh placed = A;
      const auto chain = c.exact(t);
      for (Vector3d& v : placed.vertices) {
        const Vector3d p_LP = X_LB.position + X_LB.rotation.normalized() * v;
        const auto p = oracle::exact_place(chain, Wide(t), exact_point(p_LP));
        v = {p.x.nearest(), p.y.nearest(), p.z.nearest()};
      }
      return meshes_distance(placed, B);
    };
    const SceneResult result = check_robots(scene);
    ASSERT_NE(result.verdict, Verdict::undecided) << seed;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = static_cast<double>(i) / kSamples;
      if (result.verdict == Verdict::free || t < result.t) {
        ASSERT_GT(distance_at(t), 0.0) << seed << " at " << t;
      }
    }
    if (is_contact(result.verdict)) {
      ++contacts;
      ASSERT_LE(distance_at(result.t), result.tolerance_used + 1e-12) << seed;
    }
  }
  EXPECT_GE(contacts, test::rounds(10, 3));
  EXPECT_LE(contacts, 50);
}

/// One checker for many motions, one of which carries a body, answers as a new one for each.
TEST(RobotChecker, AnswersAsIfNewForEveryMotion) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const PlanarCase c(seed);
    RobotScene scene = c.scene();
    const std::size_t carried = scene.add_body("carried", make_sphere(0.2), at({0.0, 0.0, 0.5}));
    scene.attach({.body = carried, .link = *scene.find_member("arm/l0"), .t_from = 0.25});
    RobotChecker checker(scene);
    Random random(seed);
    for (int k = 0; k < 6; ++k) {
      std::vector<CoordinatePath> paths;
      for (std::size_t joint = 0; joint < c.angles.size(); ++joint) {
        paths.push_back(ramp(random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)));
      }
      std::map<std::string, JointMotion> joints;
      for (std::size_t joint = 0; joint < paths.size(); ++joint) {
        joints.emplace("j" + std::to_string(joint), paths[joint]);
      }
      const RobotMotion motion(scene.robot_motion(0).model(), joints);
      checker.set_motion(0, motion);
      scene.set_motion(0, motion);
      const RobotCheckOptions options{.all_pairs = k % 2 == 0};
      const SceneResult result = checker.check(options);
      const SceneResult fresh = check_robots(scene, options);
      ASSERT_EQ(result.verdict, fresh.verdict) << seed;
      ASSERT_EQ(result.t, fresh.t) << seed;
      ASSERT_EQ(result.pairs.size(), fresh.pairs.size()) << seed;
      for (std::size_t pair = 0; pair < result.pairs.size(); ++pair) {
        ASSERT_EQ(result.pairs[pair].members, fresh.pairs[pair].members) << seed;
        ASSERT_EQ(result.pairs[pair].t, fresh.pairs[pair].t) << seed;
      }
    }
  }
}

TEST(RobotChecker, RefusesTheMotionOfAnotherRobot) {
  RobotChecker checker(PlanarCase(0).scene());
  EXPECT_THROW(checker.set_motion(0, planar_motion({ramp(0.0, 1.0)})), std::invalid_argument);
  EXPECT_THROW(checker.set_motion(1, checker.scene().robot_motion(0)), std::invalid_argument);
}

/// The arm reaches over the ball at a height in which only what it carries touches it.
TEST(CheckRobots, ABodyCountsAsCarriedOnlyWhileItIs) {
  const auto check = [](double t_from, double t_to) {
    RobotScene scene;
    scene.add_robot("arm", planar_motion({ramp(0.0, 1.0)}));
    const std::size_t tool = scene.add_body("tool", make_sphere(0.1), at({1.0, 0.0, 0.5}));
    scene.add_body("post", make_sphere(0.1), at({std::cos(0.8), std::sin(0.8), 0.5}));
    scene.attach({.body = tool, .link = 1, .t_from = t_from, .t_to = t_to});
    return check_robots(scene);
  };
  // Two balls of 0.1 on a circle of radius 1 touch at a chord of 0.2.
  const double touch = 0.8 - 2.0 * std::asin(0.1);
  const SceneResult carried = check(0.0, 1.0);
  ASSERT_EQ(carried.verdict, Verdict::contact);
  EXPECT_LE(carried.t, touch);
  EXPECT_NEAR(carried.t, touch, 2e-6);
  // Taken later, it is that much behind, and put down in time.
  const SceneResult late = check(0.25, 1.0);
  ASSERT_EQ(late.verdict, Verdict::contact);
  EXPECT_NEAR(late.t, touch + 0.25, 2e-6);
  EXPECT_EQ(check(0.5, 1.0).verdict, Verdict::free);
  EXPECT_EQ(check(0.0, 0.55).verdict, Verdict::free);
}

TEST(CheckRobots, TheLinkThatHoldsABodyMayTouchIt) {
  const auto scene_with = [](std::vector<std::size_t> touch_links, double t_to) {
    RobotScene scene;
    scene.add_robot("arm", planar_motion({ramp(0.0, 1.0), CoordinatePath::constant(0.0)}));
    // At the joint of both bars.
    const std::size_t ball = scene.add_body("ball", make_sphere(0.1), at({1.0, 0.0, 0.0}));
    scene.attach({.body = ball, .link = 1, .t_to = t_to, .touch_links = std::move(touch_links)});
    return scene;
  };
  EXPECT_EQ(check_robots(scene_with({2}, 1.0)).verdict, Verdict::free);
  const SceneResult touching = check_robots(scene_with({}, 1.0));
  EXPECT_EQ(touching.verdict, Verdict::contact_at_start);
  EXPECT_EQ(touching.pairs.at(0).members, (BodyPair{2, 3}));
  // When it is put down between the bars it is in contact at once, deep inside of a solid or not.
  const SceneResult put_down = check_robots(scene_with({2}, 0.5));
  EXPECT_EQ(put_down.verdict, Verdict::contact);
  EXPECT_EQ(put_down.t, 0.5);
}

/// Nobody looks at a pair while one holds the other: what is inside then is so afterwards.
TEST(CheckRobots, FindsABodyThatIsInsideWhenItIsPutDown) {
  RobotDescription box_bot{.name = "r", .links = {{"base", {}, {}}, {"box", {}, {}}}, .joints = {}};
  box_bot.links[1].collision.push_back(
      {.name = "", .X_LG = {}, .source = {}, .shape = make_box({1, 1, 1})});
  box_bot.joints.push_back(
      {.name = "j", .type = JointType::continuous, .parent = "base", .child = "box"});
  RobotScene scene;
  scene.add_robot("r", {RobotModel(box_bot), {{"j", ramp(0.0, 1.0)}}});
  const std::size_t ball = scene.add_body("ball", make_sphere(0.01));
  scene.attach({.body = ball, .link = 1, .t_from = 0.0, .t_to = 0.625});
  const SceneResult result = check_robots(scene);
  EXPECT_EQ(result.verdict, Verdict::contact);
  EXPECT_EQ(result.t, 0.625);
  RobotCheckOptions options;
  options.all_contacts_in_time = true;
  const SceneResult intervals = check_robots(scene, options);
  ASSERT_EQ(intervals.pairs.size(), 1u);
  ASSERT_EQ(intervals.pairs[0].intervals.size(), 1u);
  EXPECT_EQ(intervals.pairs[0].intervals[0].enter, 0.625);
  EXPECT_EQ(intervals.pairs[0].intervals[0].leave, 1.0);
}

TEST(CheckRobots, BodiesOnOneLinkRestAgainstEachOther) {
  for (const double gap : {0.01, -0.01}) {
    RobotScene scene;
    scene.add_robot("arm", planar_motion({ramp(0.0, 100.0)}));
    const std::size_t one = scene.add_body("one", make_sphere(0.1), at({1.0, 0.0, 2.0}));
    const std::size_t two = scene.add_body("two", make_sphere(0.1), at({1.2 + gap, 0.0, 2.0}));
    scene.attach({.body = one, .link = 1});
    scene.attach({.body = two, .link = 1});
    EXPECT_EQ(check_robots(scene).verdict, gap > 0.0 ? Verdict::free : Verdict::contact_at_start);
  }
}

/// Two robots, one of which carries the other's obstacle on a moving base.
TEST(CheckRobots, RobotsOnMovingBasesMeet) {
  RobotScene scene;
  scene.add_robot("left", planar_motion({CoordinatePath::constant(0.0)}));
  const Motion approach = Motion::constant_velocity(
      {{5.0, 0.0, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Vector3d::UnitZ()))},
      Vector3d(-4.0, 0.0, 0.0));
  scene.add_robot("right", planar_motion({CoordinatePath::constant(0.0)}, approach));
  const SceneResult result = check_robots(scene);
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_LE(result.t, (3.0 - 2 * kBarRadius) / 4.0);
  EXPECT_NEAR(result.t, (3.0 - 2 * kBarRadius) / 4.0, 1e-6);
}

/// Two balls on one link, each in a frame of its own; the outer one comes first.
TEST(CheckRobots, NamesTheGeometryThatTouches) {
  RobotDescription robot{.name = "r", .links = {{"base", {}, {}}, {"arm", {}, {}}}, .joints = {}};
  for (const double x : {1.0, 2.0}) {
    robot.links[1].collision.push_back({.name = "",
                                        .X_LG = {{x, 0.0, 0.0}, Eigen::Quaterniond(1, 2, 3, 4)},
                                        .source = {},
                                        .shape = make_sphere(0.1)});
  }
  Joint joint{.name = "j", .type = JointType::continuous, .parent = "base", .child = "arm"};
  joint.axis = Vector3d::UnitZ();
  robot.joints.push_back(joint);
  RobotScene scene;
  scene.add_robot("r", {RobotModel(robot), {{"j", ramp(0.0, 2.0)}}});
  scene.add_body("near", make_sphere(0.1), at({std::cos(1.5), std::sin(1.5), 0.0}));
  scene.add_body("far", make_sphere(0.1), at({2.0 * std::cos(1.4), 2.0 * std::sin(1.4), 0.0}));
  RobotCheckOptions options;
  options.all_pairs = true;
  const SceneResult result = check_robots(scene, options);
  ASSERT_EQ(result.pairs.size(), 2u);
  const double near_t = (1.5 - 2.0 * std::asin(0.1)) / 2.0;
  const double far_t = (1.4 - 2.0 * std::asin(0.05)) / 2.0;
  EXPECT_NEAR(result.pairs[0].t, near_t, 1e-6);
  EXPECT_NEAR(result.pairs[1].t, far_t, 1e-6);
  EXPECT_EQ(result.pairs[0].contacts.at(0).geometries, (std::array<std::size_t, 2>{0, 0}));
  EXPECT_EQ(result.pairs[1].contacts.at(0).geometries, (std::array<std::size_t, 2>{1, 0}));
  EXPECT_EQ(result.t, std::min(near_t, far_t) == near_t ? result.pairs[0].t : result.pairs[1].t);
}

/// The whole robot against one body by their groups, one link by its own margin.
TEST(CheckRobots, MarginsOfGroupsAndOfPairsHold) {
  RobotScene scene = turning_past_a_ball(0.25);  // Ends 0.43 rad before the ball.
  const double gap = 0.5 * std::sin(2.0 - 0.5 * std::numbers::pi) - kBall - kBarRadius;
  const std::size_t robot = scene.rules().add_group({0, 1});
  const std::size_t others = scene.rules().add_group({2});
  EXPECT_EQ(check_robots(scene).verdict, Verdict::free);
  scene.rules().set_group_margin(robot, others, gap + 1e-3);
  const SceneResult result = check_robots(scene);
  EXPECT_EQ(result.verdict, Verdict::contact);
  EXPECT_EQ(result.pairs.at(0).margin, gap + 1e-3);
  scene.rules().set_margin({1, 2}, gap - 1e-3);
  EXPECT_EQ(check_robots(scene).verdict, Verdict::free);
  scene.rules().set_margin({1, 2}, 1.0);
  EXPECT_EQ(check_robots(scene).verdict, Verdict::contact_at_start);
  scene.rules().ignore_groups(robot, others);
  EXPECT_EQ(check_robots(scene).clearance, std::numeric_limits<double>::infinity());
}

// Laws.

TEST(CheckRobots, PaddingOfBothIsAMarginOfTheirSum) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    PlanarCase c(seed);
    c.rules = PairRules();
    RobotScene padded = c.scene();
    for (std::size_t member = 0; member < padded.size(); ++member) {
      padded.set_padding(member, 0.03125);
    }
    c.rules = PairRules(0.0625);
    const SceneResult result = check_robots(padded);
    const SceneResult same = check_robots(c.scene());
    ASSERT_EQ(result.verdict, same.verdict) << seed;
    ASSERT_EQ(result.t, same.t) << seed;
  }
}

TEST(CheckRobots, FarBodiesChangeNothing) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const PlanarCase c(seed);
    RobotScene more = c.scene();
    more.add_body("moon", make_sphere(10.0),
                  Motion::constant_velocity({{1e3, 0, 0}, Eigen::Quaterniond::Identity()},
                                            Vector3d(0, 100, 0)));
    const SceneResult alone = check_robots(c.scene());
    const SceneResult together = check_robots(more);
    ASSERT_EQ(alone.verdict, together.verdict) << seed;
    ASSERT_EQ(alone.t, together.t) << seed;
    ASSERT_EQ(alone.pairs.size(), together.pairs.size()) << seed;
  }
}

/// Balls before the arm, and in the other order.
TEST(CheckRobots, TheOrderOfMembersDoesNotMatter) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    PlanarCase c(seed);
    const SceneResult result = check_robots(c.scene());
    RobotScene swapped(c.rules);
    const RobotScene scene = c.scene();
    for (std::size_t member = scene.size(); member-- > 0;) {
      if (!scene.robot_link(member)) {
        swapped.add_body(scene.name(member), scene.geometries(member)[0].shape,
                         scene.body_motion(member));
      }
    }
    swapped.add_robot("arm", scene.robot_motion(0));
    const SceneResult same = check_robots(swapped);
    ASSERT_EQ(result.verdict, same.verdict) << seed;
    ASSERT_EQ(result.t, same.t) << seed;
    if (result.first) {
      const auto names = [](const RobotScene& of, const SceneResult& found) {
        const BodyPair& pair = found.pairs[*found.first].members;
        std::array<std::string, 2> both = {of.name(pair[0]), of.name(pair[1])};
        std::sort(both.begin(), both.end());
        return both;
      };
      if (result.pairs.size() == 1) {
        ASSERT_EQ(names(scene, result), names(swapped, same)) << seed;
      }
    }
  }
}

/// The same way in two segments: t is that of the whole, within the tolerance of both answers.
TEST(CheckRobots, ASplitTrajectoryIsTheSame) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const PlanarCase c(seed);
    const RobotScene whole = c.scene();
    RobotScene split(c.rules);
    std::vector<CoordinatePath> paths;
    for (const auto& [from, to] : c.angles) {
      const std::array<double, 3> t = {0.0, 0.375, 1.0};
      const std::array<double, 3> q = {from, from + 0.375 * (to - from), to};
      paths.push_back(CoordinatePath::linear(t, q));
    }
    split.add_robot("arm", planar_motion(paths));
    for (std::size_t member = whole.first_member(0) + c.angles.size() + 1; member < whole.size();
         ++member) {
      split.add_body(whole.name(member), whole.geometries(member)[0].shape,
                     whole.body_motion(member));
    }
    const SceneResult a = check_robots(whole);
    const SceneResult b = check_robots(split);
    ASSERT_EQ(a.verdict == Verdict::free, b.verdict == Verdict::free) << seed;
    if (a.verdict != Verdict::free) {
      ASSERT_LE(c.gap(b.t), b.tolerance_used + 1e-12) << seed;
      ASSERT_NEAR(a.t, b.t, 1e-3) << seed;
    }
  }
}

// Pairs.

TEST(CheckRobots, FindsEveryIntervalOfContact) {
  constexpr int kTurns = 3;
  const RobotScene scene = turning_past_a_ball(kTurns);
  RobotCheckOptions options;
  options.all_contacts_in_time = true;
  options.time_resolution = 1e-4;
  const SceneResult result = check_robots(scene, options);
  ASSERT_EQ(result.pairs.size(), 1u);
  const PairAnswer& pair = result.pairs[0];
  ASSERT_EQ(pair.intervals.size(), static_cast<std::size_t>(kTurns));
  const double half = std::asin((kBall + kBarRadius) / 0.5);
  const double whole = 2.0 * std::numbers::pi;
  for (int k = 0; k < kTurns; ++k) {
    const ContactInterval& interval = pair.intervals[static_cast<std::size_t>(k)];
    const double enter = (2.0 - half + whole * k) / (whole * kTurns);
    const double leave = (2.0 + half + whole * k) / (whole * kTurns);
    EXPECT_EQ(interval.reason, UndecidedReason::none);
    EXPECT_LE(interval.enter, enter);
    EXPECT_NEAR(interval.enter, enter, 1e-6);
    EXPECT_GE(interval.leave, leave);
    EXPECT_NEAR(interval.leave, leave, 1e-6);
  }
  EXPECT_EQ(result.t, pair.intervals[0].enter);
}

/// Samples of random arms outside the intervals of their pair are free. The first entry is the
/// pair's t, nearly that of the first contact alone.
TEST(CheckRobots, OutsideOfIntervalsAllIsFree) {
  RobotCheckOptions options;
  options.all_contacts_in_time = true;
  std::size_t intervals = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const PlanarCase c(seed);
    const SceneResult result = check_robots(c.scene(), options);
    const SceneResult first = check_robots(c.scene());
    ASSERT_EQ(result.verdict, first.verdict) << seed;
    // Searches of other windows end at other times within the tolerance.
    ASSERT_NEAR(result.t, first.t, options.tolerance) << seed;
    for (int i = 0; i <= 1000; ++i) {
      const double t = i / 1000.0;
      bool reported = false;
      for (const PairAnswer& pair : result.pairs) {
        for (const ContactInterval& interval : pair.intervals) {
          reported = reported || (interval.enter <= t && t <= interval.leave);
        }
      }
      ASSERT_TRUE(reported || c.gap(t) > -1e-12) << seed << " at " << t;
      // Longer than any end of an interval is off.
      ASSERT_TRUE(!reported || c.gap(t) < 0.05) << seed << " at " << t;
    }
    for (const PairAnswer& pair : result.pairs) {
      intervals += pair.intervals.size();
      ASSERT_EQ(pair.verdict == Verdict::free, pair.intervals.empty());
      if (!pair.intervals.empty()) {
        ASSERT_EQ(pair.t, pair.intervals[0].enter);
      }
    }
  }
  EXPECT_GE(intervals, 60u);
}

TEST(CheckRobots, FindsTheLeastClearanceInClosedForm) {
  RobotScene scene;
  // Cubic: at rest at the ends, and past the ball at some time between.
  const std::array<double, 2> q = {0.0, 2.0};
  const std::array<double, 2> v = {0.0, 0.0};
  scene.add_robot("arm", planar_motion({CoordinatePath::cubic(kStep, q, v)}));
  const double angle = 1.3;
  const std::size_t ball = scene.add_body("ball", make_sphere(kBall),
                                          at({1.5 * std::cos(angle), 1.5 * std::sin(angle), 0.0}));
  scene.set_padding(ball, 0.1);  // Does not count.
  RobotCheckOptions options;
  options.closest = true;
  const SceneResult result = check_robots(scene, options);
  EXPECT_EQ(result.verdict, Verdict::free);
  ASSERT_EQ(result.pairs.size(), 1u);
  EXPECT_EQ(result.closest, 0u);
  const ClosestApproach& found = result.pairs[0].closest.value();
  const double truth = 0.5 - kBall - kBarRadius;
  EXPECT_EQ(found.reason, UndecidedReason::none);
  EXPECT_LE(found.lower_bound, truth);
  EXPECT_GE(found.distance, truth - 1e-12);
  EXPECT_LE(found.distance - found.lower_bound, options.tolerance);
  EXPECT_NEAR(3.0 * found.t * found.t - 2.0 * found.t * found.t * found.t, angle / 2.0, 1e-3);
  EXPECT_EQ(result.clearance, found.lower_bound);
}

TEST(CheckRobots, LeastClearancesHoldForSamples) {
  RobotCheckOptions options;
  options.closest = true;
  for (const bool of_each : {false, true}) {
    options.all_pairs = of_each;
    for (std::uint64_t seed = 0; seed < test::rounds(25, 6); ++seed) {
      const PlanarCase c(seed);
      const SceneResult result = check_robots(c.scene(), options);
      double sampled = std::numeric_limits<double>::infinity();
      for (int i = 0; i <= 2000; ++i) {
        sampled = std::min(sampled, c.gap(i / 2000.0) + *c.rules.margin({0, 1}));
      }
      double lower = std::numeric_limits<double>::infinity();
      double upper = std::numeric_limits<double>::infinity();
      for (const PairAnswer& pair : result.pairs) {
        ASSERT_TRUE(pair.closest || !of_each) << seed;
        if (pair.closest) {
          ASSERT_EQ(pair.closest->reason, UndecidedReason::none) << seed;
          lower = std::min(lower, pair.closest->lower_bound);
          upper = std::min(upper, pair.closest->distance);
        }
      }
      ASSERT_LE(lower, std::max(sampled, 0.0) + 1e-12) << seed;
      ASSERT_LE(upper - lower, options.tolerance) << seed;
      ASSERT_GE(upper, std::max(sampled, 0.0) - 0.01) << seed;
    }
  }
}

/// The closest features are where and as far apart as it says.
void expect_closest_features(const RobotScene& scene, const PairAnswer& pair) {
  const ClosestApproach& least = pair.closest.value();
  const Contact& closest = least.closest.value();
  EXPECT_NEAR(std::max(closest.distance, 0.0), least.distance, 1e-12);
  EXPECT_NEAR((closest.p_WA - closest.p_WB).norm(), std::abs(closest.distance), 1e-12);
  const std::array<Vector3d, 2> points = {closest.p_WA, closest.p_WB};
  for (std::size_t k = 0; k < 2; ++k) {
    const Pose X_WM = scene.pose(pair.members[k], least.t);
    double outside = std::numeric_limits<double>::infinity();
    for (const MemberGeometry& geometry : scene.geometries(pair.members[k])) {
      const Motion place = Motion::fixed({X_WM.position + X_WM.rotation * geometry.X_MG.position,
                                          X_WM.rotation * geometry.X_MG.rotation});
      const Motion point = Motion::fixed({points[k], Eigen::Quaterniond::Identity()});
      Workspace workspace;
      outside = std::min(
          outside,
          distance({geometry.shape, place}, {make_sphere(1e-9), point}, 0.0, workspace).distance);
    }
    EXPECT_LT(outside, 1e-8);
  }
}

TEST(CheckRobots, TheLeastClearanceOfAllIsTheLeastOfThoseOfEachPair) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const PlanarCase c(seed);
    const RobotScene scene = c.scene();
    const SceneResult of_all = check_robots(scene, {.closest = true});
    const SceneResult of_each = check_robots(scene, {.all_pairs = true, .closest = true});
    ASSERT_TRUE(of_all.closest && of_each.closest) << seed;
    const PairAnswer& found = of_all.pairs[*of_all.closest];
    const ClosestApproach& least = found.closest.value();
    const ClosestApproach& expected = of_each.pairs[*of_each.closest].closest.value();
    ASSERT_EQ(least.reason, UndecidedReason::none) << seed;
    ASSERT_NEAR(least.distance, expected.distance, 1e-6) << seed;
    ASSERT_LE(least.distance - least.lower_bound, 1e-6) << seed;
    ASSERT_GE(of_all.clearance, least.lower_bound) << seed;
    expect_closest_features(scene, found);
    // The verdict is that of a check without it; of the closest pair it is for the whole step.
    ASSERT_EQ(of_all.verdict, of_each.verdict) << seed;
    ASSERT_EQ(of_all.t, check_robots(scene).t) << seed;
    for (const PairAnswer& pair : of_each.pairs) {
      if (pair.members == found.members) {
        ASSERT_EQ(found.verdict, pair.verdict) << seed;
        // Each time is proven; two ways to it differ by the tolerance over the speed.
        ASSERT_NEAR(found.t, pair.t, 1e-6) << seed;
        ASSERT_EQ(found.contacts.size(), pair.contacts.size()) << seed;
      }
    }
    const std::vector<double> times = {0.0, 0.25, 0.5, 0.75, 1.0, least.t};
    for (const RobotGap& gap : robot_gaps(scene, times)) {
      ASSERT_LE(least.lower_bound, gap.distance + 1e-12) << seed;
    }
    ASSERT_NEAR(robot_gaps(scene, times).back().distance, least.distance, 1e-12) << seed;
  }
}

TEST(CheckRobots, ALeastClearanceThatWasNotLookedForClaimsNothing) {
  const RobotScene scene = turning_past_a_ball(1.0);
  RobotCheckOptions late{.closest = true};
  late.budget.deadline = std::chrono::steady_clock::now();
  const SceneResult result = check_robots(scene, late);
  ASSERT_TRUE(result.closest);
  const ClosestApproach& least = result.pairs[*result.closest].closest.value();
  EXPECT_EQ(least.reason, UndecidedReason::deadline);
  EXPECT_EQ(least.lower_bound, 0.0);
  EXPECT_FALSE(least.closest);
}

TEST(CheckRobots, EachPairAnswersAsIfAlone) {
  RobotCheckOptions options;
  options.all_pairs = true;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const PlanarCase c(seed);
    const RobotScene scene = c.scene();
    const SceneResult all = check_robots(scene, options);
    for (const PairAnswer& pair : all.pairs) {
      RobotScene alone = c.scene();
      for (std::size_t a = 0; a < scene.size(); ++a) {
        for (std::size_t b = a + 1; b < scene.size(); ++b) {
          if (BodyPair{a, b} != pair.members) {
            alone.rules().ignore({a, b});
          }
        }
      }
      const SceneResult result = check_robots(alone);
      ASSERT_EQ(result.verdict, pair.verdict) << seed;
      ASSERT_NEAR(result.t, pair.t, 1e-9) << seed;
    }
  }
}

// Ties.

/// A round tool that comes down flat on a round post and turns about its axis: all triangles of the
/// two caps touch at one time, of which some motions say that it is the end of a window.
TEST(CheckRobots, OpensFewOfTheManyTrianglesThatTouchAtOnce) {
  constexpr double kLength = 0.2;
  RobotDescription lift{.name = "lift", .links = {{"base"}, {"slide"}, {"tool"}}, .joints = {}};
  lift.links[2].collision.push_back(
      {.name = "", .X_LG = {}, .source = SphereGeometry{}, .shape = make_cylinder(0.05, kLength)});
  lift.joints = {
      {.name = "z", .type = JointType::prismatic, .parent = "base", .child = "slide"},
      {.name = "turn", .type = JointType::continuous, .parent = "slide", .child = "tool"}};
  lift.joints[0].axis = lift.joints[1].axis = Vector3d::UnitZ();
  const RobotModel model(lift);
  for (const double turn : {0.0, 0.3, 3.0, 30.0}) {
    for (const double end : {0.1, 0.07}) {
      RobotScene scene;
      scene.add_body("post", make_cylinder(0.05, kLength), Motion::fixed());
      scene.add_robot("lift",
                      RobotMotion(model, {{"z", ramp(0.5, end)}, {"turn", ramp(0.0, turn)}}));
      const SceneResult result = check_robots(scene, {.contacts = ContactState::first});
      ASSERT_EQ(result.verdict, Verdict::contact);
      const double truth = (0.5 - kLength) / (0.5 - end);
      EXPECT_LE(result.t, truth);
      EXPECT_GE(result.t, truth - 1e-5);
      EXPECT_LT(result.work.total(), 12'000u)
          << turn << ' ' << end;  // There are 100,000 pairs of triangles.
    }
  }
}

// Lists of contacts.

/// A flat plate of cells of 1 cm, across z.
Shape plate(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      mesh.vertices.emplace_back(0.01 * i, 0.01 * j, 0.0);
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t k = i * (n + 1) + j;
      mesh.triangles.push_back({k, k + n + 1, k + 1});
      mesh.triangles.push_back({k + 1, k + n + 1, k + n + 2});
    }
  }
  return Shape(std::move(mesh));
}

/// A slide of two plates that begins near a plate at rest, whichever of the two is added first.
RobotScene slide_of_plates(bool robot_first) {
  RobotDescription slide{.name = "slide", .links = {{"rail"}, {"shoe"}}, .joints = {}};
  for (const double y : {0.0, 0.12}) {
    slide.links[1].collision.push_back({.name = "",
                                        .X_LG = {{0.0, y, 0.02}, Eigen::Quaterniond::Identity()},
                                        .source = SphereGeometry{},
                                        .shape = plate(9)});
  }
  slide.joints.push_back(
      {.name = "x", .type = JointType::prismatic, .parent = "rail", .child = "shoe"});
  RobotScene scene(PairRules(0.05));
  const auto add_robot = [&] { scene.add_robot("slide", at_rest(RobotModel(slide))); };
  if (robot_first) {
    add_robot();
  }
  scene.add_body("plate", plate(20), at(Vector3d::Zero()));
  if (!robot_first) {
    add_robot();
  }
  return scene;
}

TEST(CheckRobots, ListsNoMoreContactsOfAPairThanAreAskedFor) {
  const RobotScene scene = slide_of_plates(false);
  const PairAnswer all = check_robots(scene, {.contacts = ContactState::all}).pairs.at(0);
  ASSERT_EQ(all.verdict, Verdict::contact_at_start);
  EXPECT_TRUE(all.contact_count.is_exact);
  EXPECT_EQ(all.contact_count.at_least, all.contacts.size());
  ASSERT_GT(all.contacts.size(), 2000u);
  double least = std::numeric_limits<double>::infinity();
  for (const Contact& found : all.contacts) {
    least = std::min(least, found.distance);
  }
  for (const std::size_t most : {1u, 2u, 30u, 1000u}) {
    const PairAnswer some =
        check_robots(scene, {.contacts = ContactState::nearest(most)}).pairs.at(0);
    ASSERT_EQ(some.contacts.size(), most);
    EXPECT_EQ(some.contact_count.at_least, all.contacts.size());
    EXPECT_TRUE(some.contact_count.is_exact);
    double least_of_some = std::numeric_limits<double>::infinity();
    std::array<std::size_t, 2> of_geometry = {};
    for (const Contact& found : some.contacts) {
      least_of_some = std::min(least_of_some, found.distance);
      ++of_geometry.at(found.geometries[1]);
    }
    EXPECT_EQ(least_of_some, least);
    if (most >= 30) {  // Both plates of the slide are near.
      EXPECT_GT(std::min(of_geometry[0], of_geometry[1]), 0u) << most;
    }
  }
}

TEST(CheckRobots, ListsTheSameContactsWhicheverMemberIsFirst) {
  for (const std::size_t most : {3u, 50u}) {
    const RobotCheckOptions options{.contacts = ContactState::nearest(most)};
    const PairAnswer one = check_robots(slide_of_plates(false), options).pairs.at(0);
    const PairAnswer other = check_robots(slide_of_plates(true), options).pairs.at(0);
    const auto keys = [](const PairAnswer& pair, bool swapped) {
      std::vector<std::array<double, 4>> all;
      for (Contact found : pair.contacts) {
        if (swapped) {
          swap_bodies(found);
        }
        all.push_back({static_cast<double>(found.geometries[1]),
                       static_cast<double>(found.feature_A.index),
                       static_cast<double>(found.feature_B.index), found.distance});
      }
      std::sort(all.begin(), all.end());
      return all;
    };
    EXPECT_EQ(one.contact_count.at_least, other.contact_count.at_least);
    EXPECT_EQ(keys(one, false), keys(other, true)) << most;
  }
}

// Ends before the end.

TEST(CheckRobots, AStopOrADeadlineEndsWithWhatIsProven) {
  const RobotScene scene = turning_past_a_ball(1.0);
  std::stop_source source;
  source.request_stop();
  RobotCheckOptions stopped;
  stopped.budget.stop = source.get_token();
  RobotCheckOptions late;
  late.budget.deadline = std::chrono::steady_clock::now();
  for (RobotCheckOptions options : {stopped, late}) {
    for (const bool all : {false, true}) {
      options.all_contacts_in_time = all;
      options.closest = all;
      const SceneResult result = check_robots(scene, options);
      EXPECT_EQ(result.verdict, Verdict::undecided);
      EXPECT_EQ(result.reason,
                options.budget.deadline ? UndecidedReason::deadline : UndecidedReason::cancelled);
      EXPECT_EQ(result.t, 0.0);
      ASSERT_EQ(result.pairs.size(), 1u);
      if (all) {
        ASSERT_EQ(result.pairs[0].intervals.size(), 1u);
        EXPECT_NE(result.pairs[0].intervals[0].reason, UndecidedReason::none);
        EXPECT_EQ(result.pairs[0].closest->lower_bound, 0.0);
      }
    }
  }
}

TEST(CheckRobots, SpentStepsAreUndecidedAndNeverLate) {
  const RobotScene scene = turning_past_a_ball(1.0);
  const SceneResult full = check_robots(scene);
  int undecided = 0;
  for (std::uint64_t steps = 0; steps < 40; ++steps) {
    RobotCheckOptions options;
    options.budget.steps = steps;
    const SceneResult result = check_robots(scene, options);
    ASSERT_LE(result.t, full.t);
    if (result.verdict == Verdict::undecided) {
      ++undecided;
      ASSERT_EQ(result.reason, UndecidedReason::work);
    } else {
      ASSERT_EQ(result.t, full.t);
    }
  }
  EXPECT_GE(undecided, 1);
  EXPECT_LE(undecided, 39);
}

TEST(CheckRobots, RefusesOptionsOutOfRange) {
  const RobotScene scene = turning_past_a_ball(1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, nan, infinity}) {
    RobotCheckOptions options;
    options.tolerance = bad;
    EXPECT_THROW(static_cast<void>(check_robots(scene, options)), std::invalid_argument);
    options.tolerance = 1e-6;
    options.time_resolution = bad;
    EXPECT_THROW(static_cast<void>(check_robots(scene, options)), std::invalid_argument);
  }
}

TEST(CheckRobots, NothingToTestIsFree) {
  const SceneResult empty = check_robots(RobotScene());
  EXPECT_EQ(empty.verdict, Verdict::free);
  EXPECT_EQ(empty.t, 1.0);
  EXPECT_EQ(empty.clearance, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(empty.pairs.empty());
}

/// Real meshes of a robot on a turning base, among boxes: each pair is apart at samples before its
/// time, by the places that the scene gives, and touches then.
TEST(CheckRobots, ThePumaAgreesWithDistancesAtSingleTimes) {
  const RobotModel puma = read_urdf(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                                    "data/robots/puma560_description/urdf/puma560_robot.urdf");
  Workspace workspace;
  RobotCheckOptions options;
  options.all_pairs = true;
  int contacts = 0;
  int free = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Random random(seed);
    std::map<std::string, JointMotion> joints;
    for (const Joint& joint : puma.joints()) {
      if (joint.type != JointType::fixed) {
        const double q = random.uniform(-1.5, 1.5);
        joints.emplace(joint.name, ramp(q, q + random.uniform(-1.0, 1.0)));
      }
    }
    RobotScene scene;
    scene.add_robot(
        "puma", {puma, joints, Motion::constant_velocity({}, {0.1, 0.2, 0.0}, {0.0, 0.0, 0.3})});
    for (int k = 0; k < 3; ++k) {
      const Vector3d place = Vector3d(0, 0, 0.5) + 0.7 * random.direction();
      scene.add_body("box" + std::to_string(k), make_box({0.1, 0.15, 0.2}),
                     Motion::constant_velocity({place, random.rotation()}, 0.2 * random.direction(),
                                               random.direction()));
    }
    const auto distance_at = [&](const BodyPair& members, double t) {
      double least = std::numeric_limits<double>::infinity();
      for (const MemberGeometry& a : scene.geometries(members[0])) {
        for (const MemberGeometry& b : scene.geometries(members[1])) {
          const auto placed = [&](std::size_t member, const MemberGeometry& geometry) {
            const Pose X_WM = scene.pose(member, t);
            return Motion::fixed({X_WM.position + X_WM.rotation * geometry.X_MG.position,
                                  X_WM.rotation * geometry.X_MG.rotation});
          };
          const Motion X_WA = placed(members[0], a);
          const Motion X_WB = placed(members[1], b);
          least =
              std::min(least, distance({a.shape, X_WA}, {b.shape, X_WB}, 0.0, workspace).distance);
        }
      }
      return least;
    };
    const SceneResult result = check_robots(scene, options);
    for (const PairAnswer& pair : result.pairs) {
      ASSERT_NE(pair.verdict, Verdict::undecided) << seed;
      const bool is_free = pair.verdict == Verdict::free;
      (is_free ? free : contacts) += 1;
      for (int i = 0; i <= 12; i += rounds(1, 4)) {
        const double t = i / 12.0;
        if (is_free || t < pair.t) {
          ASSERT_GT(distance_at(pair.members, t), 0.0) << seed << " at " << t;
        }
      }
      if (!is_free) {
        ASSERT_LE(distance_at(pair.members, pair.t), pair.tolerance_used + 1e-12) << seed;
      }
    }
  }
  EXPECT_GE(contacts, 5);
  EXPECT_GE(free, 50);
}

/// All coordinates 0 are outside of the Panda's limits: the arm is folded into itself.
TEST(CheckRobots, ThePandaFoldedUpTouchesItself) {
  const std::filesystem::path data = data_dir();
  if (data.empty()) {
    GTEST_SKIP() << "needs FIRSTCONTACT_DATA_DIR";
  }
  const std::filesystem::path folder = data / "robots/moveit_resources_panda_description";
  const RobotModel panda = read_urdf(folder / "urdf/panda.urdf");
  const RobotSemantics semantics = read_srdf(folder / "srdf/panda.srdf", panda);
  const auto check = [&](double elbow, double wrist) {
    std::map<std::string, JointMotion> joints;
    for (const Joint& joint : panda.joints()) {
      const double q = joint.name == "panda_joint4"   ? elbow
                       : joint.name == "panda_joint6" ? wrist
                                                      : 0.0;
      if (joint.type != JointType::fixed && !joint.mimic) {
        joints.emplace(joint.name, ramp(q, q + (joint.name == "panda_joint1" ? 1.0 : 0.0)));
      }
    }
    RobotScene scene;
    scene.add_robot("panda", {panda, joints}, semantics.disabled);
    RobotCheckOptions options;
    options.all_pairs = true;
    const SceneResult result = check_robots(scene, options);
    std::vector<std::string> names;
    for (const PairAnswer& pair : result.pairs) {
      if (pair.verdict != Verdict::free) {
        EXPECT_EQ(pair.verdict, Verdict::contact_at_start);
        names.push_back(scene.name(pair.members[0]) + " " + scene.name(pair.members[1]));
      }
    }
    return names;
  };
  const std::vector<std::string> folded = check(0.0, 0.0);
  const auto has = [&](const char* pair) {
    return std::find(folded.begin(), folded.end(), pair) != folded.end();
  };
  EXPECT_TRUE(has("panda/panda_link5 panda/panda_hand"));
  EXPECT_TRUE(has("panda/panda_link5 panda/panda_link7"));
  EXPECT_TRUE(check(-1.5, 1.5).empty());
}

TEST(CheckRobots, FarFromTheOriginNothingIsLost) {
  const Vector3d far(1e7, -2e7, 3e6);
  RobotScene scene;
  scene.add_robot("arm", planar_motion({ramp(0.0, 2.0)}, at(far)));
  const double angle = 1.25;
  scene.add_body("ball", make_sphere(kBall),
                 at(far + Vector3d(0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0)));
  const SceneResult result = check_robots(scene);
  ASSERT_EQ(result.verdict, Verdict::contact);
  EXPECT_NEAR(result.t, (angle - std::asin(0.3)) / 2.0, 1e-6);
}

}  // namespace
}  // namespace firstcontact::test
