// Joints of OMPL spaces: those that mimic, those that go the short way round, and compounds.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "firstcontact_ompl/proven_edges.h"
#include "planning/box_walk.h"
#include "planning/ompl_proven.h"
#include "planning/plan_cases.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

namespace ob = ompl::base;

const Eigen::Vector3d kHalfPost{0.05, 0.05, 0.05};  // [m]

/// Cubes of 0.1 m around an arm of four links.
std::vector<PlacedBox> posts() {
  std::vector<PlacedBox> all;
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0.5, 0.5, 0.0), Eigen::Vector3d(-0.6, 0.3, 0.2),
                                    Eigen::Vector3d(0.4, -0.5, -0.4)}) {
    all.push_back({Eigen::Isometry3d(Eigen::Translation3d(at)), kHalfPost});
  }
  return all;
}

void add_posts(RobotScene& scene) {
  for (const PlacedBox& post : posts()) {
    scene.add_body("post" + std::to_string(scene.size()),
                   make_box({2 * post.half.x(), 2 * post.half.y(), 2 * post.half.z()}),
                   resting_at(post.X_WB.translation()));
  }
}

/// All pairs of some first boxes with each other and with the other ones.
std::vector<std::array<std::size_t, 2>> pairs_of(std::size_t moving, std::size_t all) {
  std::vector<std::array<std::size_t, 2>> pairs;
  for (std::size_t a = 0; a < moving; ++a) {
    for (std::size_t b = a + 1; b < all; ++b) {
      pairs.push_back({a, b});
    }
  }
  return pairs;
}

/// A continuous joint, a revolute one, one that mimics it, and one more.
BoxArm mimicking_arm() {
  return BoxArm(
      {{.is_continuous = true}, {}, {.follows = 1, .multiplier = -0.75, .offset = 0.25}, {}});
}

constexpr double kNear = 2e-6;    // [m]  More than the tolerance and the extra clearance.
constexpr double kFinest = 1e-5;  // [-]

TEST(OmplJoints, ThatMimicAndTurnShortAreProvenAsTheyMove) {
  const BoxArm arm = mimicking_arm();
  RobotScene scene;
  add_posts(scene);
  const std::size_t number = scene.add_robot("arm", arm.rest());
  const Proven proven(
      PlanScene{.scene = std::move(scene), .robots = {number}, .space = arm.space()});
  ASSERT_EQ(proven.edges->space().size(), 3u);
  const OmplStates states(*proven.space, proven.edges->space());
  ob::ScopedState<> from(proven.space);
  ob::ScopedState<> to(proven.space);
  ob::ScopedState<> between(proven.space);
  int blocked = 0;
  int round = 0;
  constexpr int kEdges = 100;
  for (int k = 0; k < kEdges; ++k) {
    from.random();
    to.random();
    const Configuration start = states.read(from.get());
    const Configuration end = states.read(to.get());
    round += std::abs(end[0] - start[0]) > std::numbers::pi ? 1 : 0;
    const MovingBoxes boxes{
        .at =
            [&](double share) {
              proven.space->interpolate(from.get(), to.get(), share, between.get());
              std::vector<PlacedBox> all = arm.links(states.read(between.get()));
              const std::vector<PlacedBox> still = posts();
              all.insert(all.end(), still.begin(), still.end());
              return all;
            },
        .pairs = pairs_of(4, 4 + posts().size()),
        .speed = 2.0 * arm.way(start, end)};
    const WalkedEdge walked = walk(boxes, kNear, kFinest);
    const bool is_valid = proven.validator->checkMotion(from.get(), to.get());
    blocked += is_valid ? 0 : 1;
    ASSERT_FALSE(is_valid && walked.met_by) << k;
    ASSERT_TRUE(is_valid || walked.near_from) << k;
  }
  EXPECT_GT(blocked, kEdges / 10);
  EXPECT_LT(blocked, kEdges);
  EXPECT_GT(round, 10);
}

/// The difference of two angles, without whole turns.
double apart(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * std::numbers::pi)); }

