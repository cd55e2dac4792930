// The force over edges and corners: no faster than declared, and still while the hand is still.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_sessions/haptic_session.h>

#include "haptics/haptic_scenes.h"
#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 4000.0;        // [Hz]
constexpr double kSlew = 20'000.0;      // [N/s]  The default of HapticLimits.
constexpr double kHalf = 0.05;          // [m]  Half an edge of the cube.
constexpr double kStiffness = 1000.0;   // [N/m]
constexpr double kHeldShare = 0.01;     // [-]  Of the mean force.
constexpr std::size_t kWatched = 2000;  // [ticks]

Shape tool_shape(bool is_ball) {
  return is_ball ? make_sphere(0.005) : make_box({0.012, 0.01, 0.008});
}

/// A tool at a place, beside a cube of 10 cm around the origin.
HapticScene tool_beside_cube(bool is_ball, const Vector3d& place) {
  HapticScene scene;
  scene.tools.push_back(tool_at("tool", tool_shape(is_ball), place));
  scene.bodies.push_back(
      body_at("cube", make_box(Vector3d::Constant(2.0 * kHalf)), Vector3d::Zero()));
  return scene;
}

/// A circle in the plane across an axis. It is inside of the cube, 3 mm below the middles of the
/// faces and 15 mm at the edges.
Vector3d inside_the_cube(int axis, double angle) {
  Vector3d place = Vector3d::Zero();
  place[(axis + 1) % 3] = (kHalf - 0.003) * std::cos(angle);
  place[(axis + 2) % 3] = (kHalf - 0.003) * std::sin(angle);
  return place;
}

/// [N]  Greatest change of the force in a tick, all the way around the four edges along an axis.
double greatest_step(bool is_ball, int axis, double seconds, double declared) {
  const Vector3d start = (1.5 * kHalf) * Vector3d::Unit((axis + 1) % 3);
  HapticSessionOptions options;
  options.forces.limits.force_slew = declared;
  options.forces.limits.force = 100.0;
  HapticSession session(tool_beside_cube(is_ball, start), options);
  const auto ticks = static_cast<int>(seconds * kRate);
  Vector3d last = Vector3d::Zero();
  double step = 0.0;
  double greatest = 0.0;
  for (int k = 0; k < ticks; ++k) {
    DeviceState state;
    state.status = DeviceStatus::live;
    state.sequence = static_cast<std::uint64_t>(k) + 1;
    state.time_ns = session.time_ns();
    state.X_DH.position = inside_the_cube(axis, 2.0 * std::numbers::pi * k / ticks) - start;
    const Vector3d force = session.step(std::array{state}).tools[0].command.force_D;
    step = std::max(step, (force - last).norm());
    greatest = std::max(greatest, force.norm());
    last = force;
  }
  EXPECT_GT(greatest, 10.0) << axis;  // The tool was pressed, or nothing was tested.
  return step;
}

TEST(ForceContinuity, SlewStaysAsDeclaredOverEveryEdgeOfACube) {
  for (const bool is_ball : {true, false}) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double declared : {500.0, kSlew}) {
        EXPECT_LE(greatest_step(is_ball, axis, 1.0, declared), declared / kRate * (1.0 + 1e-9))
            << is_ball << ", " << axis;
      }
    }
  }
}

// A projection changes by no more than its target does. So the force changes by no more than the
// spring's when the device moves, also at edges; the limit of slew is not needed.
TEST(ForceContinuity, ChangesAsSlowlyAsTheHandMovesOverEveryEdgeOfACube) {
  constexpr double kSeconds = 4.0;
  const double of_hand = kStiffness * 2.0 * std::numbers::pi * (kHalf - 0.003) / kSeconds / kRate;
  for (const bool is_ball : {true, false}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(greatest_step(is_ball, axis, kSeconds, 1e9), 1.2 * of_hand)
          << is_ball << ", " << axis;
    }
  }
}

/// [N]  Root mean square of a signal between 50 and 1000 Hz.
double swing_of(const std::vector<double>& signal) {
  const auto n = static_cast<double>(signal.size());
  double power = 0.0;
  for (int k = static_cast<int>(50.0 * n / kRate); k <= static_cast<int>(1000.0 * n / kRate); ++k) {
    std::complex<double> sum;
    std::complex<double> turn = 1.0;
    const std::complex<double> step = std::polar(1.0, -2.0 * std::numbers::pi * k / n);
    for (const double value : signal) {
      sum += value * turn;
      turn *= step;
    }
    power += 2.0 * std::norm(sum) / (n * n);
  }
  return std::sqrt(power);
}

