// Tools whose fingers move: grippers and hands that follow the grips of their devices.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/query/distance.h>

#include "haptics/grip_scenes.h"
#include "haptics/haptic_scenes.h"
#include "support/random.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kContactDistance = 1e-5;  // [m]

HapticScene grip_scene(HapticTool tool) {
  HapticScene scene;
  scene.tools.push_back(std::move(tool));
  scene.contact_distance = kContactDistance;
  return scene;
}

/// Shapes of the members of a scene.
std::vector<Shape> shapes_of(const HapticScene& scene) {
  std::vector<Shape> shapes;
  for (const HapticTool& tool : scene.tools) {
    shapes.push_back(tool.shape);
  }
  for (const HapticBody& body : scene.bodies) {
    shapes.push_back(body.shape);
  }
  for (const HapticTool& tool : scene.tools) {
    for (const HapticLink& link : tool.links) {
      if (link.shape) {
        shapes.push_back(*link.shape);
      }
    }
  }
  return shapes;
}

double gap_of(const Shape& A, const Pose& X_WA, const Shape& B, const Pose& X_WB) {
  Workspace workspace;
  return distance({A, Motion::fixed(X_WA)}, {B, Motion::fixed(X_WB)}, 0.0, workspace).distance;
}

/// A session of one tool with grips, and a device that the test moves.
class GripSession {
 public:
  explicit GripSession(HapticScene scene, DeviceMapping mapping = one_grip())
      : shapes_(shapes_of(scene)), session_(std::move(scene), {.mappings = {std::move(mapping)}}) {
    device_.status = DeviceStatus::live;
  }

  /// Steps so many ticks with a handle at a place and a grip at a value.
  const ForceTick& step(const Vector3d& handle, double grip, int ticks = 1) {
    const ForceTick* tick = nullptr;
    for (int k = 0; k < ticks; ++k) {
      device_.X_DH.position = handle;
      device_.grips[0] = grip;
      device_.time_ns = session_.time_ns();
      ++device_.sequence;
      tick = &session_.step(std::array{device_});
      if (session_.cycle() != nullptr) {
        last_ = *session_.cycle();
        least_clearance_ = std::min(least_clearance_, last_.clearance);
      }
    }
    return *tick;
  }

  [[nodiscard]] double gap(std::size_t a, std::size_t b) const {
    return gap_of(shapes_[a], session_.contacts().pose(a), shapes_[b], session_.contacts().pose(b));
  }
  [[nodiscard]] double joint(std::size_t k) const { return session_.contacts().joints()[k]; }
  [[nodiscard]] const Pose& pose(std::size_t member) const {
    return session_.contacts().pose(member);
  }
  [[nodiscard]] const HapticCycle& cycle() const { return last_; }
  [[nodiscard]] double least_clearance() const { return least_clearance_; }
  DeviceState device_;

 private:
  std::vector<Shape> shapes_;
  HapticSession session_;
  HapticCycle last_;
  double least_clearance_ = std::numeric_limits<double>::infinity();
};

/// A cube of 3 cm between the jaws of a gripper. Members: hand, cube, right, left.
HapticScene around_a_cube_of(double friction, const Vector3d& at = {0.0, 0.0, -0.05}) {
  HapticScene scene = grip_scene(jaws(friction));
  scene.bodies.push_back(body_at("cube", make_box({0.03, 0.03, 0.03}), at, friction));
  return scene;
}

TEST(Grip, StopsAtWhatItHoldsAndFeelsItsSprings) {
  GripSession session(around_a_cube_of(0.0), one_grip(kJawWay));
  const Vector3d rest = Vector3d::Zero();
  session.step(rest, 0.0, 1000);
  for (int k = 0; k <= 2000; ++k) {
    session.step(rest, 5e-4 * k);
  }
  const ForceTick& tick = session.step(rest, 1.0, 200);
  for (const std::size_t finger : {2U, 3U}) {
    EXPECT_GE(session.gap(1, finger), kContactDistance);
    EXPECT_LE(session.gap(1, finger), 2.0 * kContactDistance);
  }
  EXPECT_GT(session.least_clearance(), 0.0);
  double on_grip = 0.0;
  for (const std::size_t joint : {0U, 1U}) {
    EXPECT_NEAR(session.joint(joint), 0.02, 2.0 * kContactDistance);
    const double spring = kJawStiffness * (session.joint(joint) - kJawWay);
    EXPECT_NEAR(tick.joint_efforts[joint], spring, 2e-3 * std::abs(spring));
    on_grip += kJawWay * tick.joint_efforts[joint];
  }
  EXPECT_LT(on_grip, -0.5);  // It pushes the hand open.
  EXPECT_NEAR(tick.tools[0].command.grips[0], on_grip, 1e-12);
  // Both fingers push alike: nothing is left for the wrist.
  EXPECT_LT(tick.tools[0].force_W.norm(), 1e-3);
}

