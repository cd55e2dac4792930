#include <firstcontact/mesh_files/read_points.h>

#include <algorithm>
#include <string>
#include <utility>

#include <firstcontact/mesh_files/detail/parse_mesh.h>
#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/mapped_file.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/reading_log.h>
#include <firstcontact/text/text_cursor.h>

namespace firstcontact {
namespace {

using detail::TextCursor;

constexpr detail::TextSyntax kComments{.comments = true, .continuation = false};

}  // namespace

HeightMap parse_heights(std::string_view text, const std::string& source,
                        const Eigen::Vector2d& cell) {
  TextCursor cursor(detail::without_byte_order_mark(text), source, kComments);
  HeightMap map{.cell = cell, .columns = 0, .heights = {}};
  std::size_t rows = 0;
  for (; cursor.find_line(); ++rows) {
    const std::size_t before = map.heights.size();
    while (!cursor.at_line_end()) {
      map.heights.push_back(cursor.number("a finite height"));
    }
    const std::size_t count = map.heights.size() - before;
    if (rows > 0 && count != map.columns) {
      cursor.fail("expected " + std::to_string(map.columns) +
                  " heights as in the rows before, got " + std::to_string(count));
    }
    map.columns = count;
  }
  if (rows < 2 || map.columns < 2) {
    throw ParseError(source, "expected at least two rows of two heights");
  }
  return map;
}

HeightMap read_heights(const std::filesystem::path& path, const Eigen::Vector2d& cell) {
  const detail::MappedFile file(path);
  return parse_heights(file.bytes(), path.string(), cell);
}

PointReading read_points_file(const std::filesystem::path& path, const ReadingOptions& options) {
  const std::string extension = detail::file_extension(path);
  const detail::MappedFile file(path);
  if (extension != "ply" && extension != "pcd" && extension != "xyz") {
    throw ParseError(path.string(), "expected a point cloud named .ply, .pcd or .xyz, got " +
                                        detail::quoted("." + extension));
  }
  std::string format = extension;
  std::transform(format.begin(), format.end(), format.begin(),
                 [](char c) { return static_cast<char>(c - 'a' + 'A'); });
  detail::ReadingLog log(path.string(), std::move(format), options);
  std::vector<Eigen::Vector3d> points = extension == "ply"
                                            ? detail::parse_ply_points(file.bytes(), log)
                                        : extension == "pcd" ? parse_pcd(file.bytes(), log.path())
                                                             : detail::parse_xyz(file.bytes(), log);
  log.add_content("points", points.size());
  return {std::move(points), log.finish()};
}

std::vector<Eigen::Vector3d> read_points(const std::filesystem::path& path) {
  return read_points_file(path).points;
}

}  // namespace firstcontact
