// God-objects follow their devices, and pass through nothing.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/query/first_contact.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kMillisecond = 1e-3;  // [s]

Pose at(const Vector3d& position, const Eigen::Vector3d& rotation_vector = Vector3d::Zero()) {
  const double angle = rotation_vector.norm();
  return {position, angle > 0.0
                        ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle))
                        : Eigen::Quaterniond::Identity()};
}

/// Runs cycles towards a target.
void run_to(ContactLoop& loop, const Pose& target, int cycles) {
  for (int k = 0; k < cycles; ++k) {
    (void)loop.advance(std::array{target}, kMillisecond, k);
  }
}

/// Proves again what a cycle did: each piece of the tool, apart from bodies at rest.
void require_free(const HapticScene& scene, const HapticCycle& cycle, Workspace& workspace) {
  for (const HapticMemberMotion& motion : cycle.members) {
    const HapticTool& tool = scene.tools.at(motion.member);
    for (const HapticPiece& piece : motion.pieces) {
      const ConstantRatePiece way{.X_WB = piece.X_WB,
                                  .translation = piece.translation,
                                  .rotation_vector = piece.rotation_vector};
      const Motion X_WB = Motion::constant_rates(std::span(&way, 1), tool.p_BC);
      for (const HapticBody& body : scene.bodies) {
        const Motion rests = Motion::fixed(body.X_WB);
        const FirstContactResult found =
            first_contact({body.shape, rests}, {tool.shape, X_WB}, workspace,
                          {.margin = 0.9 * cycle.clearance, .tolerance = 0.05 * cycle.clearance});
        ASSERT_EQ(found.verdict, Verdict::free) << body.name << ", " << cycle.clearance;
      }
    }
  }
}

TEST(ContactLoop, GoesToATargetThatIsFree) {
  ContactLoop loop(cube_on_floor());
  const Pose target = at({0.1, 0.05, 0.2}, {0.3, -0.2, 1.0});
  run_to(loop, target, 1);
  EXPECT_LT((loop.pose(0).position - target.position).norm(), 1e-12);
  EXPECT_LT(loop.pose(0).rotation.angularDistance(target.rotation), 1e-12);
  EXPECT_EQ(loop.contact_set().count, 0U);
}

TEST(ContactLoop, RestsOnTheFloorWithinTheContactDistance) {
  ContactLoop loop(cube_on_floor());
  run_to(loop, at({0.05, 0.0, -0.1}), 5);
  const double gap = loop.pose(0).position.z() - 0.02;
  EXPECT_GE(gap, loop.contact_distance() * (1.0 - 1e-6));
  EXPECT_LE(gap, 1.5 * loop.contact_distance());
  EXPECT_NEAR(loop.pose(0).position.x(), 0.05, 1e-6);  // Nothing holds it back along the floor.
  EXPECT_EQ(loop.contact_set().count, 4U);
  EXPECT_EQ(loop.contact_set().checksum, checksum_of(loop.contact_set()));
}

/// A needle that is turned while it is pressed flat onto a plate: its ends touch in turn.
TEST(ContactLoop, KeepsItsDistanceWhereATurningToolIsPressedFlat) {
  HapticScene scene;
  HapticTool needle{.name = "needle", .shape = make_box({0.004, 0.004, 0.06})};
  needle.X_WB = {
      {-0.02185532282036204, 0.0016936230754722853, 0.0033340978943821368},
      {0.712615073457925, 0.41349458235302994, -0.566313789112016, 0.022151291313163696}};
  scene.tools = {needle};
  scene.bodies = {{.name = "plate", .shape = make_box({0.4, 0.4, 0.0001})}};
  const Vector3d turn(-0.743013, 1.0734, 0.0475759);
  for (int k = 0; k < 8; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 8.0;
    const Eigen::Vector3d push(0.003 * std::cos(angle), 0.003 * std::sin(angle), -0.0457);
    const double more = 0.5 + 0.25 * k;
    ContactLoop loop(scene);
    const Pose target{needle.X_WB.position + push,
                      Eigen::Quaterniond(Eigen::AngleAxisd(more * turn.norm(), turn.normalized())) *
                          needle.X_WB.rotation.normalized()};
    for (int cycle = 0; cycle < 300; ++cycle) {
      const HapticCycle& done = loop.advance(std::array{target}, kMillisecond, cycle);
      ASSERT_GE(done.clearance, 0.3 * loop.contact_distance()) << k << ", cycle " << cycle;
    }
  }
}

