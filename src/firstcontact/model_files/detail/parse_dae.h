/// @file
/// Reads COLLADA documents.

#pragma once

#include <string_view>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/text/reading_log.h>

namespace firstcontact::detail {

/// Parses a COLLADA document of version 1.4 or 1.5: the scene that its <scene> instances, in
/// metres, with the axes of the file. Not welded.
///
/// Geometries are placed by the transforms of their nodes. Morphs have the weights that the file
/// states. Skins have the pose of the nodes of their joints; that is the bind pose, unless the
/// nodes were moved. Polygons are turned where the map of their node mirrors, so that the inside of
/// a closed surface stays inside.
///
/// The log notes the parts that are left out. These are looks, animations, the shapes and joints of
/// simulators, settings of other tools, lines, geometries outside of the scene.
///
/// @param bytes  the file, of which log.path() is the path
/// @throws ParseError  malformed, unknown or unsupported parts, or no polygon at all
[[nodiscard]] Mesh parse_dae(std::string_view bytes, ReadingLog& log);

}  // namespace firstcontact::detail