TEST(Grip, FeelsNothingInFreeSpace) {
  GripSession session(grip_scene(gripper()));
  for (int k = 0; k < 4000; ++k) {
    const Vector3d handle{0.1 * std::sin(0.01 * k), 0.0, 0.05 * std::cos(0.02 * k)};
    const ForceTick& tick = session.step(handle, 0.2 + 0.2 * std::sin(0.03 * k));
    ASSERT_EQ(tick.joint_efforts[0], 0.0) << k;
    ASSERT_EQ(tick.joint_efforts[1], 0.0) << k;
    ASSERT_EQ(tick.tools[0].command.grips[0], 0.0) << k;
    ASSERT_EQ(tick.tools[0].force_W, Vector3d::Zero()) << k;
  }
  session.step(Vector3d::Zero(), 0.3, 200);
  EXPECT_NEAR(session.joint(0), 0.27, 1e-9);  // And goes where the device is.
}

/// Fingertips at 5.4 m/s, a plate of 0.1 mm.
TEST(Grip, DoesNotPassAThinPlateThatItClosesOn) {
  HapticScene scene = grip_scene(gripper());
  scene.bodies.push_back(body_at("plate", make_box({1e-4, 0.1, 0.06}), {0.001, 0.0, -0.06}));
  GripSession session(std::move(scene));
  for (int k = 0; k < 400; ++k) {
    // Shut, and pulled open again.
    session.step(Vector3d::Zero(), std::clamp(0.025 * ((k % 100) - 10), 0.0, 1.0));
    const auto tip = [&](std::size_t member) {
      const Pose& X_WL = session.pose(member);
      return Vector3d(X_WL.position + X_WL.rotation * Vector3d(0.0, 0.0, -0.06));
    };
    ASSERT_GT(tip(2).x(), 0.001) << k;
    ASSERT_LT(tip(3).x(), 0.001) << k;
    ASSERT_GT(session.gap(1, 2), 0.0) << k;
    ASSERT_GT(session.gap(1, 3), 0.0) << k;
  }
  EXPECT_GT(session.least_clearance(), 0.0);
}

TEST(Grip, FingersMeetEachOtherAndStop) {
  GripSession session(grip_scene(gripper()));
  session.step(Vector3d::Zero(), 0.0, 1000);
  for (int k = 0; k < 200; ++k) {
    session.step(Vector3d::Zero(), 5e-3 * k);
  }
  const ForceTick& tick = session.step(Vector3d::Zero(), 1.0, 400);
  EXPECT_GE(session.gap(1, 2), kContactDistance);  // Members: hand, right, left.
  EXPECT_LE(session.gap(1, 2), 2.0 * kContactDistance);
  EXPECT_NEAR(session.joint(0), session.joint(1), 1e-4);
  EXPECT_LT(session.joint(0), 0.8);
  EXPECT_LT(tick.joint_efforts[0], -0.1);
  EXPECT_NEAR(tick.joint_efforts[0], tick.joint_efforts[1], 1e-2);
  EXPECT_LT(tick.tools[0].force_W.norm(), 1e-9);  // All of it is inside of the hand.
}

TEST(Grip, AFingerThatIsHeldDoesNotHoldTheOther) {
  HapticScene scene = around_a_cube_of(0.0, {-0.018, 0.0, -0.05});
  scene.tools[0].coupling.angular_stiffness = 1e4;
  GripSession session(std::move(scene), one_grip(kJawWay));
  session.step(Vector3d::Zero(), 0.0, 1000);
  const ForceTick& tick = session.step(Vector3d::Zero(), 0.5, 400);
  EXPECT_NEAR(session.joint(0), 0.017, 1e-9);
  // The springs of the wrist and of the left jaw share the 15 mm that the cube denies.
  EXPECT_NEAR(session.joint(1), 0.0095, 2.0 * kContactDistance);
  EXPECT_NEAR(tick.tools[0].force_W.x(), -7.5, 0.05);
  EXPECT_NEAR(tick.joint_efforts[1], -7.5, 0.05);
  EXPECT_EQ(tick.joint_efforts[0], 0.0);
  EXPECT_GE(session.gap(1, 3), kContactDistance);
}

