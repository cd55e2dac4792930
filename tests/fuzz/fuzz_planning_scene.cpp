#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <variant>

#include <firstcontact/scene/planning_scene.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
#include "scene/crane.h"

namespace {

using firstcontact::test::require;

/// Any bytes give bodies with finite poses, or a request, or a ParseError of one line.
void fuzz_planning_scene(std::string_view text) {
  try {
    const auto scene = firstcontact::parse_planning_scene(text, "f.yaml", "ground");
    require(scene.bodies.size() == scene.object_ids.size());
    for (const firstcontact::Body& body : scene.bodies) {
      const auto& pose = std::get<firstcontact::FixedMotion>(body.motion).pose;
      require(pose.position.allFinite() && pose.rotation.coeffs().allFinite());
    }
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

void fuzz_request(std::string_view text) {
  static const firstcontact::RobotModel robot = firstcontact::test::crane();
  try {
    const auto request = firstcontact::parse_planning_request(text, "f.yaml", robot);
    (void)firstcontact::straight_motion(robot, request.start, request.goal);
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  fuzz_planning_scene(text);
  fuzz_request(text);
  return 0;
}
