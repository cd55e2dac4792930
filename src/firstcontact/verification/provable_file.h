/// @file
/// The kind of a file for a second proof.

#pragma once

#include <string_view>

#include <firstcontact/math/export.h>

namespace firstcontact {

/// The kinds of files that have a second proof.
enum class ProvableFile {
  unknown,  ///< No JSON, or none of these.
  run,      ///< The header of a run.
  result,   ///< A result, or an error in place of one.
  path,
};

/// The kind of a file by its text: all of it, or its first line where each line is one object.
[[nodiscard]] FIRSTCONTACT_API ProvableFile provable_file(std::string_view text);

/// Guesses the kind of a text that is no JSON any more, by its first key.
///
/// It is `unknown` where that key decides nothing. The reader of the kind then reports the error.
[[nodiscard]] FIRSTCONTACT_API ProvableFile damaged_file(std::string_view text);

}  // namespace firstcontact