TEST(OmplJoints, InterpolateAsTheirEdges) {
  const BoxArm arm = mimicking_arm();
  const ConfigurationSpace places = arm.space();
  const ob::StateSpacePtr space = make_ompl_space(places);
  const OmplStates states(*space, places);
  Random random(2);
  ob::ScopedState<> from(space);
  ob::ScopedState<> to(space);
  ob::ScopedState<> between(space);
  constexpr double kHalf = std::numbers::pi;
  for (int k = 0; k < 20'000; ++k) {
    const double angle = random.uniform(-kHalf, kHalf);
    double other = random.uniform(-kHalf, kHalf);
    if (k % 2 == 0) {
      // Half a turn, to a few units in the last place.
      other = angle + (angle < 0.0 ? kHalf : -kHalf);
      for (int ulp = k % 14 / 2; ulp > 3; --ulp) {
        other = std::nextafter(other, 10.0);
      }
      for (int ulp = k % 14 / 2; ulp < 3; ++ulp) {
        other = std::nextafter(other, -10.0);
      }
      other = std::clamp(other, -kHalf, std::nextafter(kHalf, 0.0));
    }
    states.write({angle, random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)}, from.get());
    states.write({other, random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)}, to.get());
    const double share = random.uniform(0.0, 1.0);
    space->interpolate(from.get(), to.get(), share, between.get());
    const Configuration got = states.read(between.get());
    const Configuration expected =
        places.interpolate(states.read(from.get()), states.read(to.get()), share);
    ASSERT_LE(apart(got[0], expected[0]), 1e-12) << k << ": " << angle << " to " << other;
    for (std::size_t c = 1; c < 3; ++c) {
      ASSERT_NEAR(got[c], expected[c], 1e-12) << k;
    }
  }
}

/// [rad]  The turn between two quaternions at a place of a configuration.
double turn_between(const Configuration& a, const Configuration& b, std::size_t first) {
  const Eigen::Quaterniond from(a[first], a[first + 1], a[first + 2], a[first + 3]);
  const Eigen::Quaterniond to(b[first], b[first + 1], b[first + 2], b[first + 3]);
  return 2.0 * (from.conjugate() * to).vec().norm();
}

// Turns from a nanoradian to half a turn; motions that OMPL does not follow are refused.
TEST(OmplJoints, PosesInterpolateAsTheirEdgesWhereMotionsAreValid) {
  const Proven proven(with_bar(RobotScene(), {0.1, 0.2, 0.3}));
  const OmplStates states(*proven.space, proven.edges->space());
  Random random(8);
  int followed = 0;
  constexpr int kMotions = 5'000;
  for (int k = 0; k < kMotions; ++k) {
    const Eigen::Quaterniond start = random.rotation();
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(random.logarithmic(1e-9, 3.14), random.direction()));
    Eigen::Quaterniond end = start * turn;
    end.normalize();
    const double sign = random.chance(0.5) ? 1.0 : -1.0;
    ob::State* from =
        proven.state({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                      start.w(), start.x(), start.y(), start.z()});
    ob::State* to =
        proven.state({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                      sign * end.w(), sign * end.x(), sign * end.y(), sign * end.z()});
    ob::State* between = proven.si->allocState();
    if (proven.validator->checkMotion(from, to)) {
      ++followed;
      const double share = random.uniform(0.0, 1.0);
      proven.space->interpolate(from, to, share, between);
      const Configuration got = states.read(between);
      const Configuration expected =
          proven.edges->space().interpolate(states.read(from), states.read(to), share);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(got[c], expected[c], 1e-12) << k;
      }
      ASSERT_LE(turn_between(got, expected, 3), 1e-12) << k;
    }
    for (ob::State* state : {from, to, between}) {
      proven.si->freeState(state);
    }
  }
  EXPECT_GT(followed, kMotions / 4);
  EXPECT_LT(followed, kMotions);
}

