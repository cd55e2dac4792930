// The record of a session: proven again by code that shares no geometry with the contact loop.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptics_files/haptic_log.h>
#include <firstcontact/haptics_files/haptic_run.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/record/read_run.h>
#include <firstcontact/record/write_run.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/verification/verify_run.h>

#include "support/rounds.h"

namespace firstcontact {
namespace {

using Eigen::Vector3d;

struct Recorded {
  std::string run;
  double least_height = 1e9;  // [m]  Of the first tool.
};

/// Runs cycles after targets of one tool, and writes them down.
template <class Target>
Recorded record_cycles(const std::string& text, int cycles, const Target& target) {
  Scene scene = parse_scene(text, "scene.json");
  ShapeCache cache;
  prepare_haptics(scene, cache, 1e-3 * cycles);
  const LoadedScene loaded = load_scene(std::move(scene), cache);
  const HapticSetup setup = haptic_setup(loaded);
  ContactLoop loop(setup.scene, setup.options.contacts);
  HapticRun run(loaded, setup, loop.contact_distance());
  Recorded recorded{write_run_header(run.header())};
  std::vector<Pose> targets(setup.scene.tools.size());
  for (int k = 0; k < cycles; ++k) {
    for (std::size_t tool = 0; tool < targets.size(); ++tool) {
      targets[tool] = target(k, tool);
    }
    recorded.run += write_run_step(run.step(loop.advance(targets, 1e-3, k)));
    recorded.least_height = std::min(recorded.least_height, loop.pose(0).position.z());
  }
  return recorded;
}

RunVerification verify_text(const std::string& text) {
  std::istringstream stream(text);
  RunReader reader(stream, "run.jsonl");
  return verify_run(reader.header(), [&] { return reader.next(); });
}

const char* const kPlate = R"({"firstcontact": 1, "bodies": [
  {"name": "tool", "shape": {"box": {"size": [0.02, 0.03, 0.01]}}, "pose": {"position": [0, 0, 0.1]}},
  {"name": "plate", "shape": {"box": {"size": [0.3, 0.3, 0.0001]}}}],
  "haptics": {"tools": [{"body": "tool"}], "friction": 0.3}})";

// 5 m/s, turning, through a plate of 0.1 mm and back, again and again.
TEST(HapticRun, IsProvenForADeviceThatRushesThroughAPlate) {
  const Recorded recorded = record_cycles(kPlate, 200, [](int k, std::size_t) {
    const double phase = 2.0 * std::numbers::pi * k / 125.0;  // 0.1 m at 8 Hz: 5 m/s.
    return Pose{
        {0.02 * std::sin(3.0 * phase), 0.0, 0.1 * std::cos(phase)},
        Eigen::Quaterniond(Eigen::AngleAxisd(0.08 * k, Vector3d(1.0, 2.0, 0.5).normalized()))};
  });
  EXPECT_GT(recorded.least_height, 0.004);
  const RunVerification proof = verify_text(recorded.run);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_EQ(proof.steps, 200U);
  EXPECT_GT(proof.least_distance, 0.0);
}

const char* const kPusher = R"({"firstcontact": 1, "bodies": [
  {"name": "tool", "shape": {"sphere": {"radius": 0.01}}},
  {"name": "pusher", "shape": {"box": {"size": [0.02, 0.1, 0.1]}},
   "motion": {"type": "constant_velocity", "from": {"position": [-0.05, 0, 0]}, "to": {"position": [0.05, 0, 0]}}},
  {"name": "wall", "shape": {"box": {"size": [0.02, 0.1, 0.1]}}, "pose": {"position": [0.06, 0, 0]}}],
  "options": {"duration": 0.2}, "haptics": {"tools": [{"body": "tool"}]}})";

TEST(HapticRun, SaysThatItIsOne) {
  const Recorded recorded = record_cycles(kPlate, 1, [](int, std::size_t) { return Pose{}; });
  std::istringstream stream(recorded.run);
  EXPECT_EQ(RunReader(stream, "run.jsonl").header().kind, RunKind::haptics);
}

// A spring of 1000 N/m at a scale of 2: the hand feels twice the force of the spring.
TEST(HapticRun, HoldsDevicesOfTicksWithTheForcesThatHandsFeel) {
  Scene scene = parse_scene(R"({"firstcontact": 1, "bodies": [
    {"name": "plate", "shape": {"box": {"size": [0.3, 0.3, 0.01]}}},
    {"name": "tool", "shape": {"box": {"size": [0.02, 0.03, 0.01]}}, "pose": {"position": [0, 0, 0.0101]}}],
    "haptics": {"tools": [{"body": "tool", "scale": 2}]}})",
                            "scene.json");
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  const LoadedScene loaded = load_scene(std::move(scene), cache);
  const HapticSetup setup = haptic_setup(loaded);
  HapticSession session(setup.scene, setup.options);
  HapticRun run(loaded, setup, session.contacts().contact_distance());
  std::string text = write_run_header(run.header());
  RunStep last;
  ForceTick tick;
  for (std::uint64_t k = 1; k <= 2000; ++k) {
    DeviceState state;
    state.time_ns = session.time_ns();
    state.sequence = k;
    state.status = DeviceStatus::live;
    state.X_DH.position = {0.0, 0.0, k == 1999 ? std::nan("") : -0.001};
    const ForceTick& now = session.step(std::array{state});
    if (session.cycle() != nullptr) {
      tick = now;
      last = run.step(*session.cycle(), run.devices(now));
      text += write_run_step(last);
    }
  }
  ASSERT_EQ(last.devices.size(), 1U);
  const RunDevice& device = last.devices[0];
  EXPECT_EQ(device.body, 1U);
  EXPECT_NEAR(device.X_WB.position.z(), 0.0081, 1e-12);
  const double spring = 1000.0 * 0.0019;  // The tool rests about 1 µm above the plate.
  EXPECT_NEAR(device.force.z(), 2.0 * spring, 0.02);
  EXPECT_LT((device.force - tick.tools[0].asked.force_D).norm(), 1e-12);
  EXPECT_EQ(verify_text(text).verdict, ProofVerdict::proven);
}