/// The wrist is pushed 1 cm into a floor while the fingers close and open.
TEST(Grip, ClosesWhileTheWristIsPushedIntoAWall) {
  HapticScene scene = grip_scene(gripper(0.3));
  scene.bodies.push_back(body_at("floor", make_box({0.5, 0.5, 0.1}), {0.0, 0.0, -0.13}, 0.3));
  GripSession session(std::move(scene));
  double greatest = 0.0;
  for (int k = 0; k < test::rounds(4000, 1600); ++k) {  // A time of the fingers takes 1,571.
    const double down = -0.02 * std::min(1.0, 1e-3 * k);
    const ForceTick& tick = session.step({0.0, 0.0, down}, 0.5 - 0.5 * std::cos(4e-3 * k));
    greatest = std::max(greatest, tick.tools[0].force_W.z());
    for (const std::size_t member : {0U, 2U, 3U}) {
      ASSERT_GT(session.gap(1, member), 0.0) << k;
    }
    ASSERT_GT(session.gap(2, 3), 0.0) << k;
    for (const std::size_t joint : {0U, 1U}) {
      ASSERT_GE(session.joint(joint), -0.2);
      ASSERT_LE(session.joint(joint), 1.2);
    }
  }
  EXPECT_GT(greatest, 2.0);
  EXPECT_GT(session.least_clearance(), 0.0);
}

/// Pulls up what does not yield. With friction the fingers hold on to it.
TEST(Grip, FrictionOfWhatItHoldsIsFeltAtTheWrist) {
  const auto pulled = [](double friction) {
    GripSession session(around_a_cube_of(friction), one_grip(kJawWay));
    session.step(Vector3d::Zero(), 0.0, 1000);
    session.step(Vector3d::Zero(), 1.0, 400);
    double force = 0.0;
    for (int k = 0; k < 400; ++k) {
      force = session.step({0.0, 0.0, 5e-6 * k}, 1.0).tools[0].force_W.z();
    }
    return force;
  };
  EXPECT_NEAR(pulled(1.0), -2.0, 0.05);  // 2 mm of 1000 N/m.
  EXPECT_NEAR(pulled(0.0), 0.0, 1e-6);
}

/// Only the contact presses on a joint at its limit: the device does not ask for more.
TEST(Grip, LimitsOfJointsHoldWhatContactsPress) {
  HapticScene scene = grip_scene(gripper());
  // Blocks from inside push both fingers open when the wrist goes down.
  scene.bodies.push_back(body_at("block", make_box({0.079, 0.03, 0.03}), {0.0, 0.0, -0.1}));
  scene.tools[0].joints[0].lower = 0.0;
  scene.tools[0].joints[1].lower = 0.0;
  GripSession session(std::move(scene));
  session.step(Vector3d::Zero(), 0.0, 1000);
  for (int k = 0; k < 2000; ++k) {
    session.step({0.0, 0.0, -2e-5 * k}, 0.0);
    ASSERT_GE(session.joint(0), 0.0);
    ASSERT_GE(session.joint(1), 0.0);
  }
  EXPECT_GT(session.gap(1, 2), 0.0);
}

