#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include <firstcontact/scene/read_trajectory.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
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
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  } catch (const std::invalid_argument& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace

/// The first byte picks the format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) {
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    fuzz_trajectory(text, data[0] == 'c' ? "f.csv" : data[0] == 'j' ? "f.json" : "f.yaml");
  }
  return 0;
}
