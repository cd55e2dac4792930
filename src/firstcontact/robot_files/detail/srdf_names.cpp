#include <firstcontact/robot_files/detail/srdf_names.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kPlanner = "settings of planners";

XmlContents robot_names() {
  return {.attributes = {.read = {"name"}, .harmless = {{"version", "of the format"}}},
          .children = {.read = {"group", "group_state", "end_effector", "disable_collisions",
                                "enable_collisions", "disable_default_collisions"},
                       .harmless = {{"virtual_joint", "the robot stands where the scene says"},
                                    {"passive_joint", kPlanner},
                                    {"joint_property", kPlanner},
                                    {"link_sphere_approximation", "the geometry is the URDF's"},
                                    {"rotor_params", "settings of a simulator"},
                                    {"gripper", kPlanner},
                                    {"handle", kPlanner},
                                    {"contact", kPlanner}}}};
}

XmlContents names(std::vector<std::string_view> attributes,
                  std::vector<std::string_view> children = {}) {
  return {.attributes = {.read = std::move(attributes)}, .children = {.read = std::move(children)}};
}

}  // namespace

const SrdfNames& srdf_names() {
  static const SrdfNames all{
      .robot = robot_names(),
      .pair = names({"link1", "link2", "reason"}),
      .link = names({"link"}),
      .group = names({"name"}, {"link", "joint", "passive_joint", "chain", "group"}),
      .member = names({"name"}),
      .chain = names({"base_link", "tip_link"}),
      .state = names({"name", "group"}, {"joint"}),
      .value = names({"name", "value"}),
      .effector = names({"name", "parent_link", "group", "parent_group"}),
      .telling = {.anywhere = {"disable_collisions", "enable_collisions"},
                  .with_parts = {},
                  .in_place = {"macro", "property", "include"}}};
  return all;
}

}  // namespace firstcontact::detail
