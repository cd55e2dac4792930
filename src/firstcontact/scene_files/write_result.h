/// @file
/// Writes the answer of a scene as the JSON that users and the viewer read (schema/result.json).

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <firstcontact/math/export.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/scene/sample_gap.h>

namespace firstcontact {

struct LoadedScene;
struct SceneResult;

/// The outcome of sampling at a rate, to compare with the proven answer.
struct SamplingReport {
  double rate = 0.0;  ///< [1/s]
  std::size_t samples = 0;
  std::size_t in_contact = 0;
  std::optional<GapSample> least;  ///< The sample of the least distance, the first of equals.
};

/// Counts the contacts among samples at `rate` [1/s], and finds the least distance.
[[nodiscard]] FIRSTCONTACT_API SamplingReport report_sampling(double rate,
                                                              std::span<const GapSample> samples);

/// The options of writing a result.
struct WriteResultOptions {
  bool all_pairs = false;                ///< Also writes the answer of every pair.
  std::optional<std::size_t> line = {};  ///< Line of the scene in its file, for JSON Lines.
  std::optional<SamplingReport> sampling;
};

/// Writes the result as one JSON object on one line, without a line feed.
///
/// Times in seconds stand beside normalised ones; normal velocities are in m/s. An infinite or
/// undefined number is null. The same answer gives the same text, except for `work`.
[[nodiscard]] FIRSTCONTACT_API std::string write_result(const LoadedScene& loaded,
                                                        const SceneResult& result,
                                                        const WriteResultOptions& options = {});

/// Writes the record that stands in place of a result where a scene could not be answered.
///
/// @param id       id of the scene, empty if it is not known
/// @param file     path of the file that was read
/// @param line     line of that file, for JSON Lines
/// @param message  description of the error
/// @param reason   the cause that ended the work, where that was not the input; or none
[[nodiscard]] FIRSTCONTACT_API std::string write_error(
    std::string_view id, std::string_view file, std::optional<std::size_t> line,
    std::string_view message, UndecidedReason reason = UndecidedReason::none);

/// The word of the result file for a value.
[[nodiscard]] FIRSTCONTACT_API const char* word(Verdict verdict);
[[nodiscard]] FIRSTCONTACT_API const char* word(UndecidedReason reason);
[[nodiscard]] FIRSTCONTACT_API const char* word(FeatureType type);

}  // namespace firstcontact
