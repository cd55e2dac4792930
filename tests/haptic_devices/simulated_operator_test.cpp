#include <firstcontact/haptic_devices/simulated_operator.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::rounds;

constexpr std::int64_t kTick = 250'000;  // [ns]  4 kHz.

/// A hand without tremor and without limits, on a device without losses and encoders.
SimulatedOperatorOptions plain() {
  SimulatedOperatorOptions options;
  options.hand.tremor = 0.0;
  options.hand.angular_tremor = 0.0;
  options.hand.max_force = std::numeric_limits<double>::infinity();
  options.hand.max_torque = std::numeric_limits<double>::infinity();
  options.mechanism = {};
  options.mechanism.damping = 0.0;
  options.mechanism.angular_damping = 0.0;
  options.channel = {};
  options.channel.resolution = 0.0;
  options.channel.angular_resolution = 0.0;
  return options;
}

/// The same without the springs and dampers of the hand.
SimulatedOperatorOptions loose() {
  SimulatedOperatorOptions options = plain();
  options.hand = {.stiffness = 0.0,
                  .damping = 0.0,
                  .mass = 0.0,
                  .angular_stiffness = 0.0,
                  .angular_damping = 0.0,
                  .inertia = 0.0,
                  .tremor = 0.0,
                  .angular_tremor = 0.0};
  return options;
}

double seconds(std::int64_t ticks) { return static_cast<double>(ticks * kTick) * 1e-9; }

/// Runs ticks, each with the command that `force` gives for its number.
void run(SimulatedOperator& hand, std::int64_t first, std::int64_t last,
         const std::function<ForceCommand(std::int64_t)>& force) {
  for (std::int64_t tick = first; tick < last; ++tick) {
    (void)hand.read(tick * kTick);
    hand.command(force(tick), tick * kTick);
  }
  (void)hand.read(last * kTick);
}

ForceCommand along_x(double force) { return {{force, 0.0, 0.0}, Vector3d::Zero()}; }

/// kinetic - (command + hand - dissipated)
double imbalance(const SimulatedOperator& hand) {
  const OperatorEnergy energy = hand.energy();
  return energy.kinetic - (energy.command_work + energy.hand_work - energy.dissipated);
}

// The closed form of a damped spring under a force that begins at 0.
TEST(SimulatedOperator, AnswersAForceAsADampedSpring) {
  for (const double stiffness : {50.0, 400.0, 1500.0}) {
    SimulatedOperatorOptions options = plain();
    options.hand.stiffness = stiffness;
    options.hand.damping = 3.0;
    options.hand.mass = 0.1;
    options.mechanism.mass = 0.05;
    options.mechanism.damping = 1.0;
    SimulatedOperator hand(options);
    const double m = 0.15;
    const double decay = (3.0 + 1.0) / (2.0 * m);
    const double rate = std::sqrt(stiffness / m - decay * decay);
    const double amplitude = 5.0 / stiffness;
    for (std::int64_t tick = 0; tick <= rounds(1200, 120); tick += 40) {
      run(hand, std::max<std::int64_t>(0, tick - 40), tick,
          [](std::int64_t) { return along_x(5.0); });
      const double t = seconds(tick);
      const double expected =
          amplitude *
          (1.0 - std::exp(-decay * t) * (std::cos(rate * t) + decay / rate * std::sin(rate * t)));
      EXPECT_NEAR(hand.truth().X_DH.position.x(), expected, 1e-6 * amplitude)
          << stiffness << " N/m, tick " << tick;
    }
    EXPECT_LT(std::abs(imbalance(hand)), 1e-12);
  }
}

TEST(SimulatedOperator, TurnsAsADampedSpring) {
  SimulatedOperatorOptions options = plain();
  options.hand.angular_stiffness = 0.8;
  options.hand.angular_damping = 0.004;
  options.hand.inertia = 3e-4;
  options.mechanism.inertia = 1e-4;
  SimulatedOperator hand(options);
  const Vector3d axis = Vector3d(1.0, -2.0, 0.5).normalized();
  const double decay = 0.004 / 8e-4;
  const double rate = std::sqrt(0.8 / 4e-4 - decay * decay);
  const double amplitude = 0.9 / 0.8;  // [rad]  Larger than a linearised law would bear.
  run(hand, 0, 300, [&](std::int64_t) { return ForceCommand{Vector3d::Zero(), 0.9 * axis}; });
  const double t = seconds(300);
  const double expected =
      amplitude *
      (1.0 - std::exp(-decay * t) * (std::cos(rate * t) + decay / rate * std::sin(rate * t)));
  const AngleAxisd turn(hand.truth().X_DH.rotation);
  EXPECT_NEAR(turn.angle() * turn.axis().dot(axis), expected, 1e-5);
  EXPECT_NEAR(turn.axis().cross(axis).norm(), 0.0, 1e-6);
  EXPECT_LT(std::abs(imbalance(hand)), 1e-11);
}

