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

/// The data that a batch needs of an earlier result.
struct ResultSummary {
  std::optional<Verdict> verdict;   ///< None where the record is an error.
  std::optional<std::size_t> line;  ///< Line of the jobs, the first being 1; none where it is not
                                    ///< stated.
};

/// Reads the data that a batch needs of a result.
///
/// @param result  one JSON object, as write_result and write_error write it
/// @param source  the file of the result, named in errors
/// @param line    line of that file
/// @throws ParseError if it is neither
[[nodiscard]] FIRSTCONTACT_API ResultSummary read_summary(std::string_view result,
                                                          const std::filesystem::path& source,
                                                          std::size_t line = 1);

/// The data that a page needs of a result that it plays.
struct StoredResult {
  Scene scene;             ///< Its paths are as they were opened, not relative to the result's.
  double t = 0.0;          ///< [-]  The scene is proven free before this time.
  double clearance = 0.0;  ///< [m]  Lower bound of the distances until t.
};

/// Reads back the result of one scene.
///
/// @param result  one JSON object, as write_result writes it
/// @param source  the file of the result, named in errors
/// @throws ParseError if it is no result, or its scene is no scene
[[nodiscard]] FIRSTCONTACT_API StoredResult read_result(std::string_view result,
                                                        const std::filesystem::path& source,
                                                        const ReadingOptions& options = {});

}  // namespace firstcontact