// Two boxes that float beside an arm of seven joints: R^7 x SE(3) x SE(3).
TEST(OmplCompound, OfJointsAndTwoPosesIsProvenWhateverItsWeights) {
  const Eigen::Vector3d half{0.15, 0.1, 0.05};
  const BoxArm arm(std::vector<ArmJoint>(7));
  RobotScene scene;
  std::vector<std::size_t> robots = {scene.add_robot("arm", arm.rest())};
  std::vector<ConfigurationSpace> spaces = {arm.space()};
  const std::vector<std::string> names = {"arm", "a", "b"};
  for (const char* name : {"a", "b"}) {
    spaces.push_back(ConfigurationSpace::of_body(
        name, make_box({2 * half.x(), 2 * half.y(), 2 * half.z()}), Eigen::Vector3d::Constant(-1.5),
        Eigen::Vector3d::Constant(1.5)));
    const Configuration origin = {0, 0, 0, 1, 0, 0, 0};
    robots.push_back(scene.add_robot(name, spaces.back().motion(origin, origin)));
  }
  const auto edges =
      std::make_shared<EdgeChecker>(PlanScene{.scene = std::move(scene),
                                              .robots = std::move(robots),
                                              .space = ConfigurationSpace::joined(names, spaces)});
  ASSERT_EQ(edges->space().size(), 21u);
  seed_ompl();
  Random random(6);
  int blocked = 0;
  int all = 0;
  for (int weights = 0; weights < 5; ++weights) {
    const auto space = std::make_shared<ob::CompoundStateSpace>();
    const auto joints = std::make_shared<ob::RealVectorStateSpace>(7);
    joints->setBounds(-1.5, 1.5);
    space->addSubspace(joints, random.logarithmic(1e-3, 1e3));
    for (int k = 0; k < 2; ++k) {
      const auto pose = std::make_shared<ob::SE3StateSpace>();
      ob::RealVectorBounds bounds(3);
      bounds.setLow(-1.5);
      bounds.setHigh(1.5);
      pose->setBounds(bounds);
      space->addSubspace(pose, random.logarithmic(1e-3, 1e3));
    }
    const auto si = std::make_shared<ob::SpaceInformation>(space);
    si->setStateValidityChecker(std::make_shared<ProvenStates>(si, edges));
    si->setMotionValidator(std::make_shared<ProvenEdges>(si, edges));
    si->setup();
    const OmplStates states(*space, edges->space());
    ob::ScopedState<> from(space);
    ob::ScopedState<> to(space);
    ob::ScopedState<> between(space);
    for (int k = 0; k < 20; ++k, ++all) {
      from.random();
      to.random();
      const Configuration start = states.read(from.get());
      const Configuration end = states.read(to.get());
      const auto joints_of = [](const Configuration& q) { return std::span(q).first(7); };
      const auto pose_of = [](const Configuration& q, std::size_t pose) {
        return std::span(q).subspan(7 + 7 * pose, 7);
      };
      const MovingBoxes boxes{.at =
                                  [&](double share) {
                                    space->interpolate(from.get(), to.get(), share, between.get());
                                    const Configuration q = states.read(between.get());
                                    std::vector<PlacedBox> placed = arm.links(joints_of(q));
                                    placed.push_back(placed_box(pose_of(q, 0), half));
                                    placed.push_back(placed_box(pose_of(q, 1), half));
                                    return placed;
                                  },
                              .pairs = pairs_of(9, 9),
                              .speed = 2.0 * arm.way(joints_of(start), joints_of(end)) +
                                       way_of_box(pose_of(start, 0), pose_of(end, 0), half) +
                                       way_of_box(pose_of(start, 1), pose_of(end, 1), half)};
      const WalkedEdge walked = walk(boxes, kNear, kFinest);
      const bool is_valid = si->checkMotion(from.get(), to.get());
      blocked += is_valid ? 0 : 1;
      ASSERT_FALSE(is_valid && walked.met_by) << all;
      ASSERT_TRUE(is_valid || walked.near_from) << all;
    }
  }
  EXPECT_GT(blocked, all / 10);
  EXPECT_LT(blocked, all);
}

}  // namespace
}  // namespace firstcontact::test
