/// @file
/// Reads back the contents of a result.

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// The facts that a batch has to know of a result that is there already.
struct ResultSummary {
  std::optional<Verdict> verdict;   ///< None where an error stands in place of one.
  std::optional<std::size_t> line;  ///< Of the jobs, the first being 1; none where it has none.
};

/// Reads the facts that a batch has to know of a result.
///
/// @param result  one JSON object, as write_result and write_error write it
/// @param source  the file that it is from, named in errors
/// @param line    of that file
/// @throws ParseError if it is neither
[[nodiscard]] FIRSTCONTACT_API ResultSummary read_summary(std::string_view result,
                                                          const std::filesystem::path& source,
                                                          std::size_t line = 1);

/// The facts that a page has to know of a result that it plays.
struct StoredResult {
  Scene scene;             ///< Its paths are as they were opened, not relative to the result's.
  double t = 0.0;          ///< [-]  Before this the scene is proven free.
  double clearance = 0.0;  ///< [m]  So far apart, at least, until t.
};

/// Reads back the result of one scene.
///
/// @param result  one JSON object, as write_result writes it
/// @param source  the file that it is from, named in errors
/// @throws ParseError if it is none, or its scene is none
[[nodiscard]] FIRSTCONTACT_API StoredResult read_result(std::string_view result,
                                                        const std::filesystem::path& source,
                                                        const ReadingOptions& options = {});

}  // namespace firstcontact
