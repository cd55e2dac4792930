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

/// The options of check_lines().
struct CheckLinesOptions {
  std::size_t threads = 0;            ///< 0: as many as there are processors.
  bool closest = false;               ///< Also computes the closest approach of every pair.
  bool all_pairs = false;             ///< Also computes the answer of every pair.
  bool all_contacts_in_time = false;  ///< Likewise, with every interval of contact of each pair.
  ReadingOptions reading = {};
  std::stop_token stop = {};  ///< Ends the work early.
  /// Called with the options of each scene before it is answered, from any thread; may be empty.
  std::function<void(SceneOptions&)> adjust = {};
};

/// The outcome of one line.
struct LineAnswer {
  std::size_t line = 0;            ///< The number of the line.
  std::string text;                ///< The result, or an error in its place, as one line of JSON.
  std::optional<Verdict> verdict;  ///< None for an error.
  std::string error;               ///< The error in one line; else empty.
};

/// Answers scenes on many threads, which share the meshes, and hands the answers over in order.
///
/// A bad scene gets an error, and so does one that needs more memory than there is. The other
/// scenes are still answered. Answers are the same for every number of threads, unless a deadline
/// or the stop token ends them. Answers that a stop may have cut short are not handed over, nor are
/// any after them.
///
/// @param file  the file of the lines: named in errors; relative paths begin in its folder
/// @param next  returns the next line, none at the end; one call at a time, and few lines ahead
/// @param take  takes each answer in the order of the lines; one call at a time
/// @throws the exceptions of next and take
FIRSTCONTACT_API void check_lines(const std::filesystem::path& file,
                                  const std::function<std::optional<SceneLine>()>& next,
                                  const std::function<void(const LineAnswer&)>& take,
                                  const CheckLinesOptions& options = {});

}  // namespace firstcontact
