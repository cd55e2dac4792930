#include <firstcontact/scene_files/detail/read_robot_dynamics.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <firstcontact/robot/robot_description.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/scene_files/detail/read_dynamics.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {
namespace {

/// Stands for every joint that could have a motor and is not named.
constexpr std::string_view kOthers = "*";

/// Whether a joint moves by itself, along one coordinate.
bool can_have_motor(const Joint& joint) {
  return coordinate_count(joint.type) == 1 && !joint.mimic;
}

std::vector<TimedNumber> read_target(const JsonValue& value, const JsonReader& read) {
  if (std::holds_alternative<double>(value.value)) {
    return {{0.0, read.number(value)}};
  }
  const std::string expected = "a number, or [time, number] pairs such as [[0, 0], [1, 0.5]]";
  std::vector<TimedNumber> target;
  for (const JsonValue& row : read.array(value, expected)) {
    const JsonArray& pair = read.array(row, expected);
    if (pair.size() != 2) {
      read.fail_expected(expected, row);
    }
    target.push_back({read.not_negative(pair[0]), read.number(pair[1])});
    if (target.size() > 1 && !(target.back().time > target[target.size() - 2].time)) {
      read.fail_expected("times that increase", pair[0]);
    }
  }
  if (target.empty()) {
    read.fail_expected(expected, value);
  }
  return target;
}

class MotorReader {
 public:
  MotorReader(const SceneRobot& robot, const JsonReader& read) : robot_(robot), read_(read) {}

  std::map<std::size_t, JointMotor> motors(const JsonValue& value) const {
    const auto* object = std::get_if<JsonObject>(&value.value);
    if (object == nullptr) {
      read_.fail_expected("motors by joint, such as {\"elbow\": {\"position\": 0.5}}", value);
    }
    std::map<std::size_t, JointMotor> motors;
    const JsonValue* others = nullptr;
    for (const auto& [name, motor] : *object) {
      if (name == kOthers) {
        others = &motor;
      } else {
        const std::size_t joint = joint_named(motor, name);
        motors[joint] = this->motor(motor, joint);
      }
    }
    for (std::size_t j = 0; others != nullptr && j < robot_.model.joints().size(); ++j) {
      if (can_have_motor(robot_.model.joints()[j]) && !motors.contains(j)) {
        motors[j] = motor(*others, j);
      }
    }
    return motors;
  }

 private:
  std::size_t joint_named(const JsonValue& value, std::string_view name) const {
    std::size_t joint = 0;
    try {
      joint = find_coordinate(robot_.model, name).joint;
    } catch (const std::invalid_argument& error) {
      read_.fail(value, error.what());
    }
    if (!can_have_motor(robot_.model.joints()[joint])) {
      read_.fail(value,
                 "expected a joint of one coordinate that mimics no other, got " + in_quotes(name));
    }
    return joint;
  }

  JointMotor motor(const JsonValue& value, std::size_t joint) const {
    const JsonObject& object =
        read_.object(value, {{"position", "velocity", "torque", "stiffness", "damping", "effort"}});
    constexpr std::array kKeys{"position", "velocity", "torque"};
    JointMotor motor;
    const JsonValue* target = nullptr;
    for (std::size_t k = 0; k < kKeys.size(); ++k) {
      if (const JsonValue* given = find(object, kKeys.at(k))) {
        if (target != nullptr) {
          read_.fail(*given, "expected one of \"position\", \"velocity\", \"torque\", got two");
        }
        target = given;
        motor.kind = static_cast<JointMotor::Kind>(k);
      }
    }
    if (target == nullptr) {
      read_.fail(value, "expected \"position\", \"velocity\" or \"torque\", got none");
    }
    take_target(*target, joint, motor);
    take_strength(object, motor);
    return motor;
  }