/// A hand without tremor that goes to a place inside of the cube, and holds still there.
///
/// @returns  [-]  swing of the force by its mean, over the last half second
double held_swing(bool is_ball, const Vector3d& outward, const Vector3d& place,
                  double stiffness = kStiffness) {
  const Vector3d start = place + 0.03 * outward;
  HapticScene scene = tool_beside_cube(is_ball, start);
  scene.tools[0].coupling.stiffness = stiffness;
  HapticSession session(scene);
  SimulatedOperatorOptions options;  // Encoders of 10 um and 0.003 degrees.
  options.hand.tremor = 0.0;
  options.hand.angular_tremor = 0.0;
  ViaPoint pressed;
  pressed.time = 0.4;
  pressed.X_DH.position = place - start;
  pressed.X_DH.rotation = Eigen::AngleAxisd(0.05, Vector3d(1.0, 2.0, 3.0).normalized());
  options.path = {ViaPoint{}, pressed};
  SimulatedOperator handle(options);
  std::array<std::vector<double>, 3> forces;
  Vector3d mean = Vector3d::Zero();
  constexpr std::size_t kTicks = 5000;
  for (std::size_t k = 0; k < kTicks; ++k) {
    const std::int64_t now = session.time_ns();
    const ForceCommand command = session.step(std::array{handle.read(now)}).tools[0].command;
    handle.command(command, now);
    if (k + kWatched >= kTicks) {
      mean += command.force_D / static_cast<double>(kWatched);
      for (std::size_t i = 0; i < 3; ++i) {
        forces[i].push_back(command.force_D[static_cast<Eigen::Index>(i)]);
      }
    }
  }
  EXPECT_GT(mean.norm(), 1.0);
  const double swing = std::hypot(swing_of(forces[0]), swing_of(forces[1]), swing_of(forces[2]));
  return swing / mean.norm();
}

/// A place 1.7 to 2.4 mm below an edge or a corner, where no symmetry helps.
Vector3d below(const Vector3d& outward) {
  return (kHalf - 0.001) * outward + Vector3d(2e-4, -1e-4, 3e-4);
}

TEST(ForceContinuity, IsStillWhileHeldAtEveryEdgeAndCornerOfACube) {
  for (const bool is_ball : {true, false}) {
    for (int k = 0; k < 27; k += test::rounds(1, 6)) {
      const Vector3d outward(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (outward.squaredNorm() > 1.5) {  // No face, and not the middle.
        EXPECT_LT(held_swing(is_ball, outward, below(outward)), kHeldShare)
            << is_ball << ", " << outward.transpose();
      }
    }
  }
}

/// A hand that holds a ball still between two steps of its encoder, 0.3 mm below a face.
///
/// @returns  [-]  swing of the force by its mean, over the last half second
double swing_between_steps(bool is_declared, double offset) {
  HapticScene scene = tool_beside_cube(true, Vector3d(0.0, 0.0, kHalf + 0.006));
  SimulatedOperatorOptions options;
  options.hand.tremor = 0.0;
  options.hand.angular_tremor = 0.0;
  ViaPoint pressed;
  pressed.time = 0.4;
  pressed.X_DH.position.z() = -0.001 - 3e-4 - offset;
  options.path = {ViaPoint{}, pressed};
  SimulatedOperator handle(options);
  HapticSessionOptions session_options;
  if (is_declared) {
    session_options.mappings = {{.device = handle.capabilities()}};
  }
  HapticSession session(scene, session_options);
  std::vector<double> forces;
  double mean = 0.0;
  constexpr std::size_t kTicks = 5000;
  for (std::size_t k = 0; k < kTicks; ++k) {
    const std::int64_t now = session.time_ns();
    const ForceCommand command = session.step(std::array{handle.read(now)}).tools[0].command;
    handle.command(command, now);
    if (k + kWatched >= kTicks) {
      forces.push_back(command.force_D.z());
      mean += command.force_D.z() / static_cast<double>(kWatched);
    }
  }
  EXPECT_GT(mean, 0.05);
  return swing_of(forces) / mean;
}

// A light force of 0.1 N, of which a step of the encoder is a tenth. The spring of a device whose
// step is declared does not follow the tremble; the test of the test is one without.
TEST(ForceContinuity, IsStillWhileHeldBetweenTwoStepsOfTheEncoder) {
  double undeclared = 0.0;
  for (int k = 0; k < 8; ++k) {
    const double offset = 1e-5 * k / 2.5;
    EXPECT_LT(swing_between_steps(true, offset), kHeldShare) << k;
    undeclared = std::max(undeclared, swing_between_steps(false, offset));
  }
  EXPECT_GT(undeclared, 2.0 * kHeldShare);
}

// The test of the test: 40 times the stiffness that the device bears.
TEST(ForceContinuity, IsNotStillWhereTheSpringIsTooStiff) {
  const Vector3d outward(1.0, 0.0, 1.0);
  EXPECT_GT(held_swing(true, outward, below(outward), 3e4), kHeldShare);
}

}  // namespace
}  // namespace firstcontact
