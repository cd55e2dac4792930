// How far tracking errors can move a link: a bound that holds, and that is reached.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/robot_check/check_robots.h>

#include "robot/planar_arm.h"
#include "support/random.h"

namespace firstcontact::test {
namespace {

using Eigen::Vector3d;

Motion placed(const Vector3d& place) {
  return Motion::fixed({place, Eigen::Quaterniond::Identity()});
}

/// An arm at rest along x with a ball above the tip, `gap` from its bar.
RobotScene straight_arm(std::size_t bars, double gap, const Vector3d& offset = Vector3d::Zero()) {
  RobotScene scene;
  scene.add_robot("arm",
                  planar_motion(std::vector<CoordinatePath>(bars, CoordinatePath::constant(0.0))));
  const double x = static_cast<double>(bars);
  scene.add_body("ball", make_sphere(0.1),
                 placed(Vector3d(x, kBarRadius + 0.1 + gap, 0.0) + offset));
  return scene;
}

void set_errors(RobotScene& scene, std::size_t bars, double error) {
  for (std::size_t k = 0; k < bars; ++k) {
    scene.set_tracking_error(0, "j" + std::to_string(k), {.angle = error});
  }
}

/// The tip of a straight arm moves by the error times the sum of its distances from the joints.
TEST(TrackingError, CountsAsMuchAsItMovesTheTip) {
  constexpr double kError = 1e-3;
  for (const std::size_t bars : {1u, 2u, 3u, 6u}) {
    double way = 0.0;
    for (std::size_t k = 1; k <= bars; ++k) {
      // The ball around a bar is what the bound knows: it ends at most this far beyond the tip.
      way += kError * static_cast<double>(k);
    }
    RobotScene apart = straight_arm(bars, 1.3 * way);
    set_errors(apart, bars, kError);
    EXPECT_EQ(check_robots(apart).verdict, Verdict::free) << bars;
    RobotScene close = straight_arm(bars, 0.98 * way);
    EXPECT_EQ(check_robots(close).verdict, Verdict::free) << bars;
    set_errors(close, bars, kError);
    const SceneResult result = check_robots(close);
    EXPECT_EQ(result.verdict, Verdict::contact_at_start) << bars;
    EXPECT_GE(result.pairs.at(0).margin, way * (1.0 - 1e-6));
    EXPECT_LE(result.pairs.at(0).margin, 1.3 * way);
    // And such a motion does touch.
    RobotScene bent;
    bent.add_robot(
        "arm", planar_motion(std::vector<CoordinatePath>(bars, CoordinatePath::constant(kError))));
    bent.add_body("ball", make_sphere(0.1), close.body_motion(bars + 1));
    EXPECT_EQ(check_robots(bent).verdict, Verdict::contact_at_start) << bars;
  }
}

/// Errors of the joints that two fingers share do not part them.
TEST(TrackingError, JointsAboveTheCommonAncestorCancel) {
  RobotDescription hand{.name = "hand", .links = {}, .joints = {}};
  for (const char* name : {"base", "palm", "l", "r"}) {
    hand.links.push_back({name, {}, {}});
  }
  const Shape finger = make_sphere(0.1);
  hand.links[2].collision.push_back({.name = "", .X_LG = {}, .source = {}, .shape = finger});
  hand.links[3].collision.push_back({.name = "", .X_LG = {}, .source = {}, .shape = finger});
  Joint arm{.name = "arm", .type = JointType::continuous, .parent = "base", .child = "palm"};
  arm.X_PJ.position.x() = 100.0;
  Joint left{.name = "left", .type = JointType::prismatic, .parent = "palm", .child = "l"};
  Joint right{.name = "right", .type = JointType::prismatic, .parent = "palm", .child = "r"};
  right.mimic = Mimic{.joint = "left", .multiplier = -1.0, .offset = 0.0};
  hand.joints = {arm, left, right};
  const RobotMotion motion(RobotModel(hand),
                           {{"arm", ramp(0.0, 3.0)}, {"left", CoordinatePath::constant(0.11)}});
  RobotScene scene;
  scene.add_robot("hand", motion);
  scene.set_tracking_error(0, "arm", {.angle = 1.0});
  EXPECT_EQ(check_robots(scene).verdict, Verdict::free);
  // They are 0.02 apart; both slide by the error of one.
  scene.set_tracking_error(0, "left", {.distance = 0.0099});
  EXPECT_EQ(check_robots(scene).verdict, Verdict::free);
  scene.set_tracking_error(0, "left", {.distance = 0.0101});
  EXPECT_NE(check_robots(scene).verdict, Verdict::free);
}

TEST(TrackingError, HoldsForABodyThatWasPutDown) {
  const auto check = [](double gap, double error) {
    RobotScene scene;
    scene.add_robot("arm", planar_motion({CoordinatePath::constant(0.0)}));
    const std::size_t tool = scene.add_body("tool", make_sphere(0.1), placed({5.0, 0.0, 1.0}));
    // Comes near after the tool was put down.
    scene.add_body("drone", make_sphere(0.1),
                   Motion::constant_velocity({{5.0, 10.0, 1.0}, Eigen::Quaterniond::Identity()},
                                             Vector3d(0.0, -(10.0 - 0.2 - gap), 0.0)));
    scene.attach({.body = tool, .link = 1, .t_from = 0.0, .t_to = 0.5});
    scene.set_tracking_error(0, "j0", {.angle = error});
    return check_robots(scene).verdict;
  };
  EXPECT_EQ(check(0.05, 0.0), Verdict::free);
  // 5 m from the joint: 0.05. A ball moves as its middle, so its radius adds nothing.
  EXPECT_EQ(check(0.0501, 0.01), Verdict::free);
  EXPECT_EQ(check(0.0499, 0.01), Verdict::contact);
}

/// A floating joint and a ball: the error of the child's frame.
TEST(TrackingError, OfAPoseIsThatOfTheChildsFrame) {
  for (const JointType type : {JointType::floating, JointType::ball}) {
    RobotDescription drone{
        .name = "d", .links = {{"base", {}, {}}, {"body", {}, {}}}, .joints = {}};
    // A needle from the child's origin to 1 m along x.
    drone.links[1].collision.push_back({.name = "", .X_LG = {}, .source = {}, .shape = bar()});
    drone.joints.push_back({.name = "j", .type = type, .parent = "base", .child = "body"});
    // Turns about y, which leaves the frame of the screw's axis far from the child's origin.
    const Motion motion =
        type == JointType::ball
            ? Motion::constant_velocity({}, Vector3d::Zero(), Vector3d(0.0, 1e-3, 0.0))
            : Motion::screw({}, Vector3d(0.0, 0.0, 50.0), Vector3d::UnitY(), 1e-4, 0.0);
    const auto check = [&](double gap) {
      RobotScene scene;
      scene.add_robot("d", {RobotModel(drone), {{"j", motion}}});
      scene.add_body("ball", make_sphere(0.1), placed({1.0, kBarRadius + 0.1 + gap, 0.0}));
      scene.set_tracking_error(0, "j", {.angle = 0.01});
      return check_robots(scene).verdict;
    };
    EXPECT_EQ(check(0.012), Verdict::free);
    EXPECT_NE(check(0.0098), Verdict::free);
  }
}

/// A motion that is free with errors is free for random motions within them.
TEST(TrackingError, EveryMotionInTheTubeIsFree) {
  constexpr std::size_t kBars = 4;
  const std::array<double, 5> times = {0.0, 0.25, 0.5, 0.75, 1.0};
  int free = 0;
  int close = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Random random(seed);
    const double error = random.uniform(0.005, 0.05);
    std::array<std::array<double, 5>, kBars> q{};
    for (auto& of_joint : q) {
      for (double& value : of_joint) {
        value = random.uniform(-0.7, 0.7);
      }
    }
    const auto scene_of = [&](const auto& deviation) {
      RobotScene scene;
      std::vector<CoordinatePath> paths;
      for (std::size_t k = 0; k < kBars; ++k) {
        std::array<double, 5> moved = q[k];
        for (double& value : moved) {
          value += deviation();
        }
        paths.push_back(CoordinatePath::linear(times, moved));
      }
      scene.add_robot("arm", planar_motion(paths));
      return scene;
    };
    const Vector3d place(random.uniform(1, 4), random.uniform(-3, 3), 0.0);
    const auto with_ball = [&](RobotScene scene) {
      scene.add_body("ball", make_sphere(0.1), placed(place));
      return scene;
    };
    RobotScene nominal = with_ball(scene_of([] { return 0.0; }));
    const bool is_free = check_robots(nominal).verdict == Verdict::free;
    set_errors(nominal, kBars, error);
    if (check_robots(nominal).verdict != Verdict::free) {
      close += is_free ? 1 : 0;
      continue;
    }
    ++free;
    for (int sample = 0; sample < 6; ++sample) {
      const bool extreme = sample % 2 == 0;
      const RobotScene moved = with_ball(scene_of([&] {
        const double part = random.uniform(-1.0, 1.0);
        return error * (extreme ? (part < 0.0 ? -1.0 : 1.0) : part);
      }));
      ASSERT_EQ(check_robots(moved).verdict, Verdict::free) << seed;
    }
  }
  EXPECT_GE(free, 30);
  EXPECT_GE(close, 5);
  EXPECT_LE(close, 60);
}

/// Some motions that end just outside of the tube's reach touch: the bound is not too far.
TEST(TrackingError, TheBoundOfABentArmIsReached) {
  constexpr double kError = 1e-3;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const std::vector<double> q = {random.uniform(-1, 1), random.uniform(-1, 1),
                                   random.uniform(-1, 1)};
    std::vector<CoordinatePath> paths;
    for (const double angle : q) {
      paths.push_back(CoordinatePath::constant(angle));
    }
    // The bound of the last bar's points, against the sum over the joints of its tip's distances.
    RobotScene scene;
    scene.add_robot("arm", planar_motion(paths));
    const std::vector<Eigen::Vector2d> p = hinges(q);
    double greatest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      greatest += kError * (p[3] - p[k]).norm();
    }
    const Eigen::Vector2d beyond = p[3] + (kBarRadius + 0.1 + 1e-4) * (p[3] - p[2]);
    scene.add_body("ball", make_sphere(0.1), placed({beyond.x(), beyond.y(), 0.0}));
    set_errors(scene, 3, kError);
    const SceneResult result = check_robots(scene);
    ASSERT_EQ(result.verdict, Verdict::contact_at_start) << seed;
    ASSERT_GE(result.pairs[0].margin, greatest * (1.0 - 1e-6)) << seed;
    ASSERT_LE(result.pairs[0].margin, 1.5 * greatest) << seed;
  }
}

TEST(TrackingError, IsInTheUnitOfTheCoordinate) {
  const auto error_of = [](JointType type) {
    return tracking_error_of({.name = "a", .type = type, .parent = "p", .child = "c"}, 0.1);
  };
  EXPECT_EQ(error_of(JointType::revolute).angle, 0.1);
  EXPECT_EQ(error_of(JointType::screw).angle, 0.1);
  EXPECT_EQ(error_of(JointType::prismatic).distance, 0.1);
  for (const JointType type : {JointType::fixed, JointType::planar, JointType::ball}) {
    EXPECT_THROW(static_cast<void>(error_of(type)), std::invalid_argument);
  }
}

}  // namespace
}  // namespace firstcontact::test
