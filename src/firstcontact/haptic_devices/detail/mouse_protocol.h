/// @file
/// The messages of a page whose mouse is a haptic device.

#pragma once

#include <string_view>

#include <firstcontact/haptic_devices/device.h>

namespace firstcontact::detail {

/// Reads the pose of the handle and the value of the grips from a message of the page.
///
/// The message is an object with `position` (3 numbers, m), `rotation` (4 numbers w, x, y, z of
/// length 1) and, where grips are not 0, `grip`. Unknown keys are left out.
///
/// @param state  takes the pose and the grips; unchanged where the message is refused
/// @throws ParseError  where a value is missing, of another type or out of range
void take_mouse_message(std::string_view text, DeviceState& state);

}  // namespace firstcontact::detail
