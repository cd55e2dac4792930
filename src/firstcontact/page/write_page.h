/// @file
/// Writes the page that plays a result, or another record: one HTML file that needs nothing else.

#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/page/path_look.h>
#include <firstcontact/page/rate_look.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/sample_gap.h>

namespace firstcontact {

struct LoadedScene;

/// The gap over time, in the order of times.
struct GapChart {
  std::span<const GapSample> samples;
  std::span<const GapPoint> lower_bound;  ///< Proven; may be empty.
};

/// The parts of a page that are about a motion, beside its result.
struct MotionLook {
  const PathLook* path = nullptr;        ///< Of a planned path; null where the page plays none.
  std::span<const RateLook> rates = {};  ///< Of a retimed motion.
};

/// Fills the viewer's page (share/firstcontact/viewer.html) with a result.
///
/// The page holds the result word for word, the gap, and the mesh of every body. A mesh that
/// several bodies share is there once. Its vertices are in single precision, relative to the middle
/// of the mesh. For robots the page holds joints with their paths, and the geometries and looks of
/// links. The meshes of looks are read here. A mesh that cannot be read is left out, with a warning
/// in the page.
///
/// @param page_template  the viewer's page
/// @param loaded         the scene of the result
/// @param result         JSON, as write_result makes it
/// @param gap            for the chart
/// @param look           what else is drawn of the motion
/// @throws std::invalid_argument if the template has no place for a result
[[nodiscard]] FIRSTCONTACT_API std::string write_page(std::string_view page_template,
                                                      const LoadedScene& loaded,
                                                      std::string_view result, const GapChart& gap,
                                                      const MotionLook& look = {});

/// A record other than a result that the viewer can show, such as a run.
struct PageRecord {
  std::string_view name;  ///< Name by which the viewer knows the record.
  std::string_view json;
};

/// Fills the viewer's page with another record, and with the looks of its bodies.
///
/// Beside it stand the scene's warnings, files and counts of pairs, which a result has itself.
///
/// @throws std::invalid_argument if the template has no place for a record
[[nodiscard]] FIRSTCONTACT_API std::string write_page(std::string_view page_template,
                                                      const LoadedScene& loaded,
                                                      const PageRecord& record);

/// A page of the viewer with a list of results, each of which it plays.
///
/// A mesh that several results have stands in the page once. There is no gap over time, as it would
/// have to be sampled.
class FIRSTCONTACT_API ListPage {
 public:
  /// Adds a result or an error as a line of the list that cannot be played.
  ///
  /// @param result  JSON, as write_result and write_error make it
  /// @throws ParseError if it is no JSON object
  void add(std::string_view result);

  /// Adds a result that can be played.
  ///
  /// @param result  JSON, as write_result makes it
  /// @param loaded  the scene of the result
  void add(std::string_view result, const LoadedScene& loaded);

  /// [byte]  The size that the page will have, without the viewer's own.
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Fills the viewer's page with the list.
  ///
  /// @throws std::invalid_argument if the template has no place for results
  [[nodiscard]] std::string write(std::string_view page_template) const;

 private:
  [[nodiscard]] std::size_t add_mesh(std::string json);

  std::string entries_;
  std::vector<std::string> meshes_;
  std::unordered_map<std::string, std::size_t> of_digests_;  // By the SHA-256 of the mesh.
  std::size_t size_ = 0;
};

}  // namespace firstcontact