// 5 m/s through a plate of 0.1 mm, at a thousand cycles a second: 5 mm a cycle.
TEST(ContactLoop, StopsAtAThinPlateHoweverFast) {
  HapticScene scene;
  scene.tools.push_back(tool_at("ball", make_sphere(0.01), {0.0, 0.0, 0.05}));
  scene.bodies.push_back(body_at("plate", make_box({0.2, 0.2, 1e-4}), Vector3d::Zero()));
  ContactLoop loop(scene);
  Workspace workspace;
  for (int k = 0; k < 40; ++k) {
    const Pose target = at({0.0, 0.0, 0.05 - 5.0 * kMillisecond * k});
    const HapticCycle& cycle = loop.advance(std::array{target}, kMillisecond, k);
    require_free(scene, cycle, workspace);
    ASSERT_GT(loop.pose(0).position.z(), 0.01);
  }
  EXPECT_NEAR(loop.pose(0).position.z(), 0.01 + 5e-5, 2.0 * loop.contact_distance());
}

TEST(ContactLoop, StaysOnItsSideWhenTheDeviceJumpsAMetre) {
  HapticScene scene = cube_on_floor();
  ContactLoop loop(scene);
  run_to(loop, at({0.0, 0.0, -1.0}), 1);
  EXPECT_GT(loop.pose(0).position.z(), 0.02);
  run_to(loop, at({0.0, 0.0, 1.0}), 1);
  EXPECT_NEAR(loop.pose(0).position.z(), 1.0, 1e-12);
}

TEST(ContactLoop, NeverPassesWhileADeviceRagesAround) {
  HapticScene scene = peg_over_hole(1e-4);
  ContactLoop loop(scene);
  Workspace workspace;
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 60; ++k) {
    const Vector3d goal(0.03 * normal(rng), 0.03 * normal(rng), 0.04 * normal(rng));
    const Vector3d turn(normal(rng), normal(rng), normal(rng));
    const HapticCycle& cycle = loop.advance(std::array{at(goal, turn)}, kMillisecond, k);
    ASSERT_GT(cycle.clearance, 0.0);
    ASSERT_EQ(cycle.lasted, kMillisecond);
    require_free(scene, cycle, workspace);
  }
}

// A hand that is off by half a millimetre and two degrees finds the hole by the wall's help.
TEST(ContactLoop, LetsAPegIntoItsHole) {
  for (const double clearance : {1e-4, 2e-5}) {
    ContactLoop loop(peg_over_hole(clearance));
    for (int k = 0; k < 400; ++k) {
      const double depth = 0.04 - 0.07 * k / 400.0;
      const double sway = 3e-4 * std::sin(0.3 * k);
      const Pose target = at({0.5 * clearance + (k < 200 ? 0.0 : sway), 0.0, depth},
                             {k < 200 ? 0.0 : 0.01 * std::sin(0.17 * k), 0.0, 0.0});
      (void)loop.advance(std::array{target}, kMillisecond, k);
    }
    EXPECT_LT(loop.pose(0).position.z(), -0.02) << clearance;
  }
}

