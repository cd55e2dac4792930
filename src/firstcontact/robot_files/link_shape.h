/// @file
/// The shape of a link's geometry, read from its mesh file where it has one.

#pragma once

#include <optional>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/math/export.h>
#include <firstcontact/robot/link_geometry.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// Makes the shape of a source, in its frame G.
///
/// Coordinates of a mesh are scaled in double precision, and certificates hold for the rounded
/// products. A mirrored mesh keeps its inside.
///
/// @throws ParseError as read_mesh
/// @throws std::invalid_argument where a number is out of its range
[[nodiscard]] FIRSTCONTACT_API Shape make_shape(const GeometrySource& source);

/// A shape, and the report on its file.
struct ShapeReading {
  Shape shape;
  std::optional<FileReport> report;  ///< Only for a mesh.
};

/// Makes the shape as make_shape() does, with the report on its file.
[[nodiscard]] FIRSTCONTACT_API ShapeReading read_shape(const GeometrySource& source,
                                                       const ReadingOptions& options = {});

}  // namespace firstcontact
