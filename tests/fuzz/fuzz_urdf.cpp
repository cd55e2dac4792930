#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/articulated/read_urdf.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"

namespace {

using firstcontact::test::require;

/// Any bytes give a robot whose links all hang on its root, or a ParseError of one line.
void fuzz_urdf(std::string_view text) {
  try {
    const firstcontact::RobotModel robot = firstcontact::parse_urdf(
        text, "fuzz.urdf", {.package_roots = {}, .shapes = firstcontact::LoadShapes::none});
    require(!robot.links().empty());
    require(robot.joints().size() + 1 == robot.links().size());
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      require(robot.last_common_ancestor(robot.root(), link) == robot.root());
    }
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_urdf({reinterpret_cast<const char*>(data), size});
  return 0;
}
