/// @file
/// Reads a pose in any of its forms.

#pragma once

#include <firstcontact/motion/pose.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// Reads `position` with one of `quaternion_wxyz`, `rpy`, `rotation_vector`; or `matrix` alone.
///
/// A missing part is the identity. A quaternion is kept as written. The other forms are converted
/// to one in double precision.
///
/// @throws ParseError
[[nodiscard]] Pose read_pose(const JsonValue& value, const JsonReader& read);

}  // namespace firstcontact::detail
