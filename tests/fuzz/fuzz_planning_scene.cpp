#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <variant>

#include <firstcontact/foreign_scenes/planning_scene.h>
#include <firstcontact/text/parse_error.h>

#include "fuzz/fuzz_reader.h"
#include "fuzz/text_mutator.h"
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
    (void)firstcontact::straight_motion(robot, request.start, request.goals.front().positions);
  } catch (const firstcontact::ParseError& error) {
    require(std::strchr(error.what(), '\n') == nullptr);
  }
}

/// Words of the messages, and words that may be mistaken for them.
constexpr std::array<std::string_view, 44> kWords = {"world",
                                                     "collision_objects",
                                                     "id",
                                                     "header",
                                                     "frame_id",
                                                     "pose",
                                                     "position",
                                                     "orientation",
                                                     "primitives",
                                                     "primitive_poses",
                                                     "type",
                                                     "dimensions",
                                                     "box",
                                                     "sphere",
                                                     "cylinder",
                                                     "cone",
                                                     "meshes",
                                                     "mesh_poses",
                                                     "vertices",
                                                     "triangles",
                                                     "vertex_indices",
                                                     "resource",
                                                     "planes",
                                                     "operation",
                                                     "fixed_frame_transforms",
                                                     "child_frame_id",
                                                     "transform",
                                                     "translation",
                                                     "rotation",
                                                     "allowed_collision_matrix",
                                                     "entry_names",
                                                     "entry_values",
                                                     "enabled",
                                                     "default_entry_names",
                                                     "default_entry_values",
                                                     "link_padding",
                                                     "robot_state",
                                                     "attached_collision_objects",
                                                     "joint_state",
                                                     "name",
                                                     "multi_dof_joint_state",
                                                     "goal_constraints",
                                                     "joint_constraints",
                                                     "weld"};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  fuzz_planning_scene(text);
  fuzz_request(text);
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return firstcontact::test::mutate_text(reinterpret_cast<char*>(data), size, most, seed, kWords);
}
