#include <firstcontact/scene_files/detail/read_grips.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kMostGripsOfTool = 16;

class GripsReader {
 public:
  GripsReader(const SceneRobot& robot, const JsonReader& read) : robot_(robot), read_(read) {}

  std::vector<HapticGripQuestion> grips(const JsonValue& value) {
    std::vector<HapticGripQuestion> grips;
    for (const JsonValue& element : read_.array(value, "an array of grips")) {
      grips.push_back(grip(element));
    }
    if (grips.empty() || grips.size() > kMostGripsOfTool) {
      read_.fail(value, "expected 1 to " + std::to_string(kMostGripsOfTool) + " grips, got " +
                            std::to_string(grips.size()) +
                            (grips.empty() ? "; leave the key out where nothing moves" : ""));
    }
    return grips;
  }

 private:
  HapticGripQuestion grip(const JsonValue& value) {
    const JsonObject& object = read_.object(value, {{"joints", "stiffness", "button", "seconds"}});
    HapticGripQuestion grip;
    const JsonValue& joints = read_.member(value, "joints");
    const auto* named = std::get_if<JsonObject>(&joints.value);
    if (named == nullptr || named->empty()) {
      read_.fail_expected("positions by joint, open and closed, such as {\"finger\": [0, 0.8]}",
                          joints);
    }
    for (const auto& [name, positions] : *named) {
      grip.joints.push_back(joint(name, positions));
    }
    if (const JsonValue* stiffness = find(object, "stiffness")) {
      grip.stiffness = read_.positive(*stiffness);
    }
    if (const JsonValue* button = find(object, "button")) {
      grip.button = static_cast<int>(read_.index(*button, kButtonsOfDevice, "a button"));
    }
    if (const JsonValue* seconds = find(object, "seconds")) {
      if (!grip.button) {
        read_.fail(*seconds, "expected \"seconds\" with a \"button\" alone");
      }
      grip.seconds = read_.positive(*seconds);
    }
    return grip;
  }

  HapticGripJoint joint(const std::string& name, const JsonValue& value) {
    HapticGripJoint made{.joint = joint_named(name, value)};
    const JsonArray& positions = read_.array(value, "two positions, open and closed");
    if (positions.size() != 2) {
      read_.fail(value, "expected two positions, open and closed, got " +
                            std::to_string(positions.size()));
    }
    made.open = position(made.joint, positions[0]);
    made.closed = position(made.joint, positions[1]);
    if (made.open == made.closed) {
      read_.fail(value, "expected two positions that differ, or the joint left out");
    }
    return made;
  }

  std::size_t joint_named(const std::string& name, const JsonValue& value) {
    const auto found = robot_.model.find_joint(name);
    if (!found) {
      std::vector<std::string_view> names;
      for (const Joint& each : robot_.model.joints()) {
        if (coordinate_count(each.type) == 1 && !each.mimic) {
          names.push_back(each.name);
        }
      }
      read_.fail(value, "robot " + in_quotes(robot_.name) + " has no joint " + in_quotes(name) +
                            "; expected one of " + listed(names));
    }
    const Joint& joint = robot_.model.joints()[*found];
    if (coordinate_count(joint.type) != 1) {
      read_.fail(value, "joint " + in_quotes(name) + " is " + to_string(joint.type) +
                            "; expected a joint with one coordinate");
    }
    if (joint.mimic) {
      read_.fail(value, "joint " + in_quotes(name) + " follows " + in_quotes(joint.mimic->joint) +
                            " by itself; name that one instead");
    }
    if (!joints_.insert(*found).second) {
      read_.fail(value, "joint " + in_quotes(name) + " stands twice; expected each in one grip");
    }
    return *found;
  }

  /// Reads a position within the limits of the joint, and of those that mimic it.
  double position(std::size_t number, const JsonValue& value) const {
    const double position = read_.number(value);
    const std::span<const Joint> joints = robot_.model.joints();
    for (const Joint& joint : joints) {
      const std::optional<double> there = led_to(joint, joints[number], position);
      if (!there || (there >= joint.limits.lower.value_or(*there) &&
                     there <= joint.limits.upper.value_or(*there))) {
        continue;
      }
      const auto limit = [](const std::optional<double>& number_of) {
        return number_of ? write_json(*number_of) : std::string("none");
      };
      const std::string limits =
          limit(joint.limits.lower) + " to " + limit(joint.limits.upper) + ", got ";
      read_.fail(value, "expected a position of joint " + in_quotes(joints[number].name) +
                            (joint.mimic ? " that leads " + in_quotes(joint.name) : std::string()) +
                            " within its limits, " + limits + write_json(*there));
    }
    return position;
  }

  /// The position of a joint that is the leader, or mimics it; none for others.
  [[nodiscard]] std::optional<double> led_to(const Joint& joint, const Joint& leader,
                                             double position) const {
    if (joint.name == leader.name) {
      return position;
    }
    if (!joint.mimic) {
      return std::nullopt;
    }
    const Joint& next = robot_.model.joints()[robot_.model.find_joint(joint.mimic->joint).value()];
    const std::optional<double> there = led_to(next, leader, position);
    return there ? std::optional(joint.mimic->multiplier * *there + joint.mimic->offset)
                 : std::nullopt;
  }

  const SceneRobot& robot_;
  const JsonReader& read_;
  std::set<std::size_t> joints_;
};

}  // namespace

std::vector<HapticGripQuestion> read_grips(const JsonValue& value, const SceneRobot& robot,
                                           const JsonReader& read) {
  return GripsReader(robot, read).grips(value);
}

}  // namespace firstcontact::detail
