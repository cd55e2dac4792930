#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/small_stack.h"
#include "fuzz/xml_mutator.h"

namespace {

using firstcontact::test::require;

const firstcontact::test::XmlWords& urdf_words() {
  static const firstcontact::test::XmlWords words{
      .names = {"robot",      "link",     "joint",         "collision",   "visual",
                "geometry",   "origin",   "box",           "sphere",      "cylinder",
                "capsule",    "mesh",     "inertial",      "mass",        "inertia",
                "axis",       "limit",    "mimic",         "parent",      "child",
                "dynamics",   "material", "gazebo",        "sdf",         "group",
                "loop_joint", "name",     "type",          "xyz",         "rpy",
                "quat_xyzw",  "size",     "radius",        "length",      "filename",
                "scale",      "lower",    "upper",         "velocity",    "effort",
                "multiplier", "offset",   "drake:capsule", "drake:mimic", "drake:ellipsoid",
                "pitch",      "value"},
      .values = {"base",       "a",         "b",      "c",        "d",
                 "ja",         "jb",        "jc",     "fixed",    "revolute",
                 "continuous", "prismatic", "planar", "floating", "ball",
                 "screw",      "0 0 1",     "1 1 1",  "a.stl",    "package://x/a.stl"}};
  return words;
}

/// Any bytes give a robot whose links all hang on its root, or a ParseError of one line.
void fuzz_urdf(std::string_view text, bool lenient) {
  try {
    const firstcontact::RobotModel robot =
        firstcontact::parse_urdf(text, "fuzz.urdf",
                                 {.package_roots = {},
                                  .shapes = firstcontact::LoadShapes::collision,
                                  .reading = {.lenient = lenient}});
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

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t greatest);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t greatest, unsigned seed) {
  return firstcontact::test::mutate_xml(data, size, greatest, seed, urdf_words(), LLVMFuzzerMutate);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const bool lenient : {false, true}) {
    fuzz_urdf({reinterpret_cast<const char*>(data), size}, lenient);
  }
  return 0;
}
