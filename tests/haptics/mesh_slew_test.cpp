// The force while a ball slides over a bunny's ear and over the start of a screw thread.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/mesh_files/read_mesh.h>

#include "haptics/haptic_scenes.h"

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

constexpr double kRate = 4000.0;         // [Hz]
constexpr double kStiffness = 1000.0;    // [N/m]
constexpr std::size_t kMillisecond = 4;  // [ticks]
const Vector3d kEarTip{-0.0175, 0.1873, -0.0198};

using Path = std::function<Vector3d(double)>;  // Place of the handle, by a share of the time.

const Shape& shape_of(const char* file) {
  static std::map<std::string, Shape> shapes;
  const auto known = shapes.find(file);
  return known != shapes.end()
             ? known->second
             : shapes
                   .emplace(file, Shape(read_mesh(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) /
                                                  "data" / file)))
                   .first->second;
}

/// The forces of a session.
struct Slide {
  double in_tick = 0.0;         // [N]  Greatest change in a tick.
  double in_millisecond = 0.0;  // [N]
  double greatest = 0.0;        // [N]
  double clearance = 1e9;       // [m]  Least.
};

/// Slides a ball on a path, by a hand that does not yield.
Slide slide(const char* file, double radius, const Path& path, double seconds, double declared) {
  HapticScene scene;
  scene.tools.push_back(tool_at("ball", make_sphere(radius), path(0.0)));
  scene.bodies.push_back(body_at("mesh", shape_of(file), Vector3d::Zero()));
  HapticSessionOptions options;
  options.forces.limits.force_slew = declared;
  HapticSession session(scene, options);
  const auto ticks = static_cast<int>(seconds * kRate);
  std::array<Vector3d, kMillisecond> last;
  last.fill(Vector3d::Zero());
  Slide found;
  for (int k = 0; k < ticks; ++k) {
    DeviceState state;
    state.status = DeviceStatus::live;
    state.sequence = static_cast<std::uint64_t>(k) + 1;
    state.time_ns = session.time_ns();
    state.X_DH.position = path(static_cast<double>(k) / ticks) - path(0.0);
    const Vector3d force = session.step(std::array{state}).tools[0].command.force_D;
    const auto at = static_cast<std::size_t>(k);
    found.in_tick = std::max(found.in_tick, (force - last[(at + 3) % kMillisecond]).norm());
    found.in_millisecond = std::max(found.in_millisecond, (force - last[at % kMillisecond]).norm());
    found.greatest = std::max(found.greatest, force.norm());
    last[at % kMillisecond] = force;
    if (session.cycle() != nullptr) {
      found.clearance = std::min(found.clearance, session.cycle()->clearance);
    }
  }
  return found;
}

constexpr const char* kBunny = "stanford/stanford-bunny.obj";
constexpr double kBall = 0.005;  // [m]  Radius of the ball on the ear.

/// A line of 4 cm over the tip of the ear. A ball there overlaps the tip by 4 mm.
Path over_the_ear(double angle) {
  const Vector3d along(std::cos(angle), 0.0, std::sin(angle));
  return [along](double share) -> Vector3d {
    return kEarTip + Vector3d(0.0, kBall - 0.004, 0.0) + (0.04 * share - 0.02) * along;
  };
}

constexpr const char* kBolt = "factory/factory_bolt_m16_loose.obj";
constexpr double kSmallBall = 0.001;  // [m]
constexpr double kCrest = 0.00784;    // [m]  Radius of the thread's crest.

/// Once around the bolt, after a way to it. A ball there overlaps the crest by 1.5 mm, and meets
/// the groove and the crest in each turn.
Path around_the_bolt(double height) {
  return [height](double share) -> Vector3d {
    constexpr double kApproach = 0.1;
    const double pressed = std::min(1.0, share / kApproach);
    const double angle =
        2.0 * std::numbers::pi * std::max(0.0, share - kApproach) / (1.0 - kApproach);
    const double radius = kCrest + kSmallBall + 0.001 - 0.0025 * pressed;
    return {radius * std::cos(angle), radius * std::sin(angle), height};
  };
}

constexpr std::array kEarAngles{0.0, 0.8, 1.6, 2.4};
// [m]  Of the bolt: the thread begins at 0.0395, the bolt ends at 0.041.
constexpr std::array kThreadHeights{0.0375, 0.0391, 0.0397, 0.0403};

/// Sanitizers make each slide 20 times as long: one is enough for them.
std::span<const double> some_of(std::span<const double> all) {
  return all.first(static_cast<std::size_t>(test::rounds(static_cast<int>(all.size()), 1)));
}

void expect_declared(const Slide& found, double declared) {
  EXPECT_GT(found.greatest, 0.5);  // The ball was pressed, or nothing was tested.
  EXPECT_GT(found.clearance, 0.0);
  EXPECT_LE(found.in_tick, declared / kRate * (1.0 + 1e-9));
  EXPECT_LE(found.in_millisecond, 1e-3 * declared * (1.0 + 1e-9));
}

TEST(MeshSlew, StaysAsDeclaredOverTheEarOfABunny) {
  for (const double angle : some_of(kEarAngles)) {
    for (const double declared : {500.0, 20'000.0}) {
      SCOPED_TRACE(testing::Message() << angle << ", " << declared);
      expect_declared(slide(kBunny, kBall, over_the_ear(angle), 0.5, declared), declared);
    }
  }
}

TEST(MeshSlew, StaysAsDeclaredOverTheStartOfAThread) {
  for (const double height : some_of(kThreadHeights)) {
    for (const double declared : {500.0, 20'000.0}) {
      SCOPED_TRACE(testing::Message() << height << ", " << declared);
      expect_declared(slide(kBolt, kSmallBall, around_the_bolt(height), 0.5, declared), declared);
    }
  }
}

// The ear has creases: there the god-object moves farther than the hand. The limit is not needed.
TEST(MeshSlew, FollowsTheHandOverTheEarOfABunny) {
  for (const double angle : some_of(kEarAngles)) {
    for (const double seconds : {0.5, 2.0}) {
      const double of_hand = kStiffness * 0.04 / seconds * 1e-3;
      EXPECT_LT(slide(kBunny, kBall, over_the_ear(angle), seconds, 1e9).in_millisecond,
                5.0 * of_hand)
          << angle << ", " << seconds;
    }
  }
}

// The test of the test: the ball slips off the crest, and the spring is released within a cycle.
TEST(MeshSlew, NeedsItsLimitOverTheStartOfAThread) {
  for (const double height : some_of(kThreadHeights)) {
    EXPECT_GT(slide(kBolt, kSmallBall, around_the_bolt(height), 0.5, 1e9).in_tick, 500.0 / kRate)
        << height;
  }
}

}  // namespace
}  // namespace firstcontact
