/// @file
/// Reads the shapes of a planning scene's objects.

#pragma once

#include <firstcontact/scene/body_shape.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_path.h>

namespace firstcontact::detail {

/// Reads a shape_msgs/SolidPrimitive: its type is a word or a number from 1.
///
/// @throws ParseError
[[nodiscard]] BodyShape read_primitive(const JsonValue& value, const JsonReader& read);

/// Reads a shape_msgs/Mesh, or a file under `resource`.
///
/// @throws ParseError
[[nodiscard]] BodyShape read_message_mesh(const JsonValue& value, const SceneFolders& folders,
                                          const JsonReader& read);

}  // namespace firstcontact::detail