// On a slope of 20 degrees, held by a friction whose angle is 22 degrees.
// A cube that is dragged across a corner of the floor turns about it: each round gains less.
TEST(ContactLoop, LeavesSmallGainsToTheNextCycle) {
  const auto rounds_of = [](double least_gain) {
    HapticScene scene = cube_on_floor();
    scene.tools[0].shape = make_ellipsoid({0.03, 0.02, 0.01}).as_triangles();
    ContactLoop loop(scene, {.rounds = 60, .least_gain = least_gain});
    const Pose target = at({0.02, 0.01, -0.03}, {0.4, 0.3, 0.0});
    std::vector<std::size_t> rounds;
    for (int k = 0; k < 40; ++k) {
      rounds.push_back(loop.advance(std::array{target}, kMillisecond, k).rounds);
    }
    return std::pair(rounds, loop.pose(0).position);
  };
  const auto [all, there] = rounds_of(0.0);
  const auto [few, near] = rounds_of(1e-3);
  EXPECT_GT(all[0], few[0] + 3);
  EXPECT_EQ(few.back(), 1U);  // The later cycles made the rest.
  EXPECT_LT((near - there).norm(), 1e-6);
}

TEST(ContactLoop, DoesNotCreepWhereFrictionHolds) {
  const double slope = 20.0 * std::numbers::pi / 180.0;
  HapticScene scene = cube_on_floor(std::tan(22.0 * std::numbers::pi / 180.0));
  ContactLoop loop(scene);
  // The pull of the spring is what leans: into the floor, and along it.
  run_to(loop, at({0.0, 0.0, 0.019}), 20);
  const Vector3d pull(1e-3 * std::sin(slope), 0.0, -1e-3 * std::cos(slope));
  const Pose target = at(loop.pose(0).position + pull);
  run_to(loop, target, 20);
  const Vector3d held = loop.pose(0).position;
  EXPECT_LT((held - target.position + pull).head<2>().norm(), 2e-6);
  run_to(loop, target, 60'000);  // A minute.
  EXPECT_EQ((loop.pose(0).position - held).norm(), 0.0);
}

TEST(ContactLoop, SlidesWhereFrictionDoesNotHold) {
  const double slope = 30.0 * std::numbers::pi / 180.0;
  const double mu = 0.3;
  ContactLoop loop(cube_on_floor(mu));
  run_to(loop, at({0.0, 0.0, 0.02}), 20);
  const Vector3d from = loop.pose(0).position;
  const double pull = 5e-3;
  const Pose target = at(from + Vector3d(pull * std::sin(slope), 0.0, -pull * std::cos(slope)));
  run_to(loop, target, 50);
  // It ends where the spring is at the edge of the cone.
  const Vector3d left = target.position - loop.pose(0).position;
  EXPECT_NEAR(left.x() / -left.z(), mu, 0.02);
}

TEST(ContactLoop, IsPushedByWhatMoves) {
  HapticScene scene;
  scene.tools.push_back(tool_at("ball", make_sphere(0.01), {0.0, 0.0, 0.0}));
  HapticBody pusher = body_at("pusher", make_box({0.02, 0.1, 0.1}), {-0.05, 0.0, 0.0});
  pusher.course = Motion::constant_velocity(pusher.X_WB, Vector3d(0.2, 0.0, 0.0));
  scene.bodies.push_back(pusher);
  scene.duration = 0.2;
  ContactLoop loop(scene);
  for (int k = 0; k < 200; ++k) {
    const HapticCycle& cycle = loop.advance(std::array{at(Vector3d::Zero())}, kMillisecond, k);
    ASSERT_NEAR(cycle.lasted, kMillisecond, 1e-15) << k;
    EXPECT_TRUE(cycle.is_converged) << k;
  }
  EXPECT_NEAR(loop.pose(0).position.x(), -0.05 + 0.2 + 0.01 + 0.01, 1e-4);
  EXPECT_NEAR(loop.time(), 0.2, 1e-12);
}

// Between a wall and a pusher there is an end: the pusher waits.
TEST(ContactLoop, MakesCoursesWaitWhereTheyWouldCrushATool) {
  HapticScene scene;
  scene.tools.push_back(tool_at("ball", make_sphere(0.01), {0.0, 0.0, 0.0}));
  HapticBody pusher = body_at("pusher", make_box({0.02, 0.1, 0.1}), {-0.05, 0.0, 0.0});
  pusher.course = Motion::constant_velocity(pusher.X_WB, Vector3d(0.2, 0.0, 0.0));
  scene.bodies.push_back(pusher);
  scene.bodies.push_back(body_at("wall", make_box({0.02, 0.1, 0.1}), {0.05, 0.0, 0.0}));
  scene.duration = 0.2;
  ContactLoop loop(scene);
  double lost = 0.0;
  for (int k = 0; k < 200; ++k) {
    const HapticCycle& cycle = loop.advance(std::array{at(Vector3d::Zero())}, kMillisecond, k);
    ASSERT_GT(cycle.clearance, 0.0);
    lost += cycle.asked - cycle.lasted;
  }
  EXPECT_GT(lost, 0.05);
  EXPECT_LT(loop.pose(0).position.x(), 0.03);
  EXPECT_GT(loop.pose(1).position.x(), -0.02);
}

TEST(ContactLoop, LetsAToolOutBetweenBodiesThatWaitForIt) {
  ContactLoop loop(cube_in_a_press());
  const Vector3d middle(0.003, 0.0, 0.05);
  for (int k = 0; k < 600; ++k) {
    (void)loop.advance(std::array{at(middle)}, kMillisecond, k);
  }
  // A surface that waits does not move.
  EXPECT_EQ(loop.contact_set().count, 8U);
  for (std::uint32_t k = 0; k < loop.contact_set().count; ++k) {
    EXPECT_EQ(loop.contact_set().contacts[k].surface_velocity, Vector3d::Zero());
  }
  for (int k = 0; k < 100; ++k) {
    const Vector3d pulled = middle + Vector3d(5e-4 * k, 0.0, 0.0);
    const HapticCycle& cycle = loop.advance(std::array{at(pulled)}, kMillisecond, k);
    EXPECT_NEAR(loop.pose(0).position.x(), pulled.x(), 1e-5) << k;
    EXPECT_LT(cycle.lasted, cycle.asked) << k;
    ASSERT_GT(cycle.clearance, 0.3 * loop.contact_distance()) << k;
  }
}

/// Where a member of a cycle is at a time of it; tools turn about their centres, here their
/// origins.
Pose pose_in(const HapticCycle& cycle, std::size_t member, double time) {
  const auto& pieces = cycle.members.at(member).pieces;
  double from = 0.0;
  for (const HapticPiece& piece : pieces) {
    if (time <= piece.to || &piece == &pieces.back()) {
      const double share = std::clamp((time - from) / (piece.to - from), 0.0, 1.0);
      const double angle = piece.rotation_vector.norm();
      const Vector3d axis =
          angle > 0.0 ? Vector3d(piece.rotation_vector / angle) : Vector3d::UnitX();
      return {piece.X_WB.position + share * piece.translation,
              Eigen::AngleAxisd(share * angle, axis) * piece.X_WB.rotation};
    }
    from = piece.to;
  }
  return cycle.members.at(member).X_WB;
}

/// [m]  The least gap of a ball, the tool, to a box, the only body, at many times of a cycle.
double least_gap(const HapticCycle& cycle, double radius, const Vector3d& size) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k <= 200; ++k) {
    const double time = cycle.lasted * k / 200.0;
    const Pose box = pose_in(cycle, 1, time);
    const Vector3d p = box.rotation.conjugate() * (pose_in(cycle, 0, time).position - box.position);
    const Vector3d beyond = (p.cwiseAbs() - 0.5 * size).cwiseMax(0.0);
    least = std::min(least, beyond.norm() - radius);
  }
  return least;
}

