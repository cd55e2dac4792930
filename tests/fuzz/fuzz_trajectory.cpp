#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <firstcontact/scene/whole_turn_jumps.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/trajectory_files/read_trajectory.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/text_mutator.h"
#include "scene/crane.h"

namespace {

using firstcontact::test::require;

/// Any bytes give a trajectory that makes joint motions, unless a joint that mimics another says
/// something else; or a ParseError of one line.
void fuzz_trajectory(std::string_view text, const char* file) {
  static const firstcontact::RobotModel robot = firstcontact::test::crane();
  try {
    const firstcontact::Trajectory trajectory = firstcontact::parse_trajectory(text, file, robot);
    require(!trajectory.points.empty() && !trajectory.joint_names.empty());
    const double last = trajectory.points.back().time;
    (void)firstcontact::joint_motions(robot, trajectory, {}, last > 0.0 ? last : 1.0);
    (void)firstcontact::joint_turns(robot, trajectory);
    (void)firstcontact::whole_turn_jumps(robot, trajectory);
    (void)firstcontact::unwrapped(robot, trajectory);
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  } catch (const std::invalid_argument& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace

/// Words of trajectories, and words that may be mistaken for them.
constexpr std::array<std::string_view, 26> kWords = {"joint_names",
                                                     "points",
                                                     "header",
                                                     "time",
                                                     "time_from_start",
                                                     "secs",
                                                     "nsecs",
                                                     "sec",
                                                     "nanosec",
                                                     "positions",
                                                     "velocities",
                                                     "accelerations",
                                                     "effort",
                                                     "joint_trajectory",
                                                     "trajectory",
                                                     "multi_dof_joint_trajectory",
                                                     "turn",
                                                     "lift",
                                                     "rail/x",
                                                     "rail/theta",
                                                     "follow",
                                                     "weld",
                                                     "turn.velocity",
                                                     "turn.acceleration",
                                                     "/s/lift/position",
                                                     "time [s]"};

/// The first byte picks the format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) {
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    fuzz_trajectory(text, data[0] == 'c' ? "f.csv" : data[0] == 'j' ? "f.json" : "f.yaml");
  }
  return 0;
}

/// Keeps the first byte, mostly.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  auto* text = reinterpret_cast<char*>(data);
  if (size < 2 || most < 2 || seed % 16 == 0) {
    return firstcontact::test::mutate_text(text, size, most, seed, kWords);
  }
  return 1 + firstcontact::test::mutate_text(text + 1, size - 1, most - 1, seed, kWords);
}
