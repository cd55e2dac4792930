// A handle moves the centre of its tool and turns the tool about it, wherever the body's origin is.

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/haptic_session.h>

#include "haptics/grip_scenes.h"
#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

/// A cube of 2 cm, 2 mm above a floor, whose origin is beside it.
HapticScene cube_off(const Vector3d& centre) {
  HapticScene scene;
  scene.tools.push_back(
      tool_at("cube", box_off({0.02, 0.02, 0.02}, centre), Vector3d(0.0, 0.0, 0.012) - centre));
  scene.tools[0].p_BC = centre;
  scene.bodies.push_back(body_at("floor", make_box({9.0, 9.0, 0.1}), {0.0, 0.0, -0.05}));
  scene.contact_distance = 1e-6;
  return scene;
}

/// Steps a session with a hand that goes to a pose within a time, and stays.
class TurnedHand {
 public:
  explicit TurnedHand(HapticScene scene, const HapticSessionOptions& options = {})
      : session_(std::move(scene), options) {}

  ForceTick go(const Vector3d& to, const Vector3d& axis, double angle, int ticks,
               std::uint32_t buttons = 0) {
    ForceTick last;
    for (int k = 1; k <= ticks; ++k) {
      const double part = std::min(1.0, 2.0 * k / ticks);
      state_.X_DH.position = from_.position + part * (to - from_.position);
      state_.X_DH.rotation =
          Eigen::Quaterniond(Eigen::AngleAxisd(part * angle, axis)) * from_.rotation;
      state_.status = DeviceStatus::live;
      state_.buttons = buttons;
      state_.time_ns = session_.time_ns();
      ++state_.sequence;
      last = session_.step(std::array{state_});
    }
    from_ = state_.X_DH;
    return last;
  }

  [[nodiscard]] Vector3d centre() const { return session_.contact_set().p_WC[0]; }
  HapticSession& session() { return session_; }

 private:
  HapticSession session_;
  DeviceState state_;
  Pose from_;
};

TEST(ToolCentre, AHandleThatOnlyTurnsLeavesTheCentre) {
  for (const Vector3d& centre : {Vector3d(0.1, 0.0, 0.0), Vector3d(1.0, -0.5, 0.3)}) {
    TurnedHand hand(cube_off(centre));
    const ForceTick tick = hand.go({0.0, 0.0, 0.05}, {0.0, 0.6, 0.8}, 0.5 * std::numbers::pi, 2000);
    EXPECT_LT((hand.centre() - Vector3d(0.0, 0.0, 0.062)).norm(), 1e-9);
    EXPECT_LT((tick.tools[0].centre - hand.centre()).norm(), 1e-9);
    const Pose& target = tick.tools[0].target;
    EXPECT_LT((target.position + target.rotation * centre - hand.centre()).norm(), 1e-9);
  }
}

// The same hand feels the same, wherever the origin of the mesh is.
TEST(ToolCentre, TheOriginOfTheMeshIsNotFelt) {
  const auto felt = [](const Vector3d& centre) {
    TurnedHand hand(cube_off(centre));
    (void)hand.go({0.0, 0.0, 0.01}, {1.0, 2.0, 0.0}, 0.1, 1000);
    return hand.go({0.004, 0.0, -0.005}, Vector3d::UnitY(), 0.05, 2000).tools[0].command;
  };
  const ForceCommand here = felt(Vector3d::Zero());
  const ForceCommand beside = felt({1.0, 0.0, 0.0});
  ASSERT_GT(here.force_D.norm(), 3.0);
  ASSERT_GT(here.torque_D.norm(), 1e-3);
  EXPECT_LT((here.force_D - beside.force_D).norm(), 1e-3);
  EXPECT_LT((here.torque_D - beside.torque_D).norm(), 1e-4);
}

// Closed form: a flat press has the spring's force and no torque about the centre.
TEST(ToolCentre, AFlatPressHasNoTorqueAboutTheCentre) {
  TurnedHand hand(cube_off({1.0, 0.0, 0.0}));
  const ToolTick tick = hand.go({0.0, 0.0, -0.007}, Vector3d::UnitX(), 0.0, 2000).tools[0];
  EXPECT_NEAR(tick.force_W.z(), 5.0, 0.01);
  EXPECT_LT(tick.torque_W.norm(), 1e-6);
  EXPECT_EQ(tick.faults, 0U);
}

TEST(ToolCentre, TheClutchTakesUpTheCentreWhereItIs) {
  TurnedHand hand(cube_off({0.2, 0.0, 0.0}), {.mappings = {{.clutch_button = 0}}});
  (void)hand.go({0.0, 0.0, 0.05}, Vector3d::UnitX(), 0.7, 1000);
  const Vector3d before = hand.centre();
  (void)hand.go({0.3, 0.1, 0.0}, Vector3d::UnitZ(), -0.9, 400, 1U);
  EXPECT_LT((hand.centre() - before).norm(), 1e-6);
  (void)hand.go({0.3, 0.1, 0.0}, Vector3d::UnitZ(), 0.8, 1000);
  EXPECT_LT((hand.centre() - before).norm(), 1e-6);
}

TEST(ToolCentre, ADeviceThatSetsRatesTurnsAboutTheCentre) {
  HapticSession session(cube_off({0.1, 0.0, 0.0}), {.mappings = {{.kind = DeviceKind::rate}}});
  DeviceState state;
  state.status = DeviceStatus::live;
  state.angular_rate = {0.0, 0.0, 1.0};
  for (int k = 0; k < 2000; ++k) {
    (void)session.step(std::array{state});
  }
  EXPECT_LT((session.contact_set().p_WC[0] - Vector3d(0.0, 0.0, 0.012)).norm(), 1e-9);
  const Eigen::AngleAxisd turned(session.contact_set().X_WB[0].rotation);
  EXPECT_NEAR(turned.angle(), 0.5, 2e-3);
}

}  // namespace
}  // namespace firstcontact