// Its ends lie in cycles, not between them: what it does within one cycle is no less true.
TEST(ContactLoop, IsHitByWhatComesAndGoesWithinACycle) {
  const Vector3d size(0.02, 0.1, 0.1);
  HapticScene scene;
  scene.tools.push_back(tool_at("ball", make_sphere(0.01), {0.0, 0.0, 0.0}));
  HapticBody hammer = body_at("hammer", make_box(size), {-0.3, 0.0, 0.0});
  const std::vector<double> times = {0.0, 0.5011, 0.5014, 0.5017, 1.0};
  const std::vector<Pose> places = {at({-0.3, 0, 0}), at({-0.3, 0, 0}), at({0.03, 0, 0}),
                                    at({-0.3, 0, 0}), at({-0.3, 0, 0})};
  hammer.course = Motion::waypoints(times, places);
  scene.bodies.push_back(hammer);
  scene.duration = 1.0;
  ContactLoop loop(scene);
  double farthest = 0.0;
  double lost = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const HapticCycle& cycle = loop.advance(std::array{at(Vector3d::Zero())}, kMillisecond, k);
    lost += cycle.asked - cycle.lasted;
    for (int i = 0; i <= 100; ++i) {
      farthest = std::max(farthest, pose_in(cycle, 0, cycle.lasted * i / 100.0).position.x());
    }
    ASSERT_GT(least_gap(cycle, 0.0099, size), 0.0) << k;
  }
  EXPECT_GT(farthest, 0.045);  // The hammer's face gets to 0.04 m.
  EXPECT_LT(lost, 0.01);
}