TEST(SimulatedOperator, ReachesTheSpeedOfViscousDamping) {
  SimulatedOperatorOptions options = loose();
  options.mechanism.mass = 0.2;
  options.mechanism.damping = 4.0;
  SimulatedOperator hand(options);
  run(hand, 0, 400, [](std::int64_t) { return along_x(2.0); });
  EXPECT_NEAR(hand.truth().velocity.x(), 0.5 * (1.0 - std::exp(-4.0 / 0.2 * seconds(400))), 1e-9);
}

TEST(SimulatedOperator, RubsAsCoulombSays) {
  SimulatedOperatorOptions options = loose();
  options.mechanism.mass = 0.2;
  options.mechanism.friction = 0.5;
  SimulatedOperator hand(options);
  // Up to the limit nothing moves, not even a little.
  run(hand, 0, 400, [](std::int64_t) { return along_x(0.5); });
  EXPECT_EQ(hand.truth().X_DH.position.x(), 0.0);
  // Beyond it the rest accelerates.
  run(hand, 400, 800, [](std::int64_t) { return along_x(0.9); });
  const double t = seconds(400);
  const double speed = 0.4 / 0.2 * t;
  EXPECT_NEAR(hand.truth().velocity.x(), speed, 1e-9);
  EXPECT_NEAR(hand.truth().X_DH.position.x(), 0.5 * speed * t, 1e-6);
  // Then friction alone takes m v^2 / (2 f) to stop it.
  const double before = hand.truth().X_DH.position.x();
  run(hand, 800, 1400, [](std::int64_t) { return ForceCommand{}; });
  EXPECT_EQ(hand.truth().velocity.x(), 0.0);
  EXPECT_NEAR(hand.truth().X_DH.position.x() - before, 0.2 * speed * speed / (2.0 * 0.5), 1e-6);
  EXPECT_LT(std::abs(imbalance(hand)), 1e-12);
  EXPECT_NEAR(hand.energy().dissipated, hand.energy().command_work, 1e-12);
}

TEST(SimulatedOperator, KeepsTheEnergyOfALosslessSpring) {
  SimulatedOperatorOptions options = plain();
  options.hand.stiffness = 1500.0;
  options.hand.damping = 0.0;
  options.hand.mass = 0.0;
  options.mechanism.mass = 0.05;
  SimulatedOperator hand(options);
  run(hand, 0, 8, [](std::int64_t) { return along_x(30.0); });
  const double given = hand.energy().command_work;
  ASSERT_GT(given, 0.001);
  for (std::int64_t tick = 8; tick < 1008; tick += 100) {
    run(hand, tick, tick + 100, [](std::int64_t) { return ForceCommand{}; });
    const double spring = 0.5 * 1500.0 * hand.truth().X_DH.position.squaredNorm();
    EXPECT_NEAR(hand.energy().kinetic + spring, given, 1e-5 * given) << tick;
  }
}

TEST(SimulatedOperator, BalancesItsEnergiesWhateverHappens) {
  SimulatedOperatorOptions options;
  options.mechanism.friction = 0.3;
  options.mechanism.angular_friction = 0.002;
  options.channel.command_delay_ns = 2 * kTick;
  options.channel.jitter_ns = 100'000;
  options.path = random_via_points({.seed = 3, .count = 8, .radius = 0.05});
  options.releases = {{0.01, 0.02}, {0.03, 0.035}};
  SimulatedOperator hand(options);
  for (std::int64_t tick = 0; tick < rounds(1600, 200); ++tick) {
    const DeviceState state = hand.read(tick * kTick);
    // A stiff wall below z = 0, as a loop would render it.
    const double force = state.X_DH.position.z() < 0.0 ? -2000.0 * state.X_DH.position.z() : 0.0;
    hand.command({{0.0, 0.0, force}, {0.0, 0.01, 0.0}}, tick * kTick);
    ASSERT_LT(std::abs(imbalance(hand)), 1e-10) << tick;
  }
  EXPECT_GT(hand.energy().dissipated, 0.0);
}