  void take_target(const JsonValue& value, std::size_t joint, JointMotor& motor) const {
    const auto* word = std::get_if<std::string>(&value.value);
    if (word == nullptr) {
      motor.target = read_target(value, read_);
      return;
    }
    if (*word != "trajectory" || motor.kind != JointMotor::Kind::position) {
      read_.fail_expected(motor.kind == JointMotor::Kind::position
                              ? "a position, [time, position] pairs, or \"trajectory\""
                              : "a number, or [time, number] pairs",
                          value);
    }
    const std::string& name = robot_.model.joints()[joint].name;
    const auto& named = robot_.trajectory.joint_names;
    if (std::find(named.begin(), named.end(), name) == named.end()) {
      read_.fail(value, "expected a robot with a \"trajectory\" that names " + in_quotes(name));
    }
  }

  void take_strength(const JsonObject& object, JointMotor& motor) const {
    const JsonValue* stiffness = find(object, "stiffness");
    const JsonValue* damping = find(object, "damping");
    if (stiffness != nullptr) {
      if (motor.kind != JointMotor::Kind::position) {
        read_.fail(*stiffness, "expected \"stiffness\" of a \"position\" only");
      }
      motor.stiffness = read_.positive(*stiffness);
    }
    if (damping != nullptr) {
      if (stiffness == nullptr) {
        read_.fail(*damping, "expected \"damping\" beside a \"stiffness\" only");
      }
      motor.damping = read_.not_negative(*damping);
    }
    if (const JsonValue* effort = find(object, "effort")) {
      motor.effort = read_.not_negative(*effort);
    }
  }

  const SceneRobot& robot_;
  const JsonReader& read_;
};

/// Refuses a name that is no coordinate of a robot, or follows another one.
void require_own_coordinate(const SceneRobot& robot, const std::string& name,
                            const JsonValue& value, const JsonReader& read) {
  try {
    const std::size_t joint = find_coordinate(robot.model, name).joint;
    if (robot.model.joints()[joint].type == JointType::floating) {
      read.fail(value, "joint " + in_quotes(name) +
                           ": expected none, as a floating joint starts "
                           "at rest");
    }
    if (const std::optional<Mimic>& mimic = robot.model.joints()[joint].mimic) {
      read.fail(value, "joint " + in_quotes(name) + " follows " + in_quotes(mimic->joint) +
                           "; give the velocity of that one");
    }
  } catch (const std::invalid_argument& error) {
    read.fail(value, error.what());
  }
}

}  // namespace

RobotDynamics read_robot_dynamics(const JsonValue& value, const SceneRobot& robot,
                                  const JsonReader& read) {
  const JsonObject& object =
      read.object(value, {{"base", "linear_velocity", "angular_velocity", "velocities", "motors",
                           "density", "friction", "restitution"}});
  RobotDynamics dynamics;
  if (const JsonValue* base = find(object, "base")) {
    dynamics.has_free_base = read.word(*base, {{"fixed", "free"}}) == 1;
  }
  for (const auto& [key, velocity] : {std::pair{"linear_velocity", &dynamics.linear_velocity},
                                      std::pair{"angular_velocity", &dynamics.angular_velocity}}) {
    if (const JsonValue* given = find(object, key)) {
      if (!dynamics.has_free_base) {
        read.fail(*given, "expected \"base\": \"free\" beside the velocity of the base");
      }
      *velocity = read.vector3(*given);
    }
  }
  if (const JsonValue* velocities = find(object, "velocities")) {
    const auto* given = std::get_if<JsonObject>(&velocities->value);
    if (given == nullptr) {
      read.fail_expected("velocities by joint, such as {\"elbow\": 0.5}", *velocities);
    }
    for (const auto& [name, velocity] : *given) {
      require_own_coordinate(robot, name, velocity, read);
      dynamics.velocities[name] = read.number(velocity);
    }
  }
  if (const JsonValue* motors = find(object, "motors")) {
    dynamics.motors = MotorReader(robot, read).motors(*motors);
  }
  if (const JsonValue* density = find(object, "density")) {
    dynamics.density = read.positive(*density);
  }
  dynamics.surface = read_surface(object, read);
  return dynamics;
}

}  // namespace firstcontact::detail
