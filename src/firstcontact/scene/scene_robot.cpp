#include <firstcontact/scene/scene_robot.h>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

/// All states that the name may mean.
std::vector<const GroupState*> states_named(const RobotSemantics& semantics,
                                            std::string_view name) {
  std::vector<const GroupState*> found;
  for (const GroupState& state : semantics.states) {
    if (state.name == name || state.group + "/" + state.name == name) {
      found.push_back(&state);
    }
  }
  return found;
}

std::string known_states(const RobotSemantics& semantics) {
  std::vector<std::string> names;
  for (const GroupState& state : semantics.states) {
    names.push_back(state.group + "/" + state.name);
  }
  return detail::listed({names.begin(), names.end()});
}

/// Adds the pose of a floating joint. An SRDF has its quaternion as MoveIt does: x, y, z, w.
void add_pose(const RobotModel& model, const GroupState::JointValue& value,
              JointPositions& positions) {
  constexpr std::array<std::size_t, 7> kPlaces = {0, 1, 2, 6, 3, 4, 5};
  for (std::size_t k = 0; k < kPlaces.size(); ++k) {
    positions[coordinate_name(model, {value.joint, k})] = value.coordinates.at(kPlaces.at(k));
  }
}

}  // namespace

RobotModel read_robot_model(const RobotFile& file, const ReadingOptions& reading) {
  return read_urdf(file.urdf, {.package_roots = file.package_roots,
                               .shapes = LoadShapes::none,
                               .surface = file.surface,
                               .reading = reading});
}

JointPositions group_state(const RobotModel& model, const RobotSemantics& semantics,
                           std::string_view name) {
  const std::vector<const GroupState*> found = states_named(semantics, name);
  if (found.size() != 1) {
    const std::string what = found.empty() ? "a state of the SRDF" : "one state, as GROUP/STATE";
    throw std::invalid_argument(
        "expected " + what + ", got " + detail::in_quotes(name) +
        (semantics.states.empty() ? "; it has none" : "; it has " + known_states(semantics)));
  }
  JointPositions positions;
  for (const GroupState::JointValue& value : found.front()->values) {
    const JointType type = model.joints()[value.joint].type;
    if (type == JointType::fixed) {
      continue;  // The SRDF's warnings name it.
    }
    if (type == JointType::floating) {
      add_pose(model, value, positions);
      continue;
    }
    if (coordinate_count(type) == 0) {
      throw std::invalid_argument("state " + detail::in_quotes(name) + ": joint " +
                                  detail::in_quotes(model.joints()[value.joint].name) + " is " +
                                  to_string(type) + ", and has none");
    }
    for (std::size_t k = 0; k < value.coordinates.size(); ++k) {
      positions[coordinate_name(model, {value.joint, k})] = value.coordinates[k];
    }
  }
  return positions;
}

TrackingError joint_error(const Joint& joint, double error) {
  if (coordinate_count(joint.type) == 1) {
    return tracking_error_of(joint, error);
  }
  return {.angle = error, .distance = joint.type == JointType::ball ? 0.0 : error};
}

std::map<std::size_t, TrackingError> joint_errors(const RobotModel& model, double error) {
  std::map<std::size_t, TrackingError> errors;
  for (std::size_t k = 0; k < model.joints().size(); ++k) {
    const Joint& joint = model.joints()[k];
    if (joint.type != JointType::fixed && !joint.mimic) {
      errors[k] = joint_error(joint, error);
    }
  }
  return errors;
}

}  // namespace firstcontact