TEST(SimulatedOperator, DoesNotDependOnTheSubstep) {
  const auto end_of = [](double substep) {
    SimulatedOperatorOptions options = plain();
    options.substep = substep;
    options.mechanism.friction = 0.2;
    options.path = random_via_points({.seed = 8, .count = 4, .radius = 0.1});
    SimulatedOperator hand(options);
    run(hand, 0, rounds(800, 80),
        [](std::int64_t tick) { return along_x(tick % 100 < 50 ? 2.0 : -2.0); });
    return hand.truth().X_DH;
  };
  const Pose coarse = end_of(2.5e-6);
  const Pose fine = end_of(0.625e-6);
  EXPECT_LT((coarse.position - fine.position).norm(), 2e-8);
  EXPECT_LT(coarse.rotation.angularDistance(fine.rotation), 1e-6);
}

// A loop that was late reads after a pause. The sub-steps are longer then, so that the hand does not
// make the loop later still.
TEST(SimulatedOperator, MovesAlikeInPauses) {
  const auto end_of = [](double substep) {
    SimulatedOperatorOptions options;
    options.hand.stiffness = 1500.0;
    options.hand.mass = 0.05;
    options.mechanism.friction = 0.2;
    options.substep = substep;
    options.path = random_via_points({.seed = 8, .count = 4, .radius = 0.1});
    SimulatedOperator hand(options);
    for (std::int64_t pause = 0; pause < 40; ++pause) {
      (void)hand.read(80 * pause * kTick);
      hand.command(along_x(pause % 4 < 2 ? 2.0 : -2.0), 80 * pause * kTick);
    }
    return hand.truth().X_DH;
  };
  const Pose usual = end_of(SimulatedOperatorOptions{}.substep);
  const Pose fine = end_of(0.625e-6);
  EXPECT_LT((usual.position - fine.position).norm(), 1e-6);
  EXPECT_LT(usual.rotation.angularDistance(fine.rotation), 1e-5);
}

TEST(SimulatedOperator, FollowsItsPathWhereNothingIsInTheWay) {
  SimulatedOperatorOptions options = plain();
  options.hand.stiffness = 1500.0;
  options.hand.damping = 40.0;
  options.path = random_via_points({.seed = 2, .count = 10, .radius = 0.1, .longest_rest = 0.0});
  SimulatedOperator hand(options);
  double worst = 0.0;
  for (std::int64_t tick = 0; tick < rounds(4000, 300); ++tick) {
    (void)hand.read(tick * kTick);
    const OperatorTruth truth = hand.truth();
    worst = std::max(worst, (truth.X_DH.position - truth.target.X_DH.position).norm());
  }
  EXPECT_GT(worst, 1e-6);
  EXPECT_LT(worst, 0.01);
}

TEST(SimulatedOperator, RoundsAsEncodersDo) {
  SimulatedOperatorOptions options;
  options.path = random_via_points({.seed = 6, .count = 6, .radius = 0.05});
  SimulatedOperator hand(options);
  const double step = options.channel.resolution;
  bool between = false;
  for (std::int64_t tick = 0; tick < rounds(1000, 200); ++tick) {
    const DeviceState state = hand.read(tick * kTick);
    const Vector3d exact = hand.truth().X_DH.position;
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = state.X_DH.position[axis] / step;
      ASSERT_NEAR(steps, std::round(steps), 1e-9);
      ASSERT_LE(std::abs(state.X_DH.position[axis] - exact[axis]), 0.5 * step * (1.0 + 1e-9));
      between = between || std::abs(state.X_DH.position[axis] - exact[axis]) > 0.3 * step;
    }
    ASSERT_LE(state.X_DH.rotation.angularDistance(hand.truth().X_DH.rotation),
              std::sqrt(3.0) * options.channel.angular_resolution);
  }
  EXPECT_TRUE(between);
  EXPECT_EQ(hand.capabilities().resolution, 1e-5);
}

TEST(SimulatedOperator, DelaysSamplesByTicks) {
  SimulatedOperatorOptions options = plain();
  options.channel.sensor_delay_ns = 2 * kTick;
  options.path = random_via_points({.seed = 6, .count = 6, .radius = 0.05});
  SimulatedOperator hand(options);
  std::vector<Vector3d> exact;
  for (std::int64_t tick = 0; tick < 400; ++tick) {
    const DeviceState state = hand.read(tick * kTick);
    exact.push_back(hand.truth().X_DH.position);
    if (tick < 2) {
      EXPECT_EQ(state.status, DeviceStatus::waiting);
    } else {
      ASSERT_EQ(state.X_DH.position, exact[static_cast<std::size_t>(tick - 2)]);
      ASSERT_EQ(state.time_ns, (tick - 2) * kTick);
    }
  }
}

