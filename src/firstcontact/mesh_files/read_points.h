/// @file
/// Reads point clouds and height maps from files and from memory.

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/height_map.h>
#include <firstcontact/math/export.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

/// Points and the report about their file.
struct PointReading {
  std::vector<Eigen::Vector3d> points;
  FileReport report;
};

/// Reads the points of a cloud in double precision, as they are numbered in the file.
///
/// The ending of the name gives the format, in upper or lower case: ply, pcd or xyz. Coordinates
/// are taken as metres. Colours, normals and all other data are passed over. The locale changes
/// nothing. The file must not shrink while it is read.
///
/// @throws ParseError  one line with path, place and what was expected: the file cannot be opened,
///         is malformed or cut off, has a coordinate that is not finite, or no point at all
[[nodiscard]] FIRSTCONTACT_API PointReading read_points_file(const std::filesystem::path& path,
                                                             const ReadingOptions& options = {});

/// Reads the points of read_points_file() alone.
[[nodiscard]] FIRSTCONTACT_API std::vector<Eigen::Vector3d> read_points(
    const std::filesystem::path& path);

/// Parses PCD 0.7 of the Point Cloud Library: ascii, binary and binary_compressed, any order and
/// type of fields.
///
/// By the format a point with a coordinate that is NaN is missing. It is left out, and the points
/// after it move up by one index. The viewpoint is not applied.
///
/// @throws ParseError  as read_points
[[nodiscard]] FIRSTCONTACT_API std::vector<Eigen::Vector3d> parse_pcd(std::string_view data,
                                                                      const std::string& source);

/// Parses XYZ: a point a line, `x y z` and anything after it, between blanks, commas or semicolons.
///
/// `#` begins a comment, as does `//` at the start of a line. Before the points there may be a line
/// with the names of the columns, of which x, y and z are the first. There may also be a line with
/// the number of points.
///
/// @throws ParseError  as read_points; also on decimal commas, on files of atoms, and where the
///         number of points is another
[[nodiscard]] FIRSTCONTACT_API std::vector<Eigen::Vector3d> parse_xyz(std::string_view text,
                                                                      const std::string& source);

/// Parses the vertices of a PLY file (see parse_ply); faces need not be there.
///
/// @throws ParseError  as read_points
[[nodiscard]] FIRSTCONTACT_API std::vector<Eigen::Vector3d> parse_ply_points(
    std::string_view data, const std::string& source);

/// Reads the heights of a map from text, a row a line, as numpy.savetxt writes them.
///
/// Numbers stand between blanks, `#` begins a comment, and the first row is at y = 0.
///
/// @param cell  [m]  as HeightMap::cell
/// @throws ParseError  as read_points; also where rows differ in length, or are fewer than two
[[nodiscard]] FIRSTCONTACT_API HeightMap read_heights(const std::filesystem::path& path,
                                                      const Eigen::Vector2d& cell);

/// Parses the text of read_heights.
[[nodiscard]] FIRSTCONTACT_API HeightMap parse_heights(std::string_view text,
                                                       const std::string& source,
                                                       const Eigen::Vector2d& cell);

}  // namespace firstcontact
