/// @file
/// The readers of meshes and clouds in memory, with notes about the text.

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/text/reading_log.h>

namespace firstcontact::detail {

// Each is as the public function of its name (read_mesh.h, read_points.h), and notes in the log its
// counts, warnings and parts that it leaves out. A refusal may stand in the log alone: see
// ReadingLog::throw_errors().

[[nodiscard]] Mesh parse_obj(std::string_view text, ReadingLog& log);
[[nodiscard]] Mesh parse_stl(std::string_view data, ReadingLog& log);
[[nodiscard]] Mesh parse_ply(std::string_view data, ReadingLog& log);
[[nodiscard]] Mesh parse_off(std::string_view text, ReadingLog& log);

[[nodiscard]] std::vector<Eigen::Vector3d> parse_ply_points(std::string_view data, ReadingLog& log);
[[nodiscard]] std::vector<Eigen::Vector3d> parse_xyz(std::string_view text, ReadingLog& log);

/// Parses a text in memory, without a report.
///
/// @param parse  one of the above
/// @throws ParseError  also for refusals that stand in the log alone
template <class Parse>
[[nodiscard]] auto parse_unlogged(Parse parse, std::string_view text, const std::string& source) {
  ReadingLog log(source, {});
  auto result = parse(text, log);
  log.throw_errors();
  return result;
}

}  // namespace firstcontact::detail