/// A finger of three joints and a fixed tip, led at random with its wrist over a floor: links are
/// where joints have them but for less than a contact distance, and never in anything.
TEST(Grip, LinksStayOnTheirJointsAndApart) {
  HapticTool tool{.name = "hand", .shape = make_box({0.04, 0.03, 0.02})};
  tool.X_WB.position.z() = 0.05;
  DeviceMapping mapping;
  for (std::size_t k = 0; k < 3; ++k) {
    tool.joints.push_back({.name = "joint", .lower = -0.5, .upper = 1.6, .stiffness = 0.5});
    HapticLink link{.name = "link",
                    .shape = box_off({0.03, 0.01, 0.01}, {0.02, 0.0, 0.0}),
                    .X_PJ = {{k == 0 ? 0.022 : 0.04, 0.0, 0.0}, Eigen::Quaterniond::Identity()},
                    .axis = k == 0 ? Vector3d(0.0, 0.6, 0.8) : Vector3d(0.0, 1.0, 0.0),
                    .joint = k,
                    .turn = 1.0};
    if (k > 0) {
      link.parent = k - 1;
    }
    tool.links.push_back(link);
    mapping.grips.push_back({.joints = {{.joint = k, .open = -0.4, .closed = 1.5}}});
  }
  tool.links.push_back({.name = "tip",
                        .shape = box_off({0.004, 0.012, 0.012}, {0.0, 0.0, 0.0}),
                        .parent = 2,
                        .X_PJ = {{0.04, 0.0, 0.0}, Eigen::Quaterniond::Identity()}});
  HapticScene scene = grip_scene(std::move(tool));
  scene.bodies.push_back(body_at("floor", make_box({0.5, 0.5, 0.1}), {0.0, 0.0, -0.05}));
  GripSession session(std::move(scene), std::move(mapping));
  test::Random random(3);
  std::array<double, 3> from{};
  std::array<double, 3> to{};
  Vector3d at = Vector3d::Zero();
  std::size_t touched = 0;
  constexpr int kTicks = test::rounds(6000, 1200);
  for (int k = 0; k < kTicks; ++k) {
    if (k % 300 == 0) {
      from = to;
      for (double& value : to) {
        value = random.uniform(0.0, 1.0);
      }
      at = {random.uniform(-0.02, 0.02), 0.0, random.uniform(-0.05, 0.02)};
    }
    const double s = std::min(1.0, (k % 300) / 150.0);
    for (std::size_t grip = 0; grip < 3; ++grip) {
      session.device_.grips[grip] = from[grip] + s * (to[grip] - from[grip]);
    }
    session.step(at, session.device_.grips[0]);
    touched += session.cycle().contacts > 0 ? 1 : 0;
    // Members: hand, floor, three links, the tip.
    Pose parent = session.pose(0);
    for (std::size_t link = 0; link < 4; ++link) {
      const Vector3d origin =
          parent.position + parent.rotation * Vector3d(link == 0 ? 0.022 : 0.04, 0.0, 0.0);
      ASSERT_LT((session.pose(2 + link).position - origin).norm(), kContactDistance) << k;
      ASSERT_GT(session.gap(1, 2 + link), 0.0) << k;
      parent = session.pose(2 + link);
    }
    ASSERT_GT(session.gap(0, 4), 0.0) << k;
    ASSERT_GT(session.gap(0, 5), 0.0) << k;
    ASSERT_GT(session.gap(2, 4), 0.0) << k;
  }
  EXPECT_GT(touched, std::size_t{kTicks / 6});
  EXPECT_GT(session.least_clearance(), 0.0);
}

/// Jaws that open or shut by 34 mm in each cycle, while the wrist spins by 0.05 rad.
TEST(Grip, JawsStayOnTheirRailsWhileTheWristSpins) {
  ContactLoop loop(grip_scene(jaws()));
  const auto half_way = [](const HapticPiece& piece) {
    const Vector3d half = 0.5 * piece.rotation_vector;
    const Vector3d axis = half.norm() > 0.0 ? Vector3d(half.normalized()) : Vector3d::UnitZ();
    return Pose{piece.X_WB.position + 0.5 * piece.translation,
                Eigen::Quaterniond(Eigen::AngleAxisd(half.norm(), axis)) * piece.X_WB.rotation};
  };
  for (int k = 1; k <= 40; ++k) {
    const double shut = k % 2 == 0 ? 0.0 : kJawWay;
    const Pose target{Vector3d::Zero(),
                      Eigen::Quaterniond(Eigen::AngleAxisd(0.05 * k, Vector3d::UnitZ()))};
    const HapticCycle& cycle =
        loop.advance({.poses = std::array{target}, .joints = std::array{shut, shut}}, 1e-3, 0);
    const std::vector<HapticPiece>& palm = cycle.members[0].pieces;
    const std::vector<HapticPiece>& jaw = cycle.members[1].pieces;
    ASSERT_EQ(palm.size(), jaw.size());
    for (std::size_t p = 0; p < palm.size(); ++p) {
      const Pose X_WP = half_way(palm[p]);
      const Vector3d p_PL = X_WP.rotation.conjugate() * (half_way(jaw[p]).position - X_WP.position);
      EXPECT_LT(std::hypot(p_PL.y(), p_PL.z() + 0.012), kContactDistance) << k;
    }
  }
}

