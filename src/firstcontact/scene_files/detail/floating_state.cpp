#include <firstcontact/scene_files/detail/floating_state.h>

#include <array>
#include <cstddef>
#include <variant>

#include <Eigen/Geometry>

#include <firstcontact/motion/pose.h>
#include <firstcontact/scene_files/detail/read_pose.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact::detail {

JointPositions pose_positions(const Joint& floating, const JsonValue& value,
                              const JsonReader& read) {
  Pose pose = read_pose(value, read);
  pose.rotation.normalize();
  const std::array<double, 7> numbers = positions_of_pose(pose);
  JointPositions positions;
  for (std::size_t index = 0; index < numbers.size(); ++index) {
    positions[coordinate_name(floating, index)] = numbers.at(index);
  }
  return positions;
}

std::optional<JointPositions> floating_positions(const RobotModel& robot, std::string_view name,
                                                 const JsonValue& value, const JsonReader& read) {
  const auto joint = robot.find_joint(name);
  if (!joint || robot.joints()[*joint].type != JointType::floating ||
      !std::holds_alternative<JsonObject>(value.value)) {
    return std::nullopt;
  }
  return pose_positions(robot.joints()[*joint], value, read);
}

void add_once(const JointPositions& added, JointPositions& positions, const JsonValue& entry,
              const JsonReader& read) {
  for (const auto& [coordinate, position] : added) {
    if (!positions.emplace(coordinate, position).second) {
      read.fail(entry, in_quotes(coordinate) +
                           " is given twice, also by a pose; leave one of them out");
    }
  }
}

}  // namespace firstcontact::detail
