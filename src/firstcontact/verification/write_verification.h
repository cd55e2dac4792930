/// @file
/// Writes what was proven of a run, a result or a path as JSON.

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

/// One JSON object on one line, without a line feed; bodies by their names, what is infinite null.
[[nodiscard]] FIRSTCONTACT_API std::string write_verification(const RunHeader& header,
                                                              const RunVerification& verification);

/// One JSON object on one line, without a line feed.
[[nodiscard]] FIRSTCONTACT_API std::string write_verification(
    const ResultClaims& claims, const ResultVerification& verification);

/// One JSON object on one line, without a line feed.
[[nodiscard]] FIRSTCONTACT_API std::string write_verification(const PlannedPath& path,
                                                              const PathVerification& verification);

/// The words of that JSON: proven, refuted, broken, not_proven.
[[nodiscard]] FIRSTCONTACT_API const char* word(ProofVerdict verdict);

}  // namespace firstcontact
