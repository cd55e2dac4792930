#include <firstcontact/scene_files/detail/read_haptics.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/detail/read_grips.h>
#include <firstcontact/scene_files/detail/read_pose.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kMostHapticTools = 2;
constexpr double kMostScale = 1e6;  // [-]  As in a mapping of a device.
// [N/m, N m/rad]  Beyond it a force is that of rounded coordinates.
constexpr double kMostStiffness = 1e17;

class HapticsReader {
 public:
  HapticsReader(const Scene& scene, const JsonReader& read) : scene_(scene), read_(read) {}

  HapticQuestion haptics(const JsonValue& value) const {
    const JsonObject& object = read_.object(
        value, {{"tools", "contact_distance", "friction", "force_rate", "contact_rate", "max_force",
                 "max_torque", "force_slew", "torque_slew", "max_grip_effort"}});
    HapticQuestion haptics;
    const JsonValue& tools = read_.member(value, "tools");
    for (const JsonValue& element : read_.array(tools, "an array of tools")) {
      haptics.tools.push_back(tool(element, haptics));
    }
    if (haptics.tools.empty() || haptics.tools.size() > kMostHapticTools) {
      read_.fail(tools, "expected 1 or 2 tools, got " + std::to_string(haptics.tools.size()));
    }
    if (const JsonValue* distance = find(object, "contact_distance")) {
      haptics.contact_distance = read_.positive(*distance);
    }
    take_not_negative(object, "friction", haptics.friction);
    take_positive(object, "force_rate", haptics.force_rate);
    haptics.contact_rate = std::min(haptics.contact_rate, haptics.force_rate);
    take_positive(object, "contact_rate", haptics.contact_rate);
    take_not_negative(object, "max_force", haptics.max_force);
    take_not_negative(object, "max_torque", haptics.max_torque);
    take_positive(object, "force_slew", haptics.force_slew);
    take_positive(object, "torque_slew", haptics.torque_slew);
    take_not_negative(object, "max_grip_effort", haptics.max_grip_effort);
    require_rates(value, haptics);
    return haptics;
  }

 private:
  void require_rates(const JsonValue& value, const HapticQuestion& haptics) const {
    constexpr double kLeastForceRate = 100.0;  // [Hz]
    constexpr double kLeastRate = 1.0;         // [Hz]
    if (!(haptics.force_rate <= 1e6 && haptics.force_rate >= kLeastForceRate)) {
      read_.fail_expected("100 Hz to 1e6 Hz", read_.member(value, "force_rate"));
    }
    if (!(haptics.contact_rate >= kLeastRate)) {
      read_.fail_expected("1 Hz or more", read_.member(value, "contact_rate"));
    }
    if (!(haptics.contact_rate <= haptics.force_rate)) {
      read_.fail(value, "expected a \"contact_rate\" that is at most the \"force_rate\"");
    }
  }

  HapticToolQuestion tool(const JsonValue& value, const HapticQuestion& before) const {
    const JsonObject& object =
        read_.object(value, {{"body", "robot", "stiffness", "angular_stiffness", "damping",
                              "centre", "scale", "device_axes", "handle", "begins_at_handle",
                              "clutch_button", "dead_man_button", "grips"}});
    HapticToolQuestion tool;
    const JsonValue* robot = find(object, "robot");
    const bool has_body = find(object, "body") != nullptr;
    if (robot != nullptr && has_body) {
      read_.fail(*robot, "expected either \"body\" or \"robot\", got both");
    }
    if (robot == nullptr && !has_body) {
      read_.fail(value, "expected either \"body\" or \"robot\", got neither");
    }
    if (robot != nullptr) {
      tool.robot = robot_named(*robot, before);
    } else {
      tool.body = body(read_.member(value, "body"), before);
    }
    take_stiffness(object, "stiffness", tool.stiffness);
    take_stiffness(object, "angular_stiffness", tool.angular_stiffness);
    take_not_negative(object, "damping", tool.damping);
    take_positive(object, "scale", tool.scale);
    if (!(tool.scale <= kMostScale)) {
      read_.fail_expected("a number > 0 of at most 1e6", *find(object, "scale"));
    }
    if (const JsonValue* centre = find(object, "centre")) {
      tool.centre = read_.vector3(*centre);
    }
    if (const JsonValue* axes = find(object, "device_axes")) {
      const Pose pose = read_pose(*axes, read_);
      if (!pose.position.isZero(0.0)) {
        read_.fail(*axes, "expected a rotation alone, got a position too");
      }
      tool.device_axes = pose.rotation;
    }
    if (const JsonValue* handle = find(object, "handle")) {
      tool.handle = read_pose(*handle, read_);
    }
    if (const JsonValue* begins = find(object, "begins_at_handle")) {
      tool.begins_at_handle = read_.boolean(*begins);
      if (tool.begins_at_handle && find(object, "handle") != nullptr) {
        read_.fail(*begins, "expected either a \"handle\" or \"begins_at_handle\": true, got both");
      }
    }
    tool.clutch_button = button(object, "clutch_button");
    tool.dead_man_button = button(object, "dead_man_button");
    if (tool.clutch_button && tool.clutch_button == tool.dead_man_button) {
      read_.fail(*find(object, "dead_man_button"),
                 "expected another button than that of the clutch: the tool would never be felt");
    }
    if (const JsonValue* grips = find(object, "grips")) {
      if (!tool.robot) {
        read_.fail(*grips, "expected \"grips\" with a \"robot\" alone: a body has no joints");
      }
      tool.grips = read_grips(*grips, scene_.robots[*tool.robot], read_);
    }
    return tool;
  }

