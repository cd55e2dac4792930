/// @file
/// Writes the proof of a run, a result or a path as JSON.

#pragma once

#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact {

enum class ProofVerdict;
struct PathVerification;
struct PlannedPath;
struct ResultClaims;
struct ResultVerification;
struct RunHeader;
struct RunVerification;

/// Writes the proof of a run as one JSON object on one line, without a line feed.
///
/// Bodies appear by their names, and infinite numbers as null.
[[nodiscard]] FIRSTCONTACT_API std::string write_verification(const RunHeader& header,
                                                              const RunVerification& verification);

/// Writes the proof of a result as one JSON object on one line, without a line feed.
[[nodiscard]] FIRSTCONTACT_API std::string write_verification(
    const ResultClaims& claims, const ResultVerification& verification);

/// Writes the proof of a path as one JSON object on one line, without a line feed.
[[nodiscard]] FIRSTCONTACT_API std::string write_verification(const PlannedPath& path,
                                                              const PathVerification& verification);

/// The word of a verdict in that JSON: proven, refuted, broken, not_proven.
[[nodiscard]] FIRSTCONTACT_API const char* word(ProofVerdict verdict);

}  // namespace firstcontact
