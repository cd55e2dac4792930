// A ball on an arm in a groove: friction holds it, and does nothing else.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/geometry/primitives.h>
#include <firstcontact/haptic_sessions/haptic_session.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStiffness = 1000.0;  // [N/m]

/// A ball that a hand holds by a point above it, and presses into a groove along y while it tilts.
struct Pen {
  double friction = 0.0;           // [-]
  double lean = 0.0;               // [rad]  Of both walls.
  double radius = 0.0;             // [m]
  double arm = 0.0;                // [m]  From the middle of the ball to the hand.
  double angular_stiffness = 0.0;  // [N m/rad]
  double tilt = 0.0;               // [rad]
  Vector3d axis = Vector3d::UnitX();
  double press = 0.0;  // [m]
  int ticks = 300;     // Of the tilt.
};

HapticScene groove_of(const Pen& pen) {
  HapticScene scene;
  for (const double side : {1.0, -1.0}) {
    const Vector3d normal(side * std::sin(pen.lean), 0.0, std::cos(pen.lean));
    const Vector3d up(-side * std::cos(pen.lean), 0.0, std::sin(pen.lean));
    HapticBody wall = body_at(side > 0.0 ? "left" : "right", make_box({0.36, 0.4, 0.1}),
                              -0.05 * normal + 0.15 * up, pen.friction);
    wall.X_WB.rotation = Eigen::AngleAxisd(side * pen.lean, Vector3d::UnitY());
    scene.bodies.push_back(wall);
  }
  HapticTool ball = tool_at("ball", make_sphere(pen.radius),
                            {0.0, 0.0, pen.radius / std::cos(pen.lean) + 1e-3}, pen.friction);
  ball.p_BC = {0.0, 0.0, pen.arm};
  ball.coupling = {.stiffness = kStiffness, .angular_stiffness = pen.angular_stiffness};
  scene.tools.push_back(ball);
  scene.contact_distance = 1e-6;
  return scene;
}

/// A session with a pen.
class PenSession {
 public:
  explicit PenSession(const Pen& pen) : pen_(pen), session_(groove_of(pen), options()) {
    for (int k = 0; k <= 500; ++k) {
      go(0.0, down() * k / 500.0);
    }
  }

  /// Holds the hand at a tilt, and moved from its start by z.
  const ToolTick& go(double tilt, double z) {
    const Vector3d arm(0.0, 0.0, pen_.arm);
    const Quaterniond turn(Eigen::AngleAxisd(tilt, pen_.axis.normalized()));
    const DeviceState hand{.X_DH = {turn * arm - arm + z * Vector3d::UnitZ(), turn},
                           .time_ns = session_.time_ns(),
                           .sequence = ++samples_,
                           .status = DeviceStatus::live};
    tick_ = session_.step(std::array{hand}).tools[0];
    return tick_;
  }

  /// Tilts the pressed pen, and waits for a while.
  void tilt() {
    for (int k = 1; k <= pen_.ticks + 400; ++k) {
      go(pen_.tilt * std::min(1.0, static_cast<double>(k) / pen_.ticks), down());
    }
  }

  [[nodiscard]] double down() const { return -(1e-3 + pen_.press); }
  [[nodiscard]] const Pose& pose() const { return session_.contacts().pose(0); }
  [[nodiscard]] const HapticContactSet& contacts() const { return session_.contact_set(); }

  /// [N]  Computes the force of the spring at the place of the tool.
  [[nodiscard]] Vector3d spring() const { return kStiffness * stretch(); }

  /// [J]  Computes the energy of the spring.
  [[nodiscard]] double energy() const {
    const double turn = pose().rotation.angularDistance(tick_.target.rotation);
    return 0.5 * kStiffness * stretch().squaredNorm() + 0.5 * pen_.angular_stiffness * turn * turn;
  }

 private:
  static HapticSessionOptions options() {
    HapticSessionOptions options;
    options.forces.limits.force = 1000.0;
    options.forces.limits.torque = 100.0;
    return options;
  }

  [[nodiscard]] Vector3d stretch() const {
    const Vector3d arm(0.0, 0.0, pen_.arm);
    return pose().position + pose().rotation * arm - tick_.target.position -
           tick_.target.rotation * arm;
  }

  Pen pen_;
  HapticSession session_;
  ToolTick tick_;
  std::uint64_t samples_ = 0;
};