TEST(ContactLoop, IsHitByABladeThatTurnsAlmostOnceACycle) {
  const Vector3d size(0.3, 0.01, 0.05);
  HapticScene scene;
  scene.tools.push_back(tool_at("ball", make_sphere(0.01), {0.08, 0.06, 0.0}));
  HapticBody blade = body_at("blade", make_box(size), Vector3d::Zero());
  const double turns = 50.0 * 350.0 / 360.0;
  blade.course = Motion::screw(blade.X_WB, Vector3d::Zero(), Vector3d::UnitZ(),
                               2.0 * std::numbers::pi * turns, 0.0);
  scene.bodies.push_back(blade);
  scene.duration = 0.05;
  ContactLoop loop(scene);
  double farthest = 0.0;
  double lost = 0.0;
  for (int k = 0; k < 50; ++k) {
    const HapticCycle& cycle = loop.advance(std::array{at({0.08, 0.06, 0.0})}, kMillisecond, k);
    ASSERT_GT(least_gap(cycle, 0.0099, size), 0.0) << k;
    lost += cycle.asked - cycle.lasted;
    for (int i = 0; i <= 100; ++i) {
      const Vector3d place = pose_in(cycle, 0, cycle.lasted * i / 100.0).position;
      farthest = std::max(farthest, (place - Vector3d(0.08, 0.06, 0.0)).norm());
    }
  }
  // It cannot stay where the blade passes: it is carried along, or the blade waits for it.
  EXPECT_TRUE(farthest > 0.05 || lost > 0.02) << farthest << " m, " << lost << " s";
}

TEST(ContactLoop, KeepsTwoToolsApart) {
  HapticScene scene;
  scene.tools.push_back(tool_at("left", make_box({0.02, 0.02, 0.02}), {-0.03, 0.0, 0.0}));
  scene.tools.push_back(tool_at("right", make_box({0.02, 0.02, 0.02}), {0.03, 0.0, 0.0}));
  ContactLoop loop(scene);
  for (int k = 0; k < 20; ++k) {
    // They want to change places.
    const HapticCycle& cycle =
        loop.advance(std::array{at({0.03, 0.0, 0.0}), at({-0.03, 0.0, 0.0})}, kMillisecond, k);
    ASSERT_GT(cycle.clearance, 0.0);
  }
  EXPECT_NEAR(loop.pose(1).position.x() - loop.pose(0).position.x(), 0.02, 1e-5);
  EXPECT_NEAR(loop.pose(1).position.x() + loop.pose(0).position.x(), 0.0, 1e-5);
  EXPECT_EQ(loop.contact_set().contacts[0].other, 0);
}

TEST(ContactLoop, RefusesToStartInsideAndNamesBoth) {
  HapticScene scene = cube_on_floor(0.0, 0.01);
  try {
    const ContactLoop loop(scene);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("\"cube\" and \"floor\""), std::string::npos);
  }
  scene = cube_on_floor();
  scene.tools.clear();
  EXPECT_THROW(ContactLoop{scene}, std::invalid_argument);
}