// By more than half a turn the shortest way would lead round behind the plate, beyond the limits.
TEST(Grip, AFingerThatJumpsByMoreThanHalfATurnStaysWithinItsLimits) {
  for (const bool has_plate : {true, false}) {
    HapticTool tool = gripper();
    tool.links.pop_back();
    tool.joints.pop_back();
    tool.joints[0].lower = -1.7;
    tool.joints[0].upper = 1.7;
    tool.joints[0].start = -1.7;
    tool.joints[0].stiffness = 0.05;  // The wrist gives way by 2 mm.
    HapticScene scene = grip_scene(tool);
    if (has_plate) {
      scene.bodies.push_back(
          body_at("plate", make_box({1e-4, 0.1, 0.03}), Vector3d(0.04, 0.0, -0.06), 0.0));
    }
    DeviceMapping mapping;
    mapping.grips.push_back({.joints = {{.joint = 0, .open = -1.7, .closed = 1.7}}});
    GripSession session(scene, mapping);
    session.step(Vector3d::Zero(), 0.0, 10);
    const std::size_t finger = has_plate ? 2 : 1;
    for (int k = 0; k < 200; ++k) {
      session.step(Vector3d::Zero(), 1.0, 4);
      const Eigen::AngleAxisd turn(session.pose(0).rotation.normalized().conjugate() *
                                   session.pose(finger).rotation.normalized());
      const double angle = turn.angle() * turn.axis().y();
      ASSERT_NEAR(angle, session.joint(0), 1e-3) << k;
    }
    EXPECT_GT(session.least_clearance(), 0.0);
    if (has_plate) {
      EXPECT_LT(session.joint(0), 0.1);
    } else {
      EXPECT_NEAR(session.joint(0), 1.7, 1e-6);
    }
  }
}

// A surface closes on a finger, and then another one from nearly the opposite side. Without a cut
// the effort was 1e15 N.
TEST(Grip, EffortsOfContactsThatContradictEachOtherStayWithinTheSprings) {
  ContactLoop contacts(grip_scene(jaws(0.5)));
  ForceLoop forces(contacts.scene(), {one_grip(kJawWay)});
  (void)contacts.advance({.poses = std::array{Pose{}}, .joints = std::array{0.0, 0.0}}, 1e-3, 0);
  HapticContactSet set = contacts.contact_set();
  const double speed = 1.0;  // [m/s]
  for (std::uint32_t k = 0; k < 2; ++k) {
    HapticContact& contact = set.contacts[k];
    const double side = k == 0 ? 1.0 : -1.0;
    contact.link = 0;
    contact.normal = Vector3d(side, 1e-12, 7e-13 * side).normalized();
    contact.point = {0.04 - 0.005 * side, 0.0, -0.06};
    contact.gap = kContactDistance;
    contact.friction = 0.5;
    contact.surface_velocity = {side * speed, 0.0, 0.0};
  }
  DeviceState device;
  device.status = DeviceStatus::live;
  device.grips[0] = 1.0;
  bool is_unsolved = false;
  std::int64_t now_ns = 0;
  for (int k = 0; k < 400; ++k) {
    set.count = k < 200 ? 1 : 2;
    set.sequence += 1;
    set.stamp_ns = now_ns;
    set.lasted_ns = 0;
    now_ns += 250'000;
    const ForceTick& tick = forces.tick(now_ns, set, std::array{device});
    const auto unsolved = static_cast<std::uint32_t>(ForceFault::unsolved);
    is_unsolved = is_unsolved || (tick.tools[0].faults & unsolved) != 0;
    // Both springs are stretched by the way of the jaws, and the surface goes on for a tick.
    const double most = kJawStiffness * (std::sqrt(2.0) * kJawWay + speed * 250e-6);
    ASSERT_LE(std::abs(tick.joint_efforts[0]), 1.001 * most) << k;
    ASSERT_LE(std::abs(tick.joint_efforts[1]), 1.001 * most) << k;
  }
  EXPECT_TRUE(is_unsolved);
}

TEST(Grip, ValuesBeyondTheirRangeLeadNoFarther) {
  GripSession session(grip_scene(gripper()), one_grip(0.3));
  session.step(Vector3d::Zero(), 3.0, 2000);
  EXPECT_NEAR(session.joint(0), 0.3, 1e-6);
}

