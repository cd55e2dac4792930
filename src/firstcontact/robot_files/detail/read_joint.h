/// @file
/// Reads the joints of a URDF.

#pragma once

#include <optional>

#include <firstcontact/robot/robot_description.h>
#include <firstcontact/robot_files/detail/urdf_context.h>

namespace firstcontact::detail {

/// Reads a joint; its errors go into the log.
///
/// It returns none where the joint does not state what it connects, or how it moves.
[[nodiscard]] std::optional<Joint> read_joint(const XmlElement& element,
                                              const UrdfContext& context);

}  // namespace firstcontact::detail