  std::size_t body(const JsonValue& value, const HapticQuestion& before) const {
    const std::string& name = read_.string(value, "the name of a body");
    const auto found =
        std::ranges::find_if(scene_.bodies, [&](const Body& one) { return one.name == name; });
    if (found == scene_.bodies.end()) {
      std::vector<std::string_view> names;
      for (const Body& one : scene_.bodies) {
        names.push_back(one.name);
      }
      read_.fail_expected("a body of the scene (" + listed(names) + ")", value);
    }
    const auto number = static_cast<std::size_t>(found - scene_.bodies.begin());
    if (!std::holds_alternative<FixedMotion>(found->motion) || found->free) {
      read_.fail(value, "expected a body with a \"pose\" alone: a device moves \"" + name + "\"");
    }
    for (const HapticToolQuestion& other : before.tools) {
      if (!other.robot && other.body == number) {
        read_.fail(value, "expected another body than that of the other tool");
      }
    }
    return number;
  }

  std::size_t robot_named(const JsonValue& value, const HapticQuestion& before) const {
    const std::string& name = read_.string(value, "the name of a robot");
    const auto found = std::ranges::find_if(
        scene_.robots, [&](const SceneRobot& one) { return one.name == name; });
    if (found == scene_.robots.end()) {
      std::vector<std::string_view> names;
      for (const SceneRobot& one : scene_.robots) {
        names.push_back(one.name);
      }
      read_.fail_expected(names.empty() ? "a robot of the scene, which has none"
                                        : "a robot of the scene (" + listed(names) + ")",
                          value);
    }
    const auto number = static_cast<std::size_t>(found - scene_.robots.begin());
    for (const HapticToolQuestion& other : before.tools) {
      if (other.robot == number) {
        read_.fail(value, "expected another robot than that of the other tool");
      }
    }
    return number;
  }

  std::optional<int> button(const JsonObject& object, std::string_view key) const {
    const JsonValue* value = find(object, key);
    if (value == nullptr) {
      return {};
    }
    return static_cast<int>(read_.index(*value, kButtonsOfDevice, "a button"));
  }

  void take_positive(const JsonObject& object, std::string_view key, double& number) const {
    if (const JsonValue* value = find(object, key)) {
      number = read_.positive(*value);
    }
  }

  void take_stiffness(const JsonObject& object, std::string_view key, double& number) const {
    take_positive(object, key, number);
    if (!(number <= kMostStiffness)) {
      read_.fail_expected("a number > 0 of at most 1e17", *find(object, key));
    }
  }

  void take_not_negative(const JsonObject& object, std::string_view key, double& number) const {
    if (const JsonValue* value = find(object, key)) {
      number = read_.not_negative(*value);
    }
  }

  const Scene& scene_;
  const JsonReader& read_;
};

}  // namespace

HapticQuestion read_haptics(const JsonValue& value, const Scene& scene, const JsonReader& read) {
  return HapticsReader(scene, read).haptics(value);
}

}  // namespace firstcontact::detail