TEST(HapticRun, IsProvenWhereSurroundingsMoveAndHaveToWait) {
  const Recorded recorded = record_cycles(kPusher, 200, [](int, std::size_t) { return Pose{}; });
  const RunVerification proof = verify_text(recorded.run);
  EXPECT_EQ(proof.verdict, ProofVerdict::proven) << proof.problem;
  EXPECT_EQ(proof.time_lost, 0.0);
  EXPECT_GT(proof.greatest_behind, 0.05);
}

// Two surfaces full of bumps: what is pressed into them and turned sank from round to round.
TEST(HapticRun, DoesNotWedgeABunnyThatIsPressedOnABunny) {
  const std::string mesh =
      R"({"mesh": ")" FIRSTCONTACT_SOURCE_DIR R"(/data/stanford/stanford-bunny.obj"})";
  const std::string text = R"({"firstcontact": 1, "bodies": [{"name": "still", "shape": )" + mesh +
                           R"(}, {"name": "held", "shape": )" + mesh +
                           R"(, "pose": {"position": [0.02, 0.16, 0]}}],
      "haptics": {"tools": [{"body": "held"}]}})";
  Scene scene = parse_scene(text, "scene.json");
  ShapeCache cache;
  prepare_haptics(scene, cache, 1.0);
  const HapticSetup setup = haptic_setup(load_scene(std::move(scene), cache));
  ContactLoop loop(setup.scene, setup.options.contacts);
  std::size_t contacts = 0;
  for (int k = 0; k < test::rounds(400, 200); ++k) {
    const double angle = 0.01 * k;
    const Pose target{{0.02 * std::cos(angle), 0.16 - 2e-4 * k, 0.01 * std::sin(2.0 * angle)},
                      Eigen::Quaterniond(
                          Eigen::AngleAxisd(0.3 * std::sin(3.0 * angle), Vector3d(0.6, 0.0, 0.8)))};
    const HapticCycle& cycle = loop.advance(std::array{target}, 1e-3, k);
    contacts += cycle.contacts > 1 ? 1 : 0;
    ASSERT_GT(cycle.clearance, 0.25 * loop.contact_distance()) << k;
  }
  EXPECT_GT(static_cast<int>(contacts), test::rounds(100, 50));
}

// The test of the test: a record whose god-object is where the device is.
TEST(HapticRun, IsRefutedWhereAGodObjectPasses) {
  Scene scene = parse_scene(kPlate, "scene.json");
  ShapeCache cache;
  prepare_haptics(scene, cache, 0.01);
  const LoadedScene loaded = load_scene(std::move(scene), cache);
  HapticSetup setup = haptic_setup(loaded);
  setup.scene.ignored_pairs = {{0, 1}};
  ContactLoop loop(setup.scene);
  HapticRun run(loaded, setup, loop.contact_distance());
  std::string text = write_run_header(run.header());
  for (int k = 0; k < 10; ++k) {
    HapticCycle cycle = loop.advance(std::array{Pose{{0.0, 0.0, 0.1 - 0.02 * k}}}, 1e-3, k);
    cycle.clearance = 1e-6;
    text += write_run_step(run.step(cycle));
  }
  EXPECT_EQ(verify_text(text).verdict, ProofVerdict::refuted);
}

TEST(HapticLog, HasAValueForEachColumn) {
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  ForceTick tick;
  tick.tools[0].faults = 2 | 64;
  const std::string lines = haptic_tick_lines(tick, 2);
  const std::string first = lines.substr(0, lines.find('\n'));
  EXPECT_EQ(commas(haptic_tick_header()), commas(first));
  EXPECT_NE(first.find("not_finite|slewed"), std::string::npos);
  EXPECT_EQ(commas(haptic_cycle_header()), commas(haptic_cycle_line({}, 5)));
  WallSessionReport report;
  report.tick_cpu.add(1000);
  report.cycle_wall.add(1000);
  report.cycle_wall.add(1001);
  EXPECT_EQ(haptic_timing_csv(report), "what,from_ns,count\ntick_cpu,960,1\ncycle_wall,960,2\n");
}

}  // namespace
}  // namespace firstcontact
