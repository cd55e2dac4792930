// The friction of surfaces that move below a tool: it drags a tool that slides, and carries one
// that sticks.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/motion/motion.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kSpring = 1000.0;  // [N/m]
constexpr double kCourse = 0.5;     // [s]

DeviceState hand_held_at(const Vector3d& position) {
  DeviceState device;
  device.X_DH.position = position;
  device.status = DeviceStatus::live;
  return device;
}

/// A ball of 1 cm, 2 mm above a plate that has a course. It turns as if on a stiff shaft.
HapticScene ball_over_plate(const Motion& course, double friction, double x = 0.0) {
  HapticScene scene;
  scene.tools.push_back(tool_at("ball", make_sphere(0.01), {x, 0.0, 0.012}, friction));
  scene.tools[0].coupling.angular_stiffness = 100.0;
  scene.bodies.push_back(
      body_at("plate", make_box({10.0, 10.0, 0.04}), Vector3d::Zero(), friction));
  scene.bodies[0].course = course;
  scene.duration = kCourse;
  scene.contact_distance = 1e-6;
  return scene;
}

HapticSession session_of(const HapticScene& scene, double contact_rate) {
  return HapticSession(
      scene, {.contact_rate = contact_rate, .forces = {.limits = {.force = 100.0, .ramp_ns = 0}}});
}

double seconds_of(const HapticSession& session) {
  return 1e-9 * static_cast<double>(session.time_ns());
}

/// [m]  The height to which a hand presses the ball 3 mm into the plate, within 0.1 s.
double pressed(double seconds) { return -0.005 * std::min(1.0, seconds / 0.1); }

Motion plate_at(const Vector3d& velocity) {
  return Motion::constant_velocity({Vector3d(0.0, 0.0, -0.02), Eigen::Quaterniond::Identity()},
                                   kCourse * velocity);
}

// Closed form: mu N along the velocity of the surface past the tool, whichever of the two moves.
TEST(MovingSurface, DragsAToolThatSlidesByConstantFriction) {
  constexpr double kFriction = 0.3;
  for (const double rate : {1000.0, 250.0}) {
    for (const double of_plate : {0.01, 0.1, 1.0, 2.0}) {
      for (const double of_hand : {0.0, 0.5 * of_plate, -of_plate, 1.5 * of_plate}) {
        HapticSession session =
            session_of(ball_over_plate(plate_at({of_plate, 0.0, 0.0}), kFriction), rate);
        for (int k = 0; k < 1800; ++k) {
          const double seconds = seconds_of(session);
          const Vector3d hand(of_hand * seconds, 0.0, pressed(seconds));
          const Vector3d force = session.step(std::array{hand_held_at(hand)}).tools[0].force_W;
          if (k > 1300) {
            const double along = of_hand > of_plate ? -1.0 : 1.0;
            ASSERT_NEAR(force.z(), 3.0, 0.05);
            ASSERT_NEAR(force.x(), along * kFriction * force.z(), 0.01)
                << rate << ", " << of_plate << ", " << of_hand << ", " << k;
          }
        }
      }
    }
  }
}

TEST(MovingSurface, DragsAlongItsTurn) {
  constexpr double kFriction = 0.3;
  const Motion turn =
      Motion::constant_velocity({Vector3d(0.0, 0.0, -0.02), Eigen::Quaterniond::Identity()},
                                Vector3d::Zero(), Vector3d(0.0, 0.0, 20.0 * kCourse));
  HapticSession session = session_of(ball_over_plate(turn, kFriction, 0.1), 1000.0);
  for (int k = 0; k < 1800; ++k) {
    const Vector3d hand(0.0, 0.0, pressed(seconds_of(session)));
    const Vector3d force = session.step(std::array{hand_held_at(hand)}).tools[0].force_W;
    if (k > 1300) {
      ASSERT_NEAR(force.y(), kFriction * force.z(), 0.02) << k;
      ASSERT_NEAR(force.x(), 0.0, 0.02) << k;
    }
  }
}

// Closed form: the plate carries the ball, and the force is that of its spring at each tick.
TEST(MovingSurface, CarriesAToolThatSticks) {
  constexpr double kBegin = 0.2;  // [s]
  constexpr double kSpeed = 0.02;
  for (const double rate : {1000.0, 250.0}) {
    const Pose low{Vector3d(0.0, 0.0, -0.02), Eigen::Quaterniond::Identity()};
    const Pose far{Vector3d(kSpeed * (kCourse - kBegin), 0.0, -0.02),
                   Eigen::Quaterniond::Identity()};
    const Motion course =
        Motion::waypoints(std::array{0.0, kBegin / kCourse, 1.0}, std::array{low, low, far});
    HapticSession session = session_of(ball_over_plate(course, 3.0), rate);
    double before = 0.0;
    for (int k = 0; k < 1600; ++k) {
      const double seconds = seconds_of(session);
      const Vector3d hand(0.0, 0.0, pressed(seconds));
      const Vector3d force = session.step(std::array{hand_held_at(hand)}).tools[0].force_W;
      if (seconds < kBegin) {
        before = force.x();
      } else if (seconds > kBegin + 0.01) {
        ASSERT_NEAR(force.x() - before, kSpring * kSpeed * (seconds - kBegin), 0.01)
            << rate << ", " << k;
      }
    }
  }
}

// A tool that was carried and begins to slide is felt without a step back.
TEST(MovingSurface, NeverDragsBackwards) {
  HapticSession session = session_of(ball_over_plate(plate_at({0.2, 0.0, 0.0}), 0.3), 1000.0);
  for (int k = 0; k < 1800; ++k) {
    const Vector3d hand(0.0, 0.0, pressed(seconds_of(session)));
    const Vector3d force = session.step(std::array{hand_held_at(hand)}).tools[0].force_W;
    ASSERT_GE(force.x(), -1e-6) << k;
    ASSERT_LE(force.x(), 0.3 * force.z() + 1e-6) << k;
  }
}

}  // namespace
}  // namespace firstcontact
