/// @file
/// Reads "grips" of a haptic tool: joints of a robot that values of a device move.

#pragma once

#include <cstddef>
#include <vector>

#include <firstcontact/scene/haptic_question.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact {
struct SceneRobot;
}  // namespace firstcontact

namespace firstcontact::detail {

/// [buttons]  Most buttons of a device.
inline constexpr std::size_t kButtonsOfDevice = 32;

/// Reads the grips of a tool.
///
/// @param robot  the robot with the joints
/// @throws ParseError  a joint that the robot lacks, that is fixed, has no single coordinate,
///         follows another or stands twice; positions out of its limits; too many grips
[[nodiscard]] std::vector<HapticGripQuestion> read_grips(const JsonValue& value,
                                                         const SceneRobot& robot,
                                                         const JsonReader& read);

}  // namespace firstcontact::detail
