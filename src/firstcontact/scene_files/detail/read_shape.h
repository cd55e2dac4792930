/// @file
/// Reads the shape of a body.

#pragma once

#include <firstcontact/scene/body_shape.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/read_path.h>

namespace firstcontact::detail {

/// Reads one of the shapes that a body can have.
///
/// They are `mesh` (a file, which must exist) with `scale`, and `vertices` with `triangles`. There
/// are `sphere`, `capsule`, `box`, `cylinder`, `cone` and `convex_hull` (of a mesh or vertices).
/// There are `points` (a file or inline) with `scale`, and `heightmap`. `radius` and `solid` are
/// read where they may stand.
///
/// @throws ParseError
[[nodiscard]] BodyShape read_shape(const JsonValue& value, const SceneFolders& folders,
                                   const JsonReader& read);

}  // namespace firstcontact::detail
