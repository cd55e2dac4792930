// Both loops in virtual time.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptic_sessions/timing_histogram.h>
#include <firstcontact/motion/motion.h>

#include "haptics/haptic_scenes.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

DeviceState live_at(const Vector3d& position) {
  DeviceState device;
  device.X_DH.position = position;
  device.status = DeviceStatus::live;
  return device;
}

/// Samples of a device, one each tick.
struct Sampled {
  DeviceState operator()(const Vector3d& position, std::int64_t now_ns) {
    DeviceState state = live_at(position);
    state.time_ns = now_ns;
    state.sequence = ++count;
    return state;
  }
  std::uint64_t count = 0;
};

TEST(HapticSession, RunsCyclesAtTheirRate) {
  HapticSession session(cube_on_floor());
  int cycles = 0;
  for (int k = 0; k < 4000; ++k) {
    EXPECT_EQ(session.time_ns(), 250'000 * k);
    (void)session.step(std::array{live_at(Vector3d::Zero())});
    cycles += session.cycle() != nullptr ? 1 : 0;
  }
  EXPECT_EQ(cycles, 1000);
}

TEST(HapticSession, KeepsTheContactRateWhereATickIsNoWholeNumberOfNanoseconds) {
  const auto ticks_of = [](double force_rate, double contact_rate, std::int64_t latency_ns) {
    const HapticSession session(
        cube_on_floor(),
        {.force_rate = force_rate, .contact_rate = contact_rate, .contact_latency_ns = latency_ns});
    return session.cycle_period_ns() / session.force_period_ns();
  };
  EXPECT_EQ(ticks_of(3000.0, 1000.0, 0), 3);
  EXPECT_EQ(ticks_of(7000.0, 1000.0, 0), 7);
  EXPECT_EQ(ticks_of(9000.0, 1000.0, 0), 9);
  EXPECT_EQ(ticks_of(333.0, 111.0, 0), 3);
  EXPECT_EQ(ticks_of(8000.0, 3000.0, 0), 3);  // No faster than asked.
  EXPECT_EQ(ticks_of(3000.0, 3000.0, 1'000'000), 3);
  EXPECT_EQ(ticks_of(4000.0, 1000.0, 1'000'001), 5);
}

TEST(HapticSession, IsTheSameOnEveryRun) {
  const auto forces = [] {
    HapticSession session(peg_over_hole(1e-4, 0.2));
    std::vector<double> all;
    for (int k = 0; k < 1200; ++k) {
      const ForceTick& tick = session.step(
          std::array{live_at({1e-3 * std::sin(0.01 * k), 1e-4, -5e-5 * std::min(k, 900)})});
      all.push_back(tick.tools[0].command.force_D.x());
      all.push_back(tick.tools[0].command.torque_D.y());
    }
    return all;
  };
  EXPECT_EQ(forces(), forces());
}

// The contact loop hangs for a while: no kick, and no force of long ago.
TEST(HapticSession, BoundsTheForceWhileTheContactLoopStalls) {
  for (const std::int64_t stall_ms : {5, 50, 500}) {
    HapticSessionOptions options;
    options.contact_latency_ns = 1'000'000 * stall_ms;
    HapticSession session(cube_on_floor(), options);
    Sampled sampled;
    double greatest = 0.0;
    Vector3d last = Vector3d::Zero();
    for (int k = 0; k < 8000; ++k) {
      const double press = -0.012 + 1e-3 * std::sin(0.004 * k);
      const ForceTick& tick =
          session.step(std::array{sampled({0.0, 0.0, press}, session.time_ns())});
      const Vector3d& force = tick.tools[0].command.force_D;
      ASSERT_LE((force - last).norm(), 5.0 + 1e-9);
      greatest = std::max(greatest, force.norm());
      if (tick.age_ns >= 150'000'000) {
        ASSERT_LT(force.norm(), 1e-12) << stall_ms;
      }
      last = force;
    }
    EXPECT_LE(greatest, 3.2) << stall_ms;
    EXPECT_GE(greatest, stall_ms < 500 ? 1.0 : 0.0) << stall_ms;
  }
}

TEST(HapticSession, DeviceThatStartsInsideFeelsARampAndNoKick) {
  HapticSession session(cube_on_floor());
  Vector3d last = Vector3d::Zero();
  for (int k = 0; k < 2000; ++k) {
    const ForceTick& tick = session.step(std::array{live_at({0.0, 0.0, -0.015})});
    ASSERT_LE((tick.tools[0].command.force_D - last).norm(), 0.05) << k;
    last = tick.tools[0].command.force_D;
  }
  EXPECT_NEAR(last.z(), 5.0, 0.05);
  EXPECT_GT(session.contacts().pose(0).position.z(), 0.02);
}

// The contacts of a cycle are found where the device is when they are felt, in the mean.
TEST(HapticSession, MeetsTheDeviceWhenContactsAreFelt) {
  for (const std::int64_t latency_ns : {0, 1'000'000}) {
    HapticSessionOptions options;
    options.contact_latency_ns = latency_ns;
    HapticSession session(cube_on_floor(), options);
    Sampled sampled;
    double mean = 0.0;
    constexpr int kTicks = 400;
    for (int k = 0; k < 2 * kTicks; ++k) {
      const double x = 0.3 * 1e-9 * static_cast<double>(session.time_ns());
      const ForceTick& tick = session.step(std::array{sampled({x, 0.0, 0.0}, session.time_ns())});
      ASSERT_EQ(tick.tools[0].command.force_D, Vector3d::Zero());
      if (k >= kTicks) {
        mean += (session.contact_set().X_WB[0].position.x() - x) / kTicks;
      }
    }
    EXPECT_NEAR(mean, 0.0, 1e-9) << latency_ns;
  }
}

// The hand brakes above the floor, and the led tool touches it: no force, exactly.
TEST(HapticSession, FeelsNothingWhereOnlyTheLedToolTouches) {
  HapticSessionOptions options;
  options.contact_latency_ns = 1'000'000;
  HapticSession session(cube_on_floor(), options);
  Sampled sampled;
  std::uint32_t touched = 0;
  for (int k = 0; k < 8000; ++k) {
    // At 8 Hz, at least 20 um above the floor; the tool rests at 14 um.
    const double height = 0.01 * (1.0 + std::cos(2.0 * std::numbers::pi * 0.002 * k)) + 2e-5;
    const ForceTick& tick =
        session.step(std::array{sampled({0.0, 0.0, height - 0.01}, session.time_ns())});
    ASSERT_EQ(tick.tools[0].command.force_D, Vector3d::Zero()) << k;
    touched += tick.contacts;
  }
  EXPECT_GT(touched, 0U);
}

// A minute on the floor, pulled aside within the cone, behind an encoder that trembles.
TEST(HapticSession, DoesNotCreepBehindATremblingEncoder) {
  HapticSession session(cube_on_floor(0.5));
  Sampled sampled;
  std::mt19937_64 rng(3);
  Vector3d settled = Vector3d::Zero();
  for (int k = 0; k < 61 * 4000; ++k) {
    const Vector3d steps(static_cast<double>(rng() % 3), static_cast<double>(rng() % 3),
                         static_cast<double>(rng() % 3));
    const Vector3d pulled(6e-4 * std::min(1.0, k / 1000.0), 0.0, -0.012);
    (void)session.step(std::array{sampled(pulled + 1e-5 * steps, session.time_ns())});
    if (k == 4000) {
      settled = session.contacts().pose(0).position;
    }
  }
  EXPECT_LE((session.contacts().pose(0).position - settled).head<2>().norm(), 1e-7);
}

/// [N]  Root mean square of the change of the force, 0.5 s held at a corner by a trembling encoder.
double swing_at_a_corner(double tremble) {
  HapticScene scene;
  scene.tools.push_back(tool_at("finger", make_sphere(0.005), {0.0, 0.0, 0.0}));
  scene.bodies.push_back(body_at("wall", make_box({0.1, 0.1, 0.1}), {0.06, 0.0, 0.0}));
  scene.bodies.push_back(body_at("floor", make_box({0.5, 0.5, 0.1}), {0.0, 0.0, -0.06}));
  HapticSession session(scene);
  Sampled sampled;
  std::mt19937_64 rng(3);
  double power = 0.0;
  Vector3d last = Vector3d::Zero();
  for (int k = 0; k < 6000; ++k) {
    const Vector3d steps(static_cast<double>(rng() % 2), static_cast<double>(rng() % 2),
                         static_cast<double>(rng() % 2));
    const ForceTick& tick = session.step(
        std::array{sampled(Vector3d(0.008, 0.0, -0.008) + tremble * steps, session.time_ns())});
    const Vector3d& force = tick.tools[0].command.force_D;
    power += k >= 4000 ? (force - last).squaredNorm() / 2000.0 : 0.0;
    last = force;
  }
  return std::sqrt(power);
}

TEST(HapticSession, SwingsNoMoreAtACornerThanTheEncoderDoes) {
  EXPECT_LE(swing_at_a_corner(0.0), 1e-9);
  // A step of 10 um is 0.01 N along each of the two normals.
  EXPECT_LE(swing_at_a_corner(1e-5), 0.0101);
}

bool is_unsolved(const ForceTick& tick) {
  return (tick.tools[0].faults & static_cast<std::uint32_t>(ForceFault::unsolved)) != 0;
}

// A cube that is pressed into the corner of a floor and a wall, and tilted: a few ticks need more
// pivots than a tick has.
TEST(HapticSession, DoesNotKickWhereATickIsUnsolved) {
  HapticScene scene;
  scene.tools.push_back(tool_at("cube", make_box({0.03, 0.03, 0.03}), {0.0, 0.0, 0.05}, 0.4));
  scene.tools[0].coupling.angular_stiffness = 0.2;
  scene.bodies.push_back(body_at("floor", make_box({0.4, 0.4, 0.02}), {0.0, 0.0, 0.0}, 0.4));
  scene.bodies.push_back(body_at("wall", make_box({0.02, 0.4, 0.4}), {0.03, 0.0, 0.2}, 0.4));
  HapticSession session(scene);
  Sampled sampled;
  Vector3d last = Vector3d::Zero();
  int unsolved = 0;
  for (int k = 0; k < 3600; ++k) {
    const double angle = 2.0 * std::numbers::pi * 2.5e-4 * k;
    DeviceState state = sampled({0.008 + 0.006 * std::cos(angle), 0.003 * std::sin(2.0 * angle),
                                 -0.025 + 0.008 * std::sin(angle)},
                                session.time_ns());
    const Vector3d axis(std::sin(angle), std::cos(angle), 0.0);
    state.X_DH.rotation = Eigen::AngleAxisd(0.1, axis);
    const ForceTick& tick = session.step(std::array{state});
    const Vector3d& force = tick.tools[0].command.force_D;
    ASSERT_LE((force - last).norm(), 0.5) << k;
    unsolved += is_unsolved(tick) ? 1 : 0;
    last = force;
  }
  EXPECT_GT(unsolved, 0);
}

// Surfaces that squeeze a tool contradict each other. Nothing holds it sideways.
TEST(HapticSession, FeelsNoForceAlongSurfacesThatSqueeze) {
  HapticSession session(cube_in_a_press());
  Sampled sampled;
  for (int k = 0; k < 3000; ++k) {
    const ForceTick& tick = session.step(std::array{sampled(Vector3d::Zero(), session.time_ns())});
    ASSERT_LE(tick.tools[0].command.force_D.head<2>().norm(), 0.01) << k;
  }
}

/// A cube on a floor that rises by 2 cm in 50 ms, and returns in as much time.
HapticScene cube_on_a_stamp() {
  HapticScene scene = cube_on_floor();
  const Pose low = scene.bodies[0].X_WB;
  Pose high = low;
  high.position.z() += 0.02;
  scene.bodies[0].course =
      Motion::waypoints(std::vector{0.0, 0.5, 0.75, 1.0}, std::vector<Pose>{low, low, high, low});
  scene.duration = 0.2;
  return scene;
}

TEST(HapticSession, ToolStaysWhereItsDeviceWasLostOrClutched) {
  for (const bool is_lost : {true, false}) {
    HapticSession session(cube_on_a_stamp(), {.mappings = {{.clutch_button = 0}}});
    const double start = session.contacts().pose(0).position.z();
    Sampled sampled;
    double highest = start;
    for (int k = 0; k < 1200; ++k) {
      DeviceState state = sampled(Vector3d::Zero(), session.time_ns());
      if (k >= 100) {
        state.status = is_lost ? DeviceStatus::lost : DeviceStatus::live;
        state.buttons = is_lost ? 0U : 1U;
      }
      (void)session.step(std::array{state});
      highest = std::max(highest, session.contacts().pose(0).position.z());
    }
    EXPECT_GT(highest, start + 0.009) << is_lost;
    EXPECT_NEAR(session.contacts().pose(0).position.z(), start, 1e-6) << is_lost;
  }
}

// A cycle is under way while the device is lost: the tool stays where that cycle leaves it.
TEST(HapticSession, ToolDoesNotGoBackWhereItsDeviceWasLost) {
  for (const std::int64_t latency_ns : {0, 10'000'000, 100'000'000}) {
    for (const bool is_lost : {true, false}) {
      HapticSession session(cube_on_floor(),
                            {.contact_latency_ns = latency_ns, .mappings = {{.clutch_button = 0}}});
      Sampled sampled;
      double farthest = 0.0;
      for (int k = 0; k < 3000; ++k) {
        DeviceState state = sampled({2.5e-4 * std::min(k, 1234), 0.0, 0.1}, session.time_ns());
        if (k >= 1234) {
          state.status = is_lost ? DeviceStatus::lost : DeviceStatus::live;
          state.buttons = is_lost ? 0U : 1U;
        }
        (void)session.step(std::array{state});
        const double x = session.contacts().pose(0).position.x();
        farthest = std::max(farthest, x);
        ASSERT_GE(x, farthest - 1e-9) << latency_ns << ", " << k;
      }
      EXPECT_GT(farthest, 0.1) << latency_ns;
    }
  }
}

// A floor that rises at a constant rate pushes a cube that the hand holds still. The felt force is
// that of the floor's present position, neither a cycle before nor after it.
TEST(HapticSession, FeelsSurfacesWhereTheyAreNow) {
  constexpr double kSpeed = 0.1;  // [m/s]
  for (const double rate : {1000.0, 100.0}) {
    HapticScene scene = cube_on_floor();
    scene.bodies[0].course =
        Motion::constant_velocity(scene.bodies[0].X_WB, Vector3d(0.0, 0.0, 0.5 * kSpeed));
    scene.duration = 0.5;
    HapticSession session(
        scene, {.contact_rate = rate, .forces = {.limits = {.force = 100.0, .ramp_ns = 0}}});
    const double rest = 1.375 * session.contacts().contact_distance();
    for (int k = 0; k < 1600; ++k) {
      const double seconds = 1e-9 * static_cast<double>(session.time_ns());
      const ForceTick& tick = session.step(std::array{live_at(Vector3d::Zero())});
      const double expected = 1000.0 * (kSpeed * seconds + rest - 0.01);
      if (expected > 1.0) {
        ASSERT_NEAR(tick.tools[0].command.force_D.z(), expected, 0.01) << rate << ", " << k;
      }
    }
  }
}

// Damping is of the velocity between the two, whichever of them moves.
TEST(HapticSession, DampsTheMotionOfSurfacesToo) {
  constexpr double kSpeed = 0.1;    // [m/s]
  constexpr double kDamping = 5.0;  // [N s/m]
  for (const double of_device : {0.0, kSpeed, 2.0 * kSpeed}) {
    HapticScene scene = cube_on_floor();
    scene.tools[0].coupling.damping = kDamping;
    scene.bodies[0].course =
        Motion::constant_velocity(scene.bodies[0].X_WB, Vector3d(0.0, 0.0, 0.2 * kSpeed));
    scene.duration = 0.2;
    HapticSession session(scene, {.forces = {.limits = {.force = 100.0, .ramp_ns = 0}}});
    const double rest = 1.375 * session.contacts().contact_distance();
    for (int k = 0; k < 600; ++k) {
      const double seconds = 1e-9 * static_cast<double>(session.time_ns());
      const double below = 0.03 - of_device * seconds;
      const ForceTick& tick = session.step(std::array{live_at({0.0, 0.0, -below})});
      const double stretch = kSpeed * seconds + rest - 0.01 + below;
      if (k > 200) {
        ASSERT_NEAR(tick.tools[0].command.force_D.z(),
                    1000.0 * stretch + kDamping * (kSpeed - of_device), 0.01)
            << of_device << ", " << k;
      }
    }
  }
}

TEST(HapticSession, FeelsConstantFrictionWhileItSlides) {
  constexpr double kFriction = 0.1;
  for (const double speed : {0.02, 0.5}) {
    HapticScene scene = cube_on_floor(kFriction);
    scene.tools[0].coupling.angular_stiffness = 100.0;
    HapticSession session(scene);
    Sampled sampled;
    for (int k = 0; k < 2400; ++k) {
      const double x = speed * 2.5e-4 * std::max(0, k - 900);
      const ForceTick& tick =
          session.step(std::array{sampled({x, 0.0, -0.015}, session.time_ns())});
      if (k > 2000) {
        const Vector3d& force = tick.tools[0].command.force_D;
        ASSERT_NEAR(-force.x(), kFriction * force.z(), 0.001) << speed << ", " << k;
      }
    }
  }
}

TEST(HapticSession, RefusesRatesOutOfRange) {
  EXPECT_THROW(HapticSession(cube_on_floor(), {.force_rate = 0.0}), std::invalid_argument);
  EXPECT_THROW(HapticSession(cube_on_floor(), {.force_rate = 99.0, .contact_rate = 50.0}),
               std::invalid_argument);
  EXPECT_THROW(HapticSession(cube_on_floor(), {.force_rate = 100.0, .contact_rate = 200.0}),
               std::invalid_argument);
  HapticSession session(cube_on_floor());
  EXPECT_THROW((void)session.step({}), std::invalid_argument);
}

TEST(TimingHistogram, CountsEveryDuration) {
  TimingHistogram histogram;
  for (std::int64_t k = 0; k < 1000; ++k) {
    histogram.add(1000 * k);
  }
  EXPECT_EQ(histogram.count(), 1000U);
  EXPECT_EQ(histogram.greatest_ns(), 999'000);
  EXPECT_NEAR(static_cast<double>(histogram.quantile_ns(0.5)), 5e5, 7e4);
  std::uint64_t sum = 0;
  for (std::size_t k = 0; k + 1 < TimingHistogram::kBuckets; ++k) {
    ASSERT_LT(TimingHistogram::begin_of(k), TimingHistogram::begin_of(k + 1));
    sum += histogram.count_of(k);
  }
  EXPECT_EQ(sum, 1000U);
}

}  // namespace
}  // namespace firstcontact