TEST(SimulatedOperator, DelaysCommands) {
  SimulatedOperatorOptions options = loose();
  options.mechanism.mass = 0.2;
  options.channel.command_delay_ns = 2 * kTick + 100'000;
  SimulatedOperator hand(options);
  run(hand, 0, 2, [](std::int64_t) { return along_x(1.0); });
  EXPECT_EQ(hand.truth().velocity.x(), 0.0);
  run(hand, 2, 10, [](std::int64_t) { return along_x(1.0); });
  EXPECT_NEAR(hand.truth().velocity.x(), 1.0 / 0.2 * (seconds(8) - 1e-4), 1e-12);
}

TEST(SimulatedOperator, JittersWithoutGoingBack) {
  SimulatedOperatorOptions options;
  options.channel.sensor_delay_ns = kTick;
  options.channel.jitter_ns = 3 * kTick;
  SimulatedOperator hand(options);
  std::uint64_t last = 0;
  std::int64_t oldest = 0;
  bool stayed = false;
  for (std::int64_t tick = 0; tick < rounds(2000, 200); ++tick) {
    const DeviceState state = hand.read(tick * kTick);
    ASSERT_GE(state.sequence, last);
    stayed = stayed || (tick > 10 && state.sequence == last);
    last = state.sequence;
    if (tick > 10) {
      ASSERT_GE(tick * kTick - state.time_ns, kTick);
      oldest = std::max(oldest, tick * kTick - state.time_ns);
    }
  }
  EXPECT_TRUE(stayed);
  EXPECT_GT(oldest, 2 * kTick);
  EXPECT_LE(oldest, 5 * kTick);
}

TEST(SimulatedOperator, LetsGoAndGrasps) {
  SimulatedOperatorOptions options = plain();
  options.hand.stiffness = 300.0;
  options.hand.mass = 0.4;
  options.mechanism.mass = 0.1;
  options.releases = {{0.1, 0.2}};
  SimulatedOperator hand(options);
  run(hand, 0, 400, [](std::int64_t) { return along_x(3.0); });
  // 0.1 s of pressing against the hand: it gives way by F / k.
  EXPECT_EQ(hand.read(400 * kTick).buttons, 0U);
  EXPECT_FALSE(hand.truth().held);
  const double speed = hand.truth().velocity.x();
  run(hand, 400, 480, [](std::int64_t) { return along_x(3.0); });
  EXPECT_NEAR(hand.truth().velocity.x() - speed, 3.0 / 0.1 * seconds(80), 1e-9);
  run(hand, 480, 801, [](std::int64_t) { return ForceCommand{}; });
  EXPECT_TRUE(hand.truth().held);
  EXPECT_EQ(hand.read(802 * kTick).buttons, 1U);
  EXPECT_LT(std::abs(imbalance(hand)), 1e-10);
}

