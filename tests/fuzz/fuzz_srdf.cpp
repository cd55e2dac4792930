#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <firstcontact/robot_files/read_srdf.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/small_stack.h"
#include "fuzz/xml_mutator.h"

namespace {

using firstcontact::test::require;

const firstcontact::test::XmlWords& srdf_words() {
  static const firstcontact::test::XmlWords words{
      .names = {"robot",
                "group",
                "group_state",
                "end_effector",
                "disable_collisions",
                "enable_collisions",
                "disable_default_collisions",
                "link",
                "joint",
                "passive_joint",
                "chain",
                "virtual_joint",
                "name",
                "link1",
                "link2",
                "reason",
                "base_link",
                "tip_link",
                "value",
                "parent_link",
                "parent_group"},
      .values = {"fork", "base", "a", "b", "c", "ja", "jb", "jc", "arm", "hand"}};
  return words;
}

/// base -ja- a -jb- b, base -jc- c.
firstcontact::RobotModel fork() {
  const auto turning = [](const char* name, const char* parent, const char* child) {
    return firstcontact::Joint{.name = name,
                               .type = firstcontact::JointType::continuous,
                               .parent = parent,
                               .child = child};
  };
  return firstcontact::RobotModel(
      {.name = "fork",
       .links = {{"base", {}, {}}, {"a", {}, {}}, {"b", {}, {}}, {"c", {}, {}}},
       .joints = {turning("ja", "base", "a"), turning("jb", "a", "b"),
                  turning("jc", "base", "c")}});
}

/// Any bytes give indices that the robot has, or a ParseError of one line.
void fuzz_srdf(std::string_view text) {
  static const firstcontact::RobotModel robot = fork();
  try {
    const firstcontact::RobotSemantics semantics =
        firstcontact::parse_srdf(text, "fuzz.srdf", robot);
    for (const firstcontact::DisabledPair& pair : semantics.disabled) {
      require(pair.link < pair.other && pair.other < robot.links().size());
      require(semantics.is_disabled(pair.other, pair.link));
    }
    for (const firstcontact::RobotGroup& group : semantics.groups) {
      require(group.links.empty() || group.links.back() < robot.links().size());
      require(group.joints.empty() || group.joints.back() < robot.joints().size());
    }
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t greatest);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t greatest, unsigned seed) {
  return firstcontact::test::mutate_xml(data, size, greatest, seed, srdf_words(), LLVMFuzzerMutate);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_srdf({reinterpret_cast<const char*>(data), size});
  return 0;
}
