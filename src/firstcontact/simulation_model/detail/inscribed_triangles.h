/// @file
/// Triangles whose corners lie on a curved shape.

#pragma once

#include <firstcontact/geometry/shape.h>

namespace firstcontact::detail {

/// Makes the triangles of a curved shape with each corner moved onto its surface.
///
/// Their indices stay. A circle or an ellipsoid through the corners then is that of the shape
/// itself, to rounding. A shape that is not curved stays as it is.
[[nodiscard]] Shape inscribed_triangles(const Shape& shape);

}  // namespace firstcontact::detail
