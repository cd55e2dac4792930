#include <firstcontact/trajectory_files/detail/ros_message.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

#include <Eigen/Geometry>

#include <firstcontact/text/brief_list.h>
#include <firstcontact/text/write_json.h>
#include <firstcontact/trajectory_files/detail/joint_trajectory.h>

namespace firstcontact::detail {
namespace {

/// Reads numbers in a list, or by the names x, y, z, w.
template <std::size_t N>
std::array<double, N> read_components(const JsonValue& value, const JsonReader& read) {
  constexpr std::array<std::string_view, 4> kNames = {"x", "y", "z", "w"};
  const std::string expected =
      N == 3 ? "three numbers, or x, y and z" : "a quaternion: four numbers x, y, z, w";
  std::array<double, N> numbers{};
  if (std::holds_alternative<JsonObject>(value.value)) {
    (void)read.object(value, {{kNames.begin(), kNames.begin() + N}});
    for (std::size_t k = 0; k < N; ++k) {
      numbers[k] = read.number(read.member(value, kNames[k]));
    }
    return numbers;
  }
  const JsonArray& elements = read.array(value, expected);
  if (elements.size() != N) {
    read.fail_expected(expected, value);
  }
  for (std::size_t k = 0; k < N; ++k) {
    numbers[k] = read.number(elements[k]);
  }
  return numbers;
}

/// Reads a quaternion; none where it is all zeros.
std::optional<Eigen::Quaterniond> read_quaternion(const JsonValue& value, const JsonReader& read) {
  const std::array<double, 4> q = read_components<4>(value, read);
  if (q == std::array<double, 4>{}) {
    return std::nullopt;
  }
  Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  // A greater error is a mistake, such as w in the first place of a list.
  constexpr double kSlack = 1e-2;
  if (!(std::abs(rotation.norm() - 1.0) <= kSlack)) {
    read.fail(value, "expected a quaternion x, y, z, w of length 1, got one of length " +
                         write_json(rotation.norm()));
  }
  return rotation;
}

}  // namespace

const JsonValue& unwrap_message(const JsonValue& root, const std::vector<std::string_view>& keys,
                                std::string_view own) {
  const auto* object = std::get_if<JsonObject>(&root.value);
  for (const std::string_view key : keys) {
    const JsonValue* inside = object == nullptr ? nullptr : find(*object, key);
    if (inside != nullptr && find(*object, own) == nullptr) {
      return *inside;
    }
  }
  return root;
}

const JsonValue* find_filled(const JsonValue& object, std::string_view key) {
  const auto* members = std::get_if<JsonObject>(&object.value);
  const JsonValue* value = members == nullptr ? nullptr : find(*members, key);
  if (value == nullptr || std::holds_alternative<JsonNull>(value->value)) {
    return nullptr;
  }
  const auto* array = std::get_if<JsonArray>(&value->value);
  return array != nullptr && array->empty() ? nullptr : value;
}

Eigen::Vector3d read_point(const JsonValue& value, const JsonReader& read) {
  constexpr double kLargest = 1e60;
  const std::array<double, 3> p = read_components<3>(value, read);
  Eigen::Vector3d point(p[0], p[1], p[2]);
  if (!(point.cwiseAbs().maxCoeff() <= kLargest)) {
    read.fail(value, "expected numbers of at most 1e60 in size");
  }
  return point;
}

MessagePose read_message_pose(const JsonValue& value, const JsonReader& read) {
  (void)read.object(value, {{"position", "orientation", "translation", "rotation"}});
  MessagePose result;
  for (const std::string_view key : {"position", "translation"}) {
    if (const JsonValue* position = find_filled(value, key)) {
      result.pose.position = read_point(*position, read);
    }
  }
  for (const std::string_view key : {"orientation", "rotation"}) {
    if (const JsonValue* rotation = find_filled(value, key)) {
      const std::optional<Eigen::Quaterniond> read_one = read_quaternion(*rotation, read);
      result.has_zero_quaternion = !read_one;
      result.pose.rotation = read_one.value_or(Eigen::Quaterniond::Identity());
    }
  }
  return result;
}

std::string zero_quaternion_warning(const std::string& source, const std::vector<std::string>& of) {
  return source + ": " +
         (of.size() == 1 ? "a quaternion of zeros is" : "quaternions of zeros are") +
         " taken as the identity, as MoveIt does: " + some_of(of);
}

bool is_identity(const Pose& pose) {
  return pose.position.isZero(0.0) && pose.rotation.vec().isZero(0.0);
}

Pose compose(const Pose& X_AB, const Pose& X_BC) {
  if (is_identity(X_AB)) {
    return X_BC;
  }
  if (is_identity(X_BC)) {
    return X_AB;
  }
  const Eigen::Quaterniond R_AB = X_AB.rotation.normalized();
  return {X_AB.position + R_AB * X_BC.position, R_AB * X_BC.rotation.normalized()};
}

void add_position(const JsonValue& joint, const JsonValue& position, const RobotModel& robot,
                  const JsonReader& read, MessageState& state) {
  const std::string name = name_of(joint, "the name of a joint", read);
  const double number = joint_position(position, read);
  if (names_fixed_joint(robot, name)) {
    state.fixed.push_back(name);
    return;
  }
  try {
    (void)find_coordinate(robot, name);
  } catch (const std::invalid_argument& error) {
    read.fail(joint, error.what());
  }
  if (!state.positions.insert({name, number}).second) {
    read.fail(joint, "expected each joint once, got " + in_quotes(name) + " again");
  }
}

std::vector<NamedPosition> named_positions(const JsonValue& value, const JsonReader& read) {
  std::vector<NamedPosition> result;
  (void)read.object(value, {{"header", "name", "position", "velocity", "effort"}});
  const JsonValue* names = find_filled(value, "name");
  if (names == nullptr) {
    return result;
  }
  const JsonArray& joints = read.array(*names, "an array of joint names");
  const JsonValue& list = read.member(value, "position");
  const JsonArray& positions = read.array(list, "an array of numbers");
  if (joints.size() != positions.size()) {
    read.fail(list, "expected a number for each of the " + std::to_string(joints.size()) +
                        " names, got " + std::to_string(positions.size()));
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    result.push_back({joints[k], positions[k]});
  }
  return result;
}

MessageState read_joint_state(const JsonValue& value, const RobotModel& robot,
                              const JsonReader& read) {
  MessageState state;
  for (const NamedPosition& joint : named_positions(value, read)) {
    add_position(joint.name, joint.position, robot, read, state);
  }
  return state;
}

}  // namespace firstcontact::detail