// The walls lean by 63 degrees: with a friction of 0.5 and more a ball that is moved straight out
// would be held by its friction.
TEST(Groove, HoldsAPressedBallAtItsDistanceWithAnyFriction) {
  for (const double friction : {0.0, 0.2, 0.4, 0.5, 0.6, 0.8, 1.0, 2.0}) {
    SCOPED_TRACE(friction);
    PenSession session({.friction = friction,
                        .lean = 1.1,
                        .radius = 0.01,
                        .arm = 0.012,
                        .angular_stiffness = 0.05,
                        .tilt = 0.34,
                        .press = 0.03});
    session.tilt();
    const Vector3d force = session.go(0.34, session.down()).force_W;
    EXPECT_LT((force - session.spring()).norm(), 1e-3 * force.norm());
    ASSERT_EQ(session.contacts().count, 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_GT(session.contacts().contacts[k].gap, 0.4 * 1e-6);
    }
    // It follows the hand out.
    for (int k = 0; k < 2000; ++k) {
      session.go(0.34, session.down() + 0.05 * std::min(1.0, k / 1000.0));
    }
    EXPECT_LT(session.spring().norm(), 1e-9);
  }
}

// The ball is small, and the hand holds it by a long arm: the tool turns about a point far from it.
TEST(Groove, HoldsABallOnALongArmAtItsDistance) {
  Pen pen{.friction = 1.2,
          .lean = 0.6,
          .radius = 0.001,
          .arm = 0.05,
          .angular_stiffness = 0.01,
          .tilt = 0.61,
          .axis = {1.0, 0.54, 0.68},
          .press = 0.01,
          .ticks = 2000};
  for (const double friction : {0.8, 1.2, 2.0}) {
    SCOPED_TRACE(friction);
    pen.friction = friction;
    PenSession session(pen);
    session.tilt();
    const Vector3d force = session.go(pen.tilt, session.down()).force_W;
    EXPECT_LT((force - session.spring()).norm(), 1e-3 * force.norm());
    ASSERT_GT(session.contacts().count, 0U);
    EXPECT_GT(session.contacts().contacts[0].gap, 0.4 * 1e-6);
  }
}

// A plan that leaves out how the arm bends the energy of the spring goes many times too far here.
TEST(Groove, RestsWhereTheHandRests) {
  const auto pen = [](double friction, double lean, double radius, double arm, double turning,
                      double tilt, const Vector3d& axis, int ticks) {
    return Pen{friction, lean, radius, arm, turning, tilt, axis, 0.03, ticks};
  };
  const Vector3d along = Vector3d::UnitX();
  for (const Pen& held : {pen(0.3, 0.92, 0.01, 0.012, 0.01, 0.74, along, 800),
                          pen(0.2, 0.76, 0.01, 0.005, 0.01, 0.28, along, 2000),
                          pen(0.3, 0.82, 0.003, 0.005, 0.01, 0.69, {1.0, 0.3, -0.67}, 300),
                          pen(0.2, 1.04, 0.01, 0.012, 0.01, 0.31, along, 800),
                          pen(0.5, 1.06, 0.01, 0.012, 0.01, 0.19, along, 300),
                          pen(0.5, 1.05, 0.01, 0.012, 0.01, 0.67, {1.0, 0.24, 0.94}, 300),
                          pen(0.7, 0.54, 0.001, 0.005, 0.05, 0.73, along, 800)}) {
    SCOPED_TRACE(std::to_string(held.friction) + " " + std::to_string(held.lean));
    PenSession session(held);
    session.tilt();
    double least = session.energy();
    const auto rest = [&](int ticks) {
      for (int k = 0; k < ticks; ++k) {
        session.go(held.tilt, session.down());
        least = std::min(least, session.energy());
        // A tool that is pushed back to its distance stretches the spring by as much.
        ASSERT_LT(session.energy() - least, session.spring().norm() * 1e-6);
      }
    };
    rest(2000);
    const Pose held_at = session.pose();
    rest(6000);
    EXPECT_EQ((session.pose().position - held_at.position).norm(), 0.0);
    EXPECT_EQ(session.pose().rotation.angularDistance(held_at.rotation), 0.0);
    const Vector3d force = session.go(held.tilt, session.down()).force_W;
    EXPECT_LT((force - session.spring()).norm(), 1e-3 * force.norm());
  }
}

}  // namespace
}  // namespace firstcontact