TEST(ContactLoop, SaysThatAContactDistanceIsTooLarge) {
  for (const double distance : {1.0, 1e6, 1e300}) {
    HapticScene scene = cube_on_floor();
    scene.contact_distance = distance;
    try {
      const ContactLoop loop(scene);
      FAIL() << distance;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("a tenth of the contact distance"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(ContactLoop, RefusesACentreSoFarThatNothingIsProven) {
  HapticScene scene = cube_on_floor();
  scene.tools[0].p_BC = {1e9, 0.0, 0.0};
  EXPECT_THROW(ContactLoop{scene}, std::invalid_argument);
}

// Nearer along each axis than its distance from the origin, beyond which no target is followed.
TEST(ContactLoop, StaysWhereItIsFarFromTheOrigin) {
  HapticScene scene = cube_on_floor();
  const Vector3d far(1e6, 1e6, 0.0);
  scene.tools[0].X_WB.position += far;
  scene.bodies[0].X_WB.position += far;
  scene.contact_distance = 1e-6;
  EXPECT_THROW(ContactLoop{scene}, std::invalid_argument);
  scene.contact_distance = 2e-6;
  ContactLoop loop(scene);
  run_to(loop, at(far + Vector3d(0.0, 0.0, -0.01)), 3);
  EXPECT_LT((loop.pose(0).position - far - Vector3d(0.0, 0.0, 0.02)).norm(), 1e-5);
}

// Farther off, rounding would exceed the contact distance, and a clearance of 0 be all that holds.
TEST(ContactLoop, GoesNoFartherThanItsClearanceIsProven) {
  for (const double far : {1e6, 1e9, 1e12}) {
    ContactLoop loop(cube_on_floor());
    Pose target = loop.pose(0);
    target.position.x() = far;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(loop.advance(std::array{target}, 1e-3, 0).clearance, 0.0) << far;
    }
    const double went = loop.pose(0).position.x();
    EXPECT_GT(went, 0.99 * std::min(far, 1e-5 * 0x1p40)) << far;
    target.position.x() = 0.0;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(loop.advance(std::array{target}, 1e-3, 0).clearance, 0.0) << far;
    }
    EXPECT_NEAR(loop.pose(0).position.x(), 0.0, 1e-6) << far;
  }
}

TEST(ContactLoop, NamesTheContactDistanceOfAToolOfOnePoint) {
  const auto refusal = [](std::optional<double> distance) -> std::string {
    HapticScene scene = cube_on_floor();
    scene.tools[0].shape = Shape(Mesh{.vertices = {Vector3d::Zero()}, .triangles = {{0, 0, 0}}});
    scene.contact_distance = distance;
    try {
      const ContactLoop loop(scene);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(refusal({}).find("no default of \"contact_distance\""), std::string::npos);
  EXPECT_NE(refusal(1e-20).find("\"contact_distance\" is too small"), std::string::npos);
  EXPECT_EQ(refusal(1e-5), "none");
}

TEST(ContactLoop, LetsIgnoredPairsPass) {
  HapticScene scene = cube_on_floor();
  scene.ignored_pairs = {{0, 1}};
  ContactLoop loop(scene);
  run_to(loop, at({0.0, 0.0, -0.5}), 1);
  EXPECT_NEAR(loop.pose(0).position.z(), -0.5, 1e-12);
}

TEST(ContactLoop, IsTheSameOnEveryRun) {
  const auto poses = [] {
    ContactLoop loop(peg_over_hole(2e-5, 0.2));
    std::vector<double> all;
    for (int k = 0; k < 100; ++k) {
      const double x = 0.01 * std::sin(0.1 * k);
      (void)loop.advance(std::array{at({x, 0.5 * x, 0.03 - 0.0006 * k}, {x, 0.1, 0.0})},
                         kMillisecond, k);
      all.push_back(loop.pose(0).position.x());
      all.push_back(loop.pose(0).rotation.z());
    }
    return all;
  };
  EXPECT_EQ(poses(), poses());
}

}  // namespace
}  // namespace firstcontact
