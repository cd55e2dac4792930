/// @file
/// Reads a pose in any of its forms.

#pragma once

#include <firstcontact/motion/pose.h>
#include <firstcontact/text/json_reader.h>

namespace firstcontact::detail {

/// `position` with one of `quaternion_wxyz`, `rpy`, `rotation_vector`; or `matrix` alone. What is
/// left out is the identity. A quaternion is kept as written, the other forms are converted to
/// one in double precision.
///
/// @throws ParseError
[[nodiscard]] Pose read_pose(const JsonValue& value, const JsonReader& read);

}  // namespace firstcontact::detail
