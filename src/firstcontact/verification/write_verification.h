/// @file
/// Writes what was proven of a run as JSON.

#pragma once

#include <string>

#include <firstcontact/math/export.h>

namespace firstcontact {

enum class RunVerdict;
struct RunHeader;
struct RunVerification;

/// One JSON object on one line, without a line feed; bodies by their names, what is infinite null.
[[nodiscard]] FIRSTCONTACT_API std::string write_verification(const RunHeader& header,
                                                              const RunVerification& verification);

/// The words of that JSON: proven, closer, broken, not_proven.
[[nodiscard]] FIRSTCONTACT_API const char* word(RunVerdict verdict);

}  // namespace firstcontact