TEST(SimulatedOperator, ForgetsACommandAfterItsLifetime) {
  SimulatedOperatorOptions options = loose();
  options.mechanism.mass = 1.0;
  options.substep = 1e-4;
  SimulatedOperator hand(options);
  (void)hand.read(0);
  hand.command(along_x(1.0), 0);
  (void)hand.read(1'000'000'000);
  EXPECT_NEAR(hand.truth().velocity.x(), 0.1, 1e-12);
}

TEST(SimulatedOperator, TakesNoCommandThatIsNotFinite) {
  SimulatedOperator hand(loose());
  run(hand, 0, 10, [](std::int64_t) { return along_x(std::nan("")); });
  EXPECT_EQ(hand.truth().velocity, Vector3d::Zero());
}

TEST(SimulatedOperator, TremblesByTheGivenAmount) {
  SimulatedOperatorOptions options;
  options.substep = 1e-3;  // The hand alone is of interest, so 100 sub-steps of a read will do.
  options.hand.tremor = 2e-4;
  options.hand.angular_tremor = 1e-3;
  SimulatedOperator hand(options);
  Vector3d squares = Vector3d::Zero();
  double turns = 0.0;
  int crossings = 0;
  double last = 0.0;
  constexpr int kSteps = 1000;  // 20 s in steps of 20 ms.
  for (int step = 0; step < kSteps; ++step) {
    (void)hand.read(step * std::int64_t{20'000'000});
    const HandTarget target = hand.truth().target;
    squares += target.X_DH.position.cwiseAbs2();
    turns += std::pow(target.X_DH.rotation.angularDistance(Quaterniond::Identity()), 2);
    crossings += target.X_DH.position.x() * last < 0.0 ? 1 : 0;
    last = target.X_DH.position.x();
  }
  for (const double sum : squares) {
    EXPECT_NEAR(std::sqrt(sum / kSteps), 2e-4, 4e-5);
  }
  EXPECT_NEAR(std::sqrt(turns / kSteps), std::sqrt(3.0) * 1e-3, 3e-4);
  const double frequency = crossings / 2.0 / 20.0;
  EXPECT_GT(frequency, 8.0);
  EXPECT_LT(frequency, 12.0);
}

TEST(SimulatedOperator, IsTheSameForOneSeed) {
  const auto end_of = [](std::uint64_t seed) {
    SimulatedOperatorOptions options;
    options.seed = seed;
    options.channel.jitter_ns = 300'000;
    SimulatedOperator hand(options);
    run(hand, 0, rounds(500, 50), [](std::int64_t) { return along_x(1.0); });
    return hand.truth().X_DH.position;
  };
  EXPECT_EQ(end_of(1), end_of(1));
  EXPECT_NE(end_of(1), end_of(2));
  EXPECT_NE(end_of(0), end_of(2));
}

TEST(SimulatedOperator, LimitsThePullOfTheHand) {
  SimulatedOperatorOptions options = plain();
  options.hand.stiffness = 1000.0;
  options.hand.max_force = 5.0;
  options.hand.damping = 0.0;
  options.hand.mass = 0.0;
  options.mechanism.mass = 0.5;
  options.path = {{0.0, {}}, {1e-3, {{0.5, 0.0, 0.0}, Quaterniond::Identity()}}};
  SimulatedOperator hand(options);
  run(hand, 0, 200, [](std::int64_t) { return ForceCommand{}; });
  EXPECT_NEAR(hand.truth().velocity.x(), 5.0 / 0.5 * seconds(200), 0.02);
}

TEST(SimulatedOperator, OpensAndClosesItsFingers) {
  SimulatedOperatorOptions options;
  options.fingers = {.grips = 2, .period = 0.5, .closed = 0.8};
  SimulatedOperator hand(options);
  EXPECT_EQ(hand.capabilities().grips, 2);
  EXPECT_GT(hand.capabilities().max_grip_effort, 0.0);
  EXPECT_EQ(SimulatedOperator().capabilities().grips, 0);
  EXPECT_EQ(SimulatedOperator().capabilities().max_grip_effort, 0.0);
  double least = 1.0;
  double greatest = 0.0;
  bool are_alike = true;
  for (std::int64_t now = 0; now < 2'000'000'000; now += 1'000'000) {
    const DeviceState state = hand.read(now);
    least = std::min(least, state.grips[0]);
    greatest = std::max(greatest, state.grips[0]);
    are_alike = are_alike && state.grips[0] == state.grips[1];
    ASSERT_EQ(state.grips[2], 0.0);
  }
  EXPECT_EQ(least, 0.0);
  EXPECT_NEAR(greatest, 0.8, 1e-3);
  EXPECT_FALSE(are_alike);
}

TEST(SimulatedOperator, RefusesOptionsOutsideTheirRange) {
  const auto refused = [](const std::function<void(SimulatedOperatorOptions&)>& change) {
    SimulatedOperatorOptions options;
    change(options);
    EXPECT_THROW(SimulatedOperator{options}, std::invalid_argument);
  };
  refused([](auto& o) { o.mechanism.mass = 0.0; });
  refused([](auto& o) { o.mechanism.inertia = -1.0; });
  refused([](auto& o) { o.mechanism.friction = std::nan(""); });
  refused([](auto& o) { o.hand.stiffness = -1.0; });
  refused([](auto& o) { o.hand.mass = std::nan(""); });
  refused([](auto& o) { o.hand.tremor_frequencies = {12.0, 8.0}; });
  refused([](auto& o) { o.channel.resolution = -1.0; });
  refused([](auto& o) { o.channel.jitter_ns = -1; });
  refused([](auto& o) { o.channel.command_delay_ns = 20'000'000; });
  refused([](auto& o) { o.releases = {{0.2, 0.1}}; });
  refused([](auto& o) { o.releases = {{0.1, 0.3}, {0.2, 0.4}}; });
  refused([](auto& o) { o.substep = 0.0; });
  refused([](auto& o) { o.path = {}; });
}

}  // namespace
}  // namespace firstcontact
