/// @file
/// Many scenes, answered by many threads.

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include <firstcontact/math/export.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/scene.h>
#include <firstcontact/scene_files/scene_lines.h>
#include <firstcontact/text/file_report.h>

namespace firstcontact {

struct CheckLinesOptions {
  std::size_t threads = 0;            ///< 0: as many as there are processors.
  bool closest = false;               ///< Also the closest approach of every pair.
  bool all_pairs = false;             ///< Also the answer of every pair.
  bool all_contacts_in_time = false;  ///< So too, with every interval of contact of each pair.
  ReadingOptions reading = {};
  std::stop_token stop = {};  ///< Ends the work early.
  /// Called with the options of each scene before it is answered, from any thread; may be empty.
  std::function<void(SceneOptions&)> adjust = {};
};

/// The outcome of one line.
struct LineAnswer {
  std::size_t line = 0;            ///< The number of the line.
  std::string text;                ///< The result, or an error in its place, as one line of JSON.
  std::optional<Verdict> verdict;  ///< None where it is an error.
  std::string error;               ///< What was wrong, one line; else empty.
};

/// Answers scenes by many threads, which share the meshes, and hands the answers over in order. A
/// bad scene gets an error, and so does one that needs more memory than there is; the rest is still
/// done. Answers are the same for every number of
/// threads, unless a deadline or the stop token ends them; those that a stop may have cut short are
/// not handed over, nor are any after them.
///
/// @param file  that the lines are from: named in errors, and relative paths begin in its folder
/// @param next  the next line, none at the end; one call at a time, and never many lines ahead
/// @param take  takes each answer in the order of the lines; one call at a time
/// @throws what next and take throw
FIRSTCONTACT_API void check_lines(const std::filesystem::path& file,
                                  const std::function<std::optional<SceneLine>()>& next,
                                  const std::function<void(const LineAnswer&)>& take,
                                  const CheckLinesOptions& options = {});

}  // namespace firstcontact
