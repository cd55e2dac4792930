/// @file
/// Makes the shape that a scene describes.

#pragma once

#include <firstcontact/robot_files/link_shape.h>
#include <firstcontact/scene/body_shape.h>

namespace firstcontact::detail {

/// Makes a shape; reads the file that it names, if any.
///
/// @throws ParseError if the file cannot be used
/// @throws std::invalid_argument if a number is out of its range, or a solid not closed
[[nodiscard]] ShapeReading make_shape(const BodyShape& shape, const ReadingOptions& options = {});

/// The file that a shape is in; null where it is in none.
[[nodiscard]] const std::filesystem::path* file_of(const BodyShape& shape);

}  // namespace firstcontact::detail
