/// @file
/// The positions of a floating joint that a file gives as a pose.

#pragma once

#include <optional>
#include <string_view>

#include <firstcontact/robot/robot_model.h>
#include <firstcontact/scene/trajectory.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Reads a pose as seven positions of a floating joint by name, the quaternion of length 1.
///
/// @throws ParseError
[[nodiscard]] JointPositions pose_positions(const Joint& floating, const JsonValue& value,
                                            const JsonReader& read);

/// Reads the entry of a state that is the pose of a floating joint in its frame: seven positions by
/// name, the quaternion of length 1. None for other joints, and for an entry that is no object.
///
/// @throws ParseError
[[nodiscard]] std::optional<JointPositions> floating_positions(const RobotModel& robot,
                                                               std::string_view name,
                                                               const JsonValue& value,
                                                               const JsonReader& read);

/// Adds positions of an entry of a state to those of the entries before it.
///
/// @throws ParseError  where one is there already: it is given as a number and in a pose
void add_once(const JointPositions& added, JointPositions& positions, const JsonValue& entry,
              const JsonReader& read);

}  // namespace firstcontact::detail