TEST(Grip, FollowsAButtonWhereTheDeviceHasNoGrips) {
  DeviceMapping mapping = one_grip();
  mapping.grips[0].button = 2;
  mapping.grips[0].seconds = 0.25;
  GripSession session(grip_scene(gripper()), mapping);
  session.step(Vector3d::Zero(), 7.0, 100);  // The device's own value does not count.
  EXPECT_EQ(session.joint(0), 0.0);
  session.device_.buttons = 4;
  session.step(Vector3d::Zero(), 7.0, 500);  // Half of the time: half way.
  EXPECT_NEAR(session.joint(0), 0.45, 0.01);
  session.device_.buttons = 0;
  session.step(Vector3d::Zero(), 7.0, 1000);
  EXPECT_NEAR(session.joint(0), 0.0, 1e-6);
}

TEST(Grip, NothingActsOnceTheDeviceIsLostOrMakesNoSense) {
  GripSession session(around_a_cube_of(0.0), one_grip(kJawWay));
  session.step(Vector3d::Zero(), 0.0, 1000);
  session.step(Vector3d::Zero(), 1.0, 800);
  const double held = session.joint(0);
  EXPECT_LT(session.step(Vector3d::Zero(), 1.0).joint_efforts[0], -0.1);
  const ForceTick& tick =
      session.step(Vector3d::Zero(), std::numeric_limits<double>::quiet_NaN(), 40);
  EXPECT_EQ(tick.tools[0].faults, static_cast<std::uint32_t>(ForceFault::not_finite));
  EXPECT_EQ(tick.joint_efforts[0], 0.0);
  EXPECT_EQ(tick.tools[0].command.grips[0], 0.0);
  EXPECT_NEAR(session.joint(0), held, 1e-6);  // The fingers stay.
}

// A contact that pushes a finger while the clutch is pressed displaces the finger for that time
// only.
TEST(Grip, FingersStayWhereTheClutchFoundThem) {
  DeviceMapping mapping = one_grip();
  mapping.clutch_button = 0;
  const HapticScene scene = grip_scene(gripper());
  ForceLoop forces(scene, {mapping});
  HapticContactSet set;
  set.sequence = 1;
  DeviceState device;
  device.status = DeviceStatus::live;
  device.grips[0] = 0.5;
  (void)forces.tick(0, set, std::array{device});
  device.buttons = 1;
  set.joints[0] = 0.4;
  EXPECT_EQ(forces.tick(250'000, set, std::array{device}).joint_targets[0], 0.4);
  set.joints[0] = 0.1;
  set.stamp_ns = 250'000;
  EXPECT_EQ(forces.tick(500'000, set, std::array{device}).joint_targets[0], 0.4);
}

// As the force does: by its slew, 2000 of the limit of 1 J a second.
TEST(Grip, EffortsEndBySlewAtTheClutch) {
  DeviceMapping mapping = one_grip(kJawWay);
  mapping.clutch_button = 0;
  GripSession session(around_a_cube_of(0.0), mapping);
  session.step(Vector3d::Zero(), 0.0, 1000);
  const double held = session.step(Vector3d::Zero(), 1.0, 1000).tools[0].command.grips[0];
  EXPECT_LT(held, -0.5);
  session.device_.buttons = 1;
  const ForceTick& first = session.step(Vector3d::Zero(), 1.0);
  EXPECT_NEAR(first.tools[0].command.grips[0], held + 0.5, 1e-12);
  EXPECT_NE(first.tools[0].faults & static_cast<std::uint32_t>(ForceFault::slewed), 0U);
  EXPECT_EQ(session.step(Vector3d::Zero(), 1.0, 3).tools[0].command.grips[0], 0.0);
}

TEST(Grip, RefusesJointsThatMakeNoSense) {
  const auto refusal = [](auto change) {
    HapticScene scene = grip_scene(gripper());
    change(scene.tools[0]);
    try {
      const ContactLoop loop(scene);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(refusal([](HapticTool& tool) {
              tool.joints[1].start = 2.0;
            }).find("joint \"left\": it starts at 2"),
            std::string::npos);
  EXPECT_NE(refusal([](HapticTool& tool) { tool.links[0].parent = 0; }).find("\"hand/right\""),
            std::string::npos);
  EXPECT_NE(refusal([](HapticTool& tool) {
              tool.joints.push_back({.name = "idle"});
            }).find("\"idle\" moves no link"),
            std::string::npos);
  EXPECT_EQ(refusal([](HapticTool&) {}), "none");
  EXPECT_THROW(ForceLoop(grip_scene(gripper()),
                         {{.grips = {{.joints = {{.joint = 0}}}, {.joints = {{.joint = 0}}}}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
