/// @file
/// Reads triangle meshes from files and from memory.

#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/math/export.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// A mesh and the report about its file.
struct MeshReading {
  Mesh mesh;
  FileReport report;
};

/// Reads a mesh in double precision and welds vertices of equal position (weld.h).
///
/// The ending of the name gives the format, in upper or lower case: obj, stl, ply, off, dae, glb,
/// gltf. Coordinates are taken as metres, those of a dae in its unit. In dae, glb and gltf files
/// the transforms of nodes act. Morphs have the weights that the file states, and skins the pose of
/// the nodes that are their joints. The up axis of a dae is not turned, but reported.
///
/// A polygon becomes triangles inside of it. A fan about its first corner is taken where it is
/// right, as it is for convex polygons. Otherwise the polygon is triangulated as it appears along
/// the coordinate axis nearest to its normal. A polygon that crosses itself stays a fan, with a
/// warning. The report counts concave polygons. It warns of polygons that are not planar within
/// 1e-5 of the diagonal of the mesh: their surface depends on the triangulation. The warning names
/// the deviation, which bounds that dependence.
///
/// An element of one or two corners is a point or an edge: a triangle with repeated corners. In
/// dae, glb and gltf files these are left out, as they are drawings there. Materials, normals,
/// colours and texture coordinates are left out. An unknown element that could hold or place
/// geometry is refused. The report lists all that was left out. The locale changes nothing.
///
/// The file must not shrink while it is read.
///
/// @throws ParseError  one line with path, place and what was expected: the file cannot be
///         opened, is malformed or cut off, has a coordinate that is not finite, an index out of
///         range, or no element at all
[[nodiscard]] FIRSTCONTACT_API MeshReading read_mesh_file(const std::filesystem::path& path,
                                                          const ReadingOptions& options = {});

/// Reads the mesh of read_mesh_file() alone.
[[nodiscard]] FIRSTCONTACT_API Mesh read_mesh(const std::filesystem::path& path);

/// Parses Wavefront OBJ text; the mesh is not welded, and vertices keep the file's order.
///
/// It reads `v` (with an optional weight of 1, or a colour), `f`, `l` and `p` with negative
/// indices, comments and continued lines. A line of counts is passed over.
///
/// @param source  names the text in errors
/// @throws ParseError  as read_mesh; also on free-form curves and surfaces
[[nodiscard]] FIRSTCONTACT_API Mesh parse_obj(std::string_view text, const std::string& source);

/// Parses binary or ASCII STL: a soup of three vertices a triangle, not welded.
///
/// A file is binary if its size fits its count, or if it is not text that begins with `solid`. Text
/// may hold several solids.
///
/// @throws ParseError  as read_mesh; also where a binary file's size contradicts its count, but for
///         blanks or zeros at its end; where the last `endsolid` is missing
[[nodiscard]] FIRSTCONTACT_API Mesh parse_stl(std::string_view data, const std::string& source);

/// Parses PLY: ASCII, binary of either byte order, any order and type of properties.
///
/// The elements `vertex` (x, y, z) and `face` (vertex_indices or vertex_index) are needed. Others
/// are left out, and so are faces without corners.
///
/// @throws ParseError  as read_mesh; also on triangle strips and range images, and where bytes are
///         left over
[[nodiscard]] FIRSTCONTACT_API Mesh parse_ply(std::string_view data, const std::string& source);

/// Parses ASCII OFF, one vertex or face a line.
///
/// The extra columns of the variants (ST, C, N) are left out, as are faces without corners.
///
/// @throws ParseError  as read_mesh; also on 4OFF, nOFF and binary OFF
[[nodiscard]] FIRSTCONTACT_API Mesh parse_off(std::string_view text, const std::string& source);

}  // namespace firstcontact
