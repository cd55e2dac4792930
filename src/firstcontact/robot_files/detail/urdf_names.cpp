#include <firstcontact/robot_files/detail/urdf_names.h>

namespace firstcontact::detail {
namespace {

constexpr std::string_view kLooks = "looks";
constexpr std::string_view kSimulator = "settings of a simulator";
constexpr std::string_view kGrid = "a grid that some simulators make of the geometry";
constexpr std::string_view kController = "settings of controllers";
constexpr std::string_view kSensor = "a sensor: no geometry";
constexpr std::string_view kLabel = "a label";
constexpr std::string_view kFrame = "a frame: no geometry";
constexpr std::string_view kPairs =
    "pairs that another program does not test; here an SRDF says so";
constexpr std::string_view kFaster = "limits of what is faster than velocity";

XmlContents robot_names() {
  return {.attributes = {.read = {"name"}, .harmless = {{"version", "of the format"}}},
          .children = {.read = {"link", "joint", "gazebo"},
                       .harmless = {{"material", kLooks},
                                    {"texture", kLooks},
                                    {"transmission", kController},
                                    {"ros2_control", kController},
                                    {"ros_control", kController},
                                    {"actuator", kController},
                                    {"sensor", kSensor},
                                    {"frame", kFrame},
                                    {"mujoco", kSimulator},
                                    {"isaac", kSimulator},
                                    {"isaac_sim", kSimulator},
                                    {"verbose", kSimulator},
                                    {"self_collision_checking", kPairs},
                                    {"collision_checking", kPairs},
                                    {"collision_filter_group", kPairs},
                                    {"drake:collision_filter_group", kPairs},
                                    {"disable_collisions", kPairs}}}};
}

XmlContents link_names() {
  return {.attributes = {.read = {"name", "type"}, .harmless = {{"drake_ignore", kSimulator}}},
          .children = {.read = {"visual", "collision", "inertial", "origin"},
                       .harmless = {{"material", kLooks},
                                    {"verbose", kSimulator},
                                    {"contact", kSimulator},
                                    {"inertia_scaling", kSimulator},
                                    {"audio_source", kSimulator},
                                    {"gazebo", kSimulator},
                                    {"sensor", kSensor},
                                    {"self_filter", "settings of a filter for point clouds"},
                                    {"collision_checking", kPairs},
                                    {"self_collision_checking", kPairs}}}};
}

XmlContents collision_names() {
  return {.attributes = {.read = {"name"},
                         .harmless = {{"group", kSimulator}, {"concave", kSimulator}}},
          .children = {.read = {"origin", "geometry"},
                       .harmless = {{"material", kLooks},
                                    {"sdf", kGrid},
                                    {"verbose", kSimulator},
                                    {"contact", kSimulator},
                                    {"surface", kSimulator},
                                    {"contact_coefficients", kSimulator}}}};
}

XmlContents visual_names() {
  return {.attributes = {.read = {"name"}},
          .children = {.read = {"origin", "geometry"},
                       .harmless = {{"material", kLooks},
                                    {"texture", kLooks},
                                    {"color", kLooks},
                                    {"transparency", kLooks},
                                    {"cast_shadows", kLooks},
                                    {"verbose", kSimulator}}}};
}

XmlNames strict(std::vector<std::string_view> read, std::vector<HarmlessName> harmless = {}) {
  return {.read = std::move(read), .harmless = std::move(harmless), .is_strict = true};
}

/// The attributes of an element that places geometry.
XmlNames strict_attributes(std::vector<std::string_view> read) {
  return strict(std::move(read), {{"name", kLabel},
                                  {"id", kLabel},
                                  {"group", kLabel},
                                  {"comment", kLabel},
                                  {"description", kLabel}});
}

XmlContents joint_names() {
  return {.attributes = {.read = {"name", "type", "pitch"}},
          .children = {.read = {"origin", "parent", "child", "axis", "limit", "mimic", "dynamics",
                                "drake:mimic"},
                       .harmless = {{"calibration", kController},
                                    {"safety_controller", kController},
                                    {"hardwareInterface", kController},
                                    {"joint_properties", kSimulator},
                                    {"gazebo", kSimulator},
                                    {"sensor", kSensor}}}};
}

TellingNames telling_names() {
  return {.anywhere = {"collision",  "visual", "geometry", "geom",        "mesh",
                       "submesh",    "box",    "sphere",   "cylinder",    "capsule",
                       "ellipsoid",  "cone",   "plane",    "heightmap",   "heightfield",
                       "polyline",   "group",  "model",    "body",        "loop",
                       "deformable", "macro",  "include",  "superquadric"},
          .with_parts = {"link", "joint"},
          .in_place = {"origin", "pose", "transform", "axis", "parent", "child", "mimic",
                       "property", "insert_block", "if", "unless"}};
}

}  // namespace

const UrdfNames& urdf_names() {
  static const UrdfNames names{
      .robot = robot_names(),
      .link = link_names(),
      .inertial = {.attributes = {.read = {}}, .children = {.read = {"origin", "mass", "inertia"}}},
      .mass = {.attributes = {.read = {"value"}}, .children = {.read = {}}},
      .inertia = {.attributes = {.read = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}},
                  .children = {.read = {}}},
      .collision = collision_names(),
      .visual = visual_names(),
      .geometry = {.attributes = strict_attributes({}),
                   .children =
                       strict({"mesh", "box", "sphere", "cylinder", "capsule", "drake:capsule"},
                              {{"material", kLooks},
                               {"texture", kLooks},
                               {"color", kLooks},
                               {"sdf", kGrid},
                               {"verbose", kSimulator},
                               {"contact", kSimulator},
                               {"surface", kSimulator}})},
      .mesh = {.attributes = strict_attributes({"filename", "scale"}),
               .children = strict({"drake:declare_convex"},
                                  {{"material", kLooks}, {"texture", kLooks}, {"color", kLooks}})},
      .box = {.attributes = strict_attributes({"size"}), .children = strict({})},
      .sphere = {.attributes = strict_attributes({"radius"}), .children = strict({})},
      .round = {.attributes = strict_attributes({"radius", "length"}), .children = strict({})},
      .origin = {.attributes = strict_attributes({"xyz", "rpy", "quat_xyzw"}),
                 .children = strict({})},
      .joint = joint_names(),
      .link_name = {.attributes = {.read = {"link"}}, .children = {.read = {}}},
      .axis = {.attributes = strict_attributes({"xyz", "rpy"}), .children = strict({})},
      .limit = {.attributes = {.read = {"lower", "upper", "velocity", "effort"},
                               .harmless = {{"acceleration", kFaster},
                                            {"deceleration", kFaster},
                                            {"jerk", kFaster}}},
                .children = {.read = {}}},
      .mimic = {.attributes = strict({"joint", "multiplier", "offset"}), .children = strict({})},
      .dynamics = {.attributes = {.read = {"damping", "friction"},
                                  .harmless = {{"armature", kSimulator},
                                               {"frictionloss", kSimulator},
                                               {"spring_stiffness", kSimulator},
                                               {"spring_reference", kSimulator}}},
                   .children = {.read = {}}},
      .telling = telling_names()};
  return names;
}

}  // namespace firstcontact::detail
